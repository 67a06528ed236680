//! Runners of HEIDENHAIN's functional safety.

use crate::case::Runner;

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[];
