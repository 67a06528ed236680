//! Checkpoints: an exploration as it stands between two levels, in a file that is there in full or not at all.
//!
//! The file has a line that says what it is, the identity of what is explored, the tally and the sets, and at its end the
//! SHA-256 of all before. All numbers are 64 bits wide, the least significant byte first.

use crate::pack::Key;
use crate::report::{Checkpoint, Error};
use crate::set::Set;
use crate::store::Store;
use crate::tally::{Found, Signs, Tally};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const MAGIC: &[u8] = b"stillpoint checkpoint, version 1\n";
const DIGEST: u64 = 32;

/// Writes numbers and adds them to the digest.
pub(crate) struct Out {
    file: BufWriter<File>,
    digest: Sha256,
}

impl Out {
    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.digest.update(bytes);
        self.file.write_all(bytes)
    }

    pub(crate) fn number(&mut self, number: u64) -> io::Result<()> {
        self.bytes(&number.to_le_bytes())
    }

    fn wide(&mut self, number: u128) -> io::Result<()> {
        self.bytes(&number.to_le_bytes())
    }

    /// Their count, and the numbers.
    pub(crate) fn numbers(&mut self, numbers: &[u64]) -> io::Result<()> {
        self.number(numbers.len() as u64)?;
        numbers.iter().try_for_each(|n| self.number(*n))
    }

    fn key<K: Key>(&mut self, key: K) -> io::Result<()> {
        key.halves().into_iter().try_for_each(|h| self.number(h))
    }

    fn first<K: Key>(&mut self, place: Option<(u32, K)>) -> io::Result<()> {
        self.number(u64::from(place.is_some()))?;
        place.map_or(Ok(()), |(depth, key)| {
            self.number(u64::from(depth))?;
            self.key(key)
        })
    }
}

/// Reads numbers. A number of entries is never believed beyond the bytes that are left.
pub(crate) struct In {
    file: BufReader<File>,
    left: u64,
}

impl In {
    pub(crate) fn bytes(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        let left = self.left.checked_sub(bytes.len() as u64);
        self.left = left.ok_or(io::ErrorKind::UnexpectedEof)?;
        self.file.read_exact(bytes)
    }

    pub(crate) fn number(&mut self) -> io::Result<u64> {
        let mut bytes = [0; 8];
        self.bytes(&mut bytes)?;
        Ok(u64::from_le_bytes(bytes))
    }

    fn wide(&mut self) -> io::Result<u128> {
        let mut bytes = [0; 16];
        self.bytes(&mut bytes)?;
        Ok(u128::from_le_bytes(bytes))
    }

    /// A number of entries.
    pub(crate) fn count(&mut self) -> io::Result<usize> {
        let count = self.number()?;
        match usize::try_from(count) {
            Ok(small) if count <= self.left => Ok(small),
            _ => Err(io::ErrorKind::InvalidData.into()),
        }
    }

    /// A place in a list.
    pub(crate) fn place(&mut self) -> io::Result<usize> {
        usize::try_from(self.number()?).map_err(|_| io::ErrorKind::InvalidData.into())
    }

    pub(crate) fn numbers(&mut self) -> io::Result<Vec<u64>> {
        (0..self.count()?).map(|_| self.number()).collect()
    }

    fn key<K: Key>(&mut self) -> io::Result<K> {
        Ok(K::of([self.number()?, self.number()?]))
    }

    fn first<K: Key>(&mut self) -> io::Result<Option<(u32, K)>> {
        Ok(match self.number()? {
            0 => None,
            _ => Some((self.number()? as u32, self.key()?)),
        })
    }
}

/// What a checkpoint has, and the time spent before it.
pub(crate) type Resumed<K> = (Found<K>, Duration);

/// Keeps the checkpoint of one exploration.
pub(crate) struct Keeper<'a> {
    checkpoint: &'a Checkpoint,
    last: Instant,
}

impl<'a> Keeper<'a> {
    pub(crate) fn new(checkpoint: &'a Checkpoint) -> Self {
        Keeper {
            checkpoint,
            last: Instant::now(),
        }
    }

    /// Whether it is time for the next one.
    pub(crate) fn is_due(&self) -> bool {
        self.last.elapsed() >= self.checkpoint.every
    }

    /// Writes a checkpoint: under another name first, so that the last one stays until the new one is complete.
    pub(crate) fn save<T: Store>(
        &mut self,
        store: &T,
        tally: &Tally<T::Key>,
        pending: &[Set<T::Key>],
        elapsed: Duration,
    ) -> Result<(), Error> {
        self.last = Instant::now();
        let file = &self.checkpoint.file;
        let new = with_suffix(file, ".new");
        let written = self
            .write(&new, store, tally, pending, elapsed)
            .and_then(|()| std::fs::rename(&new, file))
            .and_then(|()| sync_folder(file));
        written.map_err(|e| {
            // The first error is the one to tell.
            let _ = std::fs::remove_file(&new);
            fail(file, format!("it cannot be written: {e}"))
        })
    }

    fn write<T: Store>(
        &self,
        path: &Path,
        store: &T,
        tally: &Tally<T::Key>,
        pending: &[Set<T::Key>],
        elapsed: Duration,
    ) -> io::Result<()> {
        let mut out = Out {
            file: BufWriter::with_capacity(1 << 20, File::create(path)?),
            digest: Sha256::new(),
        };
        out.bytes(MAGIC)?;
        let identity = self.identity::<T>();
        out.number(identity.len() as u64)?;
        out.bytes(identity.as_bytes())?;
        out.number(elapsed.as_nanos() as u64)?;
        put_tally(&mut out, tally)?;
        out.number(pending.len() as u64)?;
        for set in pending {
            let keys = set.sorted();
            out.number(keys.len() as u64)?;
            keys.into_iter().try_for_each(|key| out.key(key))?;
        }
        // The states are no longer needed when all of them have been explored.
        if !tally.complete {
            store.save(&mut out)?;
        }
        let Out { mut file, digest } = out;
        file.write_all(&digest.finalize())?;
        file.flush()?;
        file.get_ref().sync_all()
    }

