//! SHA-256 of whatever can be hashed.

use std::hash::Hasher;

use sha2::{Digest, Sha256};

/// Takes in all that is hashed: no two values that differ may stand for one another.
#[derive(Default)]
pub(crate) struct All(Sha256);

impl All {
    pub(crate) fn digest(self) -> [u8; 32] {
        self.0.finalize().into()
    }
}

impl Hasher for All {
    fn write(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    fn finish(&self) -> u64 {
        unreachable!("the whole of it is asked for")
    }
}
