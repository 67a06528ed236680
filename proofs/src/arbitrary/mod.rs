//! Steps drawn by hand, for the contracts that [`crate::draw`] and [`crate::tries`] cannot serve: the values that the enumeration
//! tries depend on each other, or Kani must leave something out; and parts of steps for the runs.
//!
//! A function returns `None` when the choices are outside the domain. States are chosen before inputs, so that an
//! enumeration leaves an impossible state at once.

pub mod heidenhain;
#[cfg(kani)]
pub mod sinamics {
    //! What stands in the place of functions of SINAMICS S120, each file for the monitor of its name.

    pub mod sls;
}
pub mod sinumerik;
#[cfg(kani)]
pub mod srm;
