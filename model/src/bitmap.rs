//! A bitmap for many writers whose pages are made when a bit in them is set.

use crate::checkpoint::{In, Out};
use std::io;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Words of a page: 32 KiB, a quarter of a million bits.
const PAGE: usize = 1 << 12;

type Page = [AtomicU64; PAGE];

/// Bits, all clear at first. A part of the index space that no state is in costs no memory.
pub(crate) struct Bitmap {
    pages: Vec<OnceLock<Box<Page>>>,
    made: AtomicU64,
    words: usize,
}

/// The word and the mask of a bit.
#[inline]
pub(crate) fn place(bit: u64) -> (usize, u64) {
    ((bit >> 6) as usize, 1 << (bit & 63))
}

impl Bitmap {
    pub(crate) fn new(words: usize) -> Self {
        let mut pages = Vec::new();
        pages.resize_with(words.div_ceil(PAGE), OnceLock::new);
        Bitmap {
            pages,
            made: AtomicU64::new(0),
            words,
        }
    }

    pub(crate) fn words(&self) -> usize {
        self.words
    }

    #[inline]
    pub(crate) fn load(&self, word: usize, order: Ordering) -> u64 {
        match self.pages[word / PAGE].get() {
            Some(page) => page[word % PAGE].load(order),
            None => 0,
        }
    }

    /// The bits that are set, in order.
    pub(crate) fn each(&self, mut each: impl FnMut(u64)) {
        for (number, page) in self.pages.iter().enumerate() {
            let words = page.get().into_iter().flat_map(|page| page.iter());
            for (word, bits) in (number * PAGE..).zip(words) {
                let mut bits = bits.load(Ordering::Relaxed);
                while bits != 0 {
                    each((word as u64) << 6 | u64::from(bits.trailing_zeros()));
                    bits &= bits - 1;
                }
            }
        }
    }

    /// Sets bits and gives the word as it was.
    #[inline]
    pub(crate) fn set(&self, word: usize, bits: u64, order: Ordering) -> u64 {
        let page = self.pages[word / PAGE].get_or_init(|| {
            self.made.fetch_add(1, Ordering::Relaxed);
            Box::new([const { AtomicU64::new(0) }; PAGE])
        });
        page[word % PAGE].fetch_or(bits, order)
    }

    pub(crate) fn clear(&mut self, word: usize, bits: u64) {
        if let Some(page) = self.pages[word / PAGE].get_mut() {
            *page[word % PAGE].get_mut() &= !bits;
        }
    }

    /// Applies `change` to the words of both bitmaps wherever `other` has a page.
    pub(crate) fn change(&mut self, other: &mut Bitmap, change: impl Fn(&mut u64, &mut u64)) {
        for (own, other) in self.pages.iter_mut().zip(&mut other.pages) {
            if let (Some(own), Some(other)) = (own.get_mut(), other.get_mut()) {
                for (a, b) in own.iter_mut().zip(other.iter_mut()) {
                    change(a.get_mut(), b.get_mut());
                }
            }
        }
    }

    /// Writes the pages made, each with its number.
    pub(crate) fn write(&self, out: &mut Out) -> io::Result<()> {
        out.number(self.made.load(Ordering::Relaxed))?;
        for (number, page) in self.pages.iter().enumerate() {
            let Some(page) = page.get() else { continue };
            out.number(number as u64)?;
            for word in page.iter() {
                out.number(word.load(Ordering::Relaxed))?;
            }
        }
        Ok(())
    }

    /// Reads the pages into an empty bitmap.
    pub(crate) fn read(&mut self, input: &mut In) -> io::Result<()> {
        for _ in 0..input.count()? {
            let first = input.place()?.saturating_mul(PAGE);
            if first >= self.words {
                return Err(io::ErrorKind::InvalidData.into());
            }
            for word in first..first + PAGE {
                self.set(word, input.number()?, Ordering::Relaxed);
            }
        }
        Ok(())
    }

    pub(crate) fn bytes(&self) -> u64 {
        let pages = self.made.load(Ordering::Relaxed) * size_of::<Page>() as u64;
        pages + (self.pages.len() * size_of::<OnceLock<Box<Page>>>()) as u64
    }
}
