//! End-to-end tests of the stillpoint binary.
