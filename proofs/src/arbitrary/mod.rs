//! Any state that satisfies the invariant, any configuration that is accepted, any inputs, for each monitor of each family.
//!
//! A function returns `None` when the choices are outside the domain. States are chosen before inputs, so that an
//! enumeration leaves an impossible state at once.

pub mod heidenhain;
pub mod sinumerik;