    fn identity<T: Store>(&self) -> String {
        format!("{}\nstates in {}", self.checkpoint.identity, T::NAME)
    }

    /// Reads the checkpoint into an empty store; none if there is no file. Also gives the time spent before it.
    pub(crate) fn load<T: Store>(&self, store: &mut T) -> Result<Option<Resumed<T::Key>>, Error> {
        let path = &self.checkpoint.file;
        let mut file = match File::open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(fail(path, format!("it cannot be read: {e}"))),
        };
        let left = verify(&mut file).map_err(|e| {
            let reason = match e.kind() {
                io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof => {
                    "it is damaged: its contents and its digest do not belong together".to_owned()
                }
                _ => format!("it cannot be read: {e}"),
            };
            fail(path, reason)
        })?;
        let mut input = In {
            file: BufReader::with_capacity(1 << 20, file),
            left,
        };
        self.read(&mut input, store)
            .map_err(|e| fail(path, format!("it cannot be understood: {e}")))?
            .ok_or_else(|| {
                let reason =
                    "it belongs to another specification, other parameters, properties or limits";
                fail(path, reason.to_owned())
            })
            .map(Some)
    }

    fn read<T: Store>(&self, input: &mut In, store: &mut T) -> io::Result<Option<Resumed<T::Key>>> {
        let mut magic = [0; MAGIC.len()];
        input.bytes(&mut magic)?;
        if magic != MAGIC {
            return Err(io::Error::other("it is no checkpoint of this version"));
        }
        let mut identity = vec![0; input.count()?];
        input.bytes(&mut identity)?;
        if identity != self.identity::<T>().as_bytes() {
            return Ok(None);
        }
        let elapsed = Duration::from_nanos(input.number()?);
        let tally = get_tally(input)?;
        let mut pending = Vec::new();
        for _ in 0..input.count()? {
            let set = Set::new();
            for _ in 0..input.count()? {
                set.add(input.key()?);
            }
            pending.push(set);
        }
        if !tally.complete {
            store.load(input)?;
        }
        let found = Found {
            tally,
            pending,
            bytes: store.bytes(),
            resumable: true,
        };
        Ok(Some((found, elapsed)))
    }
}

/// Checks the digest and leaves the file at its start; the number of bytes before the digest.
fn verify(file: &mut File) -> io::Result<u64> {
    let length = file.metadata()?.len();
    let left = length
        .checked_sub(DIGEST)
        .ok_or(io::ErrorKind::UnexpectedEof)?;
    let mut digest = Sha256::new();
    let mut reader = BufReader::with_capacity(1 << 20, &mut *file);
    io::copy(&mut (&mut reader).take(left), &mut digest)?;
    let mut told = [0; DIGEST as usize];
    reader.read_exact(&mut told)?;
    if digest.finalize()[..] != told {
        return Err(io::ErrorKind::InvalidData.into());
    }
    io::Seek::rewind(file)?;
    Ok(left)
}

fn put_tally<K: Key>(out: &mut Out, tally: &Tally<K>) -> io::Result<()> {
    out.number(tally.states)?;
    out.wide(tally.transitions)?;
    out.wide(tally.weights)?;
    out.number(tally.explored)?;
    out.number(u64::from(tally.depth))?;
    out.number(u64::from(tally.complete))?;
    out.number(tally.signs.len() as u64)?;
    for signs in &tally.signs {
        out.first(signs.first)?;
        out.first(signs.bad)?;
        out.number(u64::from(signs.met))?;
    }
    out.number(tally.faults.len() as u64)?;
    for (code, place) in &tally.faults {
        out.number(u64::from(*code))?;
        out.first(Some(*place))?;
    }
    out.numbers(&tally.coverage)?;
    out.number(tally.absorbing)?;
    out.number(tally.examples.len() as u64)?;
    tally.examples.iter().try_for_each(|key| out.key(*key))?;
    out.number(tally.stored)
}

fn get_tally<K: Key>(input: &mut In) -> io::Result<Tally<K>> {
    let mut tally = Tally {
        states: input.number()?,
        transitions: input.wide()?,
        weights: input.wide()?,
        explored: input.number()?,
        depth: input.number()? as u32,
        complete: input.number()? != 0,
        ..Tally::new(0, 0)
    };
    for _ in 0..input.count()? {
        tally.signs.push(Signs {
            first: input.first()?,
            bad: input.first()?,
            met: input.number()? != 0,
        });
    }
    for _ in 0..input.count()? {
        let code = input.number()? as u32;
        if let Some(place) = input.first()? {
            tally.faults.insert(code, place);
        }
    }
    tally.coverage = input.numbers()?;
    tally.absorbing = input.number()?;
    for _ in 0..input.count()? {
        tally.examples.push(input.key()?);
    }
    tally.stored = input.number()?;
    Ok(tally)
}

fn with_suffix(file: &Path, suffix: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(suffix);
    PathBuf::from(name)
}

/// A rename survives a power failure only when its folder has been written.
fn sync_folder(file: &Path) -> io::Result<()> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => File::open(folder)?.sync_all(),
        _ => Ok(()),
    }
}

fn fail(file: &Path, reason: String) -> Error {
    Error::Checkpoint {
        file: file.display().to_string(),
        reason,
    }
}
