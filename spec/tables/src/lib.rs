//! The step functions of the shipped specification tables, generated at build time.
//!
//! Parameters stay parameters: one generated step serves every machine. The fingerprint of a table says whether it
//! belongs to the specification at hand; if the file was changed, the interpreter takes its place.

#![cfg_attr(not(test), no_std)]

/// Marks a cell that has no value yet in this cycle.
pub const UNSET: i32 = i32::MIN;

/// The cells of one cycle: `S` state variables, `I` inputs, `L` named expressions, `M` machines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<const S: usize, const I: usize, const L: usize, const M: usize> {
    /// State at the start of the cycle.
    pub before: [i32; S],
    /// State as the rules have changed it.
    pub now: [i32; S],
    /// Inputs, [`UNSET`] until read.
    pub inputs: [i32; I],
    /// Named expressions, [`UNSET`] until evaluated.
    pub lazies: [i32; L],
    /// For each machine the number of the rule that fired, from 1; 0 for none.
    pub fired: [i32; M],
}

/// A frame seen as slices.
pub trait Cells: Send {
    /// A frame with nothing set.
    fn unset() -> Self;
    /// Starts a cycle in state `before`; a state of another length is cut or filled with 0.
    fn start(&mut self, before: &[i32]);
    /// State after the rules.
    fn now(&self) -> &[i32];
    /// State at the start.
    fn before(&self) -> &[i32];
    /// Inputs.
    fn inputs(&self) -> &[i32];
    /// Inputs, to set some before the step.
    fn inputs_mut(&mut self) -> &mut [i32];
    /// Fired rules.
    fn fired(&self) -> &[i32];
}

impl<const S: usize, const I: usize, const L: usize, const M: usize> Cells for Frame<S, I, L, M> {
    fn unset() -> Self {
        Self {
            before: [UNSET; S],
            now: [UNSET; S],
            inputs: [UNSET; I],
            lazies: [UNSET; L],
            fired: [0; M],
        }
    }

    #[inline]
    fn start(&mut self, before: &[i32]) {
        for (k, cell) in self.before.iter_mut().enumerate() {
            *cell = before.get(k).copied().unwrap_or(0);
        }
        self.now = self.before;
        self.inputs = [UNSET; I];
        self.lazies = [UNSET; L];
        self.fired = [0; M];
    }

    fn now(&self) -> &[i32] {
        &self.now
    }

    fn before(&self) -> &[i32] {
        &self.before
    }

    fn inputs(&self) -> &[i32] {
        &self.inputs
    }

    fn inputs_mut(&mut self) -> &mut [i32] {
        &mut self.inputs
    }

    fn fired(&self) -> &[i32] {
        &self.fired
    }
}

/// A generated table. `p` are the parameter values in the order of the specification, `r(k)` reads input `k`.
pub trait Table: Sync + Send + 'static {
    /// `specification/system`.
    const NAME: &'static str;
    /// Fingerprint of the specification it was generated from.
    const FINGERPRINT: u64;
    /// Its cells.
    type Frame: Cells;

    /// One step from the state with which the frame was started.
    ///
    /// # Errors
    /// The number of the assignment whose value left its range.
    fn step<R: FnMut(usize) -> i32>(f: &mut Self::Frame, p: &[i32], r: &mut R) -> Result<(), u32>;
    /// Truth of atom `k` in the cycle just made.
    fn atom<R: FnMut(usize) -> i32>(k: usize, f: &mut Self::Frame, p: &[i32], r: &mut R) -> bool;
    /// Value of observed expression `k`.
    fn observe<R: FnMut(usize) -> i32>(k: usize, f: &mut Self::Frame, p: &[i32], r: &mut R) -> i64;
    /// Value of named expression `k`.
    fn lazy<R: FnMut(usize) -> i32>(k: usize, f: &mut Self::Frame, p: &[i32], r: &mut R) -> i64;
}

/// Something to do with a table whose type is only known by name.
pub trait Visitor {
    /// What it gives.
    type Out;
    /// Does it.
    fn visit<T: Table>(self) -> Self::Out;
}

pub use generated::with;

mod generated {
    #![allow(clippy::all, unused_parens, unused_variables, unused_mut, unused_braces)]
    use super::{Frame, Table, UNSET, Visitor};

    #[inline]
    fn input<const I: usize, R: FnMut(usize) -> i32>(cells: &mut [i32; I], k: usize, r: &mut R) -> i64 {
        if cells[k] == UNSET {
            cells[k] = r(k);
        }
        i64::from(cells[k])
    }

    include!(concat!(env!("OUT_DIR"), "/tables.rs"));
}
