//! Numbers for rows of values.

/// Rows of one length, each with a number, given once. Open addressing with linear probing.
pub(super) struct Rows {
    width: usize,
    /// One row after the other.
    values: Vec<i32>,
    len: u32,
    /// The number of a row plus one; 0 for nothing.
    slots: Vec<u32>,
}

fn hash(row: &[i32]) -> usize {
    let mixed = row.iter().fold(0u64, |hash, value| {
        (hash.rotate_left(5) ^ u64::from(*value as u32)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    });
    (mixed ^ (mixed >> 32)) as usize
}

impl Rows {
    pub(super) fn new(width: usize) -> Self {
        Self {
            width,
            values: Vec::new(),
            len: 0,
            slots: Vec::new(),
        }
    }

    pub(super) fn row(&self, number: u32) -> &[i32] {
        let from = number as usize * self.width;
        &self.values[from..from + self.width]
    }

    /// The number of a row.
    pub(super) fn number(&mut self, row: &[i32]) -> u32 {
        debug_assert_eq!(row.len(), self.width, "a row of another length");
        if self.len as usize * 2 >= self.slots.len() {
            self.grow();
        }
        let mask = self.slots.len() - 1;
        let mut at = hash(row) & mask;
        while let Some(number) = self.slots[at].checked_sub(1) {
            if self.row(number) == row {
                return number;
            }
            at = (at + 1) & mask;
        }
        self.values.extend_from_slice(row);
        self.len += 1;
        self.slots[at] = self.len;
        self.len - 1
    }

    #[cold]
    fn grow(&mut self) {
        self.slots = vec![0; (self.slots.len() * 2).max(16)];
        let mask = self.slots.len() - 1;
        for number in 0..self.len {
            let mut at = hash(self.row(number)) & mask;
            while self.slots[at] > 0 {
                at = (at + 1) & mask;
            }
            self.slots[at] = number + 1;
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        (size_of::<i32>() * (self.values.capacity() + self.slots.capacity())) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_numbers() {
        for width in [1, 3] {
            let mut rows = Rows::new(width);
            for _ in 0..2 {
                for n in 0..1000 {
                    let row = [n, -n, 7];
                    assert_eq!(rows.number(&row[..width]), n as u32);
                }
            }
            assert_eq!(rows.row(999), &[999, -999, 7][..width]);
        }
    }

    #[test]
    fn a_row_of_nothing_has_the_number_0() {
        let mut rows = Rows::new(0);
        assert_eq!((rows.number(&[]), rows.number(&[])), (0, 0));
        assert!(rows.row(0).is_empty());
    }
}
