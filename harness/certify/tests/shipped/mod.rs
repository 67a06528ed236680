//! The shipped systems, and values at random for them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use stillpoint_certify::format::Kind;
use stillpoint_certify::subject::Subject;
use stillpoint_lang::bind::Bound;

/// Numbers at random, the same ones each time (xorshift).
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) % count
    }

    pub fn value(&mut self, (lo, hi): (i32, i32)) -> i32 {
        lo.wrapping_add_unsigned(self.below(u64::from(hi.abs_diff(lo)) + 1) as u32)
    }

    pub fn inputs(&mut self, bound: &Bound) -> Vec<i32> {
        bound
            .inputs
            .iter()
            .map(|range| self.value(*range))
            .collect()
    }
}

/// All files of the specification: those that do not load by themselves are parts of others.
pub fn subjects() -> Vec<Subject> {
    let mut folders: Vec<PathBuf> = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec")];
    let mut subjects = Vec::new();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(folder).expect("a folder");
        let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let machine = path.parent().is_some_and(|p| p.ends_with("machines"));
                let kind = if machine {
                    Kind::Machine
                } else {
                    Kind::Specification
                };
                subjects.extend(Subject::load(&path, kind, &BTreeMap::new()));
            }
        }
    }
    subjects
}

/// What is counted in shares, one for each processor: the work gets its number and how many there are.
pub fn side_by_side<const N: usize>(
    work: impl Fn(usize, usize) -> [usize; N] + Sync,
) -> [usize; N] {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let work = &work;
        let begin = |from| scope.spawn(move || work(from, processors));
        let shares: Vec<_> = (0..processors).map(begin).collect();
        shares.into_iter().fold([0; N], |mut sum, one| {
            let one = one.join().expect("no difference");
            sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
            sum
        })
    })
}
