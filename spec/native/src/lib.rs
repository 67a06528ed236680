//! The form of generated tables: what the crates of the families hold and the engine calls.
//!
//! Parameters stay parameters: one generated step serves every machine. The fingerprint of a table says whether it
//! belongs to the specification at hand; if the file was changed, the interpreter takes its place.

#![no_std]

/// Marks a cell that has no value yet in this cycle.
pub const UNSET: i32 = i32::MIN;

/// Error of a function called with a frame or parameters of another table.
pub const WRONG_FRAME: u32 = u32::MAX;

/// Reads an input of the environment by its number.
pub type Reader<'a> = dyn FnMut(usize) -> i32 + 'a;

/// Makes a step from the state given first; then frame, parameters, inputs.
pub type Step = fn(&[i32], &mut [i32], &[i32], &mut Reader<'_>) -> Result<(), u32>;

/// Evaluates the expression of that number in the cycle just made; then frame, parameters, inputs.
pub type Value<T> = fn(usize, &mut [i32], &[i32], &mut Reader<'_>) -> Result<T, u32>;

/// A generated table.
///
/// A frame holds the cells of one cycle, in this order: state as the rules change it, state at the start of the cycle,
/// inputs and named expressions ([`UNSET`] until needed), and for each machine the number of the rule that fired.
pub struct Table {
    /// `specification/system`.
    pub name: &'static str,
    /// Fingerprint of the specification it was generated from.
    pub fingerprint: u64,
    /// Cells of a frame.
    pub cells: usize,
    /// State variables.
    pub states: usize,
    /// Inputs.
    pub inputs: usize,
    /// Named expressions.
    pub lazies: usize,
    /// Machines.
    pub fired: usize,
    /// One step from a state: the frame is cleared, the state after the step are its first cells. The error is the
    /// number of the assignment whose value left its range.
    pub step: Step,
    /// Truth of an atom in the cycle just made.
    pub atom: Value<bool>,
    /// Value of an observed expression in the cycle just made.
    pub observe: Value<i64>,
    /// Value of a named expression in the cycle just made.
    pub lazy: Value<i64>,
}

/// A data file of a family as a program carries it: `family/name.toml` and its bytes.
pub type Carried = (&'static str, &'static [u8]);

/// What the crate of a family holds.
#[derive(Clone, Copy)]
pub struct Family {
    /// Its tables, one for each system and for each machine by itself.
    pub tables: &'static [Table],
    /// The files of its folder; none for tables that belong to no drive.
    pub data: &'static [Carried],
}

/// The value of input `k`, which is read when it is first needed in a cycle.
#[doc(hidden)]
#[inline(always)]
pub fn input<const N: usize, R: FnMut(usize) -> i32 + ?Sized>(
    f: &mut [i32; N],
    base: usize,
    k: usize,
    r: &mut R,
) -> i64 {
    if f[base + k] == UNSET {
        f[base + k] = r(k);
    }
    i64::from(f[base + k])
}

/// Frame and parameters with the lengths that a table has.
#[doc(hidden)]
#[inline(always)]
pub fn fixed<'a, const N: usize, const P: usize>(
    f: &'a mut [i32],
    p: &'a [i32],
) -> Result<(&'a mut [i32; N], &'a [i32; P]), u32> {
    match (f.try_into(), p.try_into()) {
        (Ok(f), Ok(p)) => Ok((f, p)),
        _ => Err(WRONG_FRAME),
    }
}

/// Takes in what the build script of a family's crate has generated: the constant `FAMILY`.
#[macro_export]
macro_rules! family {
    () => {
        /// The tables and data of this family.
        pub const FAMILY: $crate::Family = $crate::Family {
            tables: &generated::TABLES,
            data: &generated::DATA,
        };

        #[allow(clippy::all, unused, missing_docs)]
        mod generated {
            use $crate::{Carried, Table, UNSET, WRONG_FRAME, fixed, input};

            include!(concat!(env!("OUT_DIR"), "/family.rs"));
        }
    };
}
