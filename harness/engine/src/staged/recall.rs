//! What a stage has made of the values that it asked for: others, which it was given and did not look at, change nothing.
//!
//! A stage asks for one value after the other, and which one comes next follows from the answers. So what it has made stands at the end
//! of a path of answers.

use std::collections::HashMap;
use std::hash::{BuildHasher, Hasher};
use std::ops::Range;

use foldhash::fast::FixedState;
use hashbrown::HashTable;
use stillpoint_lang::eval::UNSET;
use stillpoint_model::Fault;

/// With more bytes it begins anew, which costs little.
const MOST: usize = 16 << 20;

/// With room for more a table is not cleared, which takes as long as it is large, but made anew.
const LARGE: usize = 1024;

/// So many answers to one question stand in a list.
const FEW: usize = 8;

/// A value that a stage has left: one of its own, or one that it was given and has not changed, by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Own(i32),
    Given(u32),
}

impl Part {
    pub(super) fn value(self, given: impl Fn(u32) -> i32) -> i32 {
        match self {
            Part::Own(value) => value,
            Part::Given(place) => given(place),
        }
    }
}

/// One of the outcomes of a stage.
#[derive(Debug, Clone, Copy)]
pub(super) struct Made {
    /// Where the values stand that it leaves: in its variables, then to the next stage.
    pub(super) parts: u32,
    pub(super) rule: Option<usize>,
    pub(super) share: u64,
}

/// After some answers.
enum Node {
    /// The place of the value that is asked for next, and the number of the last one of the answers plus one.
    Ask(u32, u32),
    /// What is made.
    End(u32),
}

/// An answer, the node behind it, and the number of the answer before it plus one.
struct Answer(i32, u32, u32);

/// What one stage has made.
#[derive(Default)]
pub(super) struct Recall {
    /// The first one is the root, if there is any.
    nodes: Vec<Node>,
    answers: Vec<Answer>,
    /// By node and answer, where there are many answers.
    others: HashMap<(u32, i32), u32, FixedState>,
    ends: Vec<Result<Range<u32>, Fault>>,
    made: Vec<Made>,
    /// So many of them belong to an end.
    noted: usize,
    parts: Vec<Part>,
    /// Those that belong to no end yet, by what they leave and their rule.
    fresh: HashTable<u32>,
}

impl Recall {
    /// What was made, given these values by their places.
    pub(super) fn find(&self, given: impl Fn(u32) -> i32) -> Option<u32> {
        let mut at = 0;
        loop {
            match self.nodes.get(at as usize)? {
                Node::End(end) => return Some(*end),
                Node::Ask(place, _) => at = self.behind(at, given(*place)).ok()?,
            }
        }
    }

    /// The node behind an answer; if there is none, whether there are few answers.
    #[inline]
    fn behind(&self, node: u32, answer: i32) -> Result<u32, bool> {
        let Node::Ask(_, mut next) = self.nodes[node as usize] else {
            return Err(true);
        };
        for _ in 0..FEW {
            let Some(at) = next.checked_sub(1) else {
                return Err(true);
            };
            let Answer(one, behind, before) = self.answers[at as usize];
            if one == answer {
                return Ok(behind);
            }
            next = before;
        }
        self.others.get(&(node, answer)).copied().ok_or(false)
    }

    /// The outcomes.
    pub(super) fn made(&self, end: u32) -> Result<&[Made], Fault> {
        let range = self.ends[end as usize].clone()?;
        Ok(&self.made[range.start as usize..range.end as usize])
    }

    /// The values that an outcome leaves, and those after them.
    pub(super) fn parts(&self, made: &Made) -> &[Part] {
        &self.parts[made.parts as usize..]
    }

    /// Begins anew if what is known is too much.
    pub(super) fn begin(&mut self) {
        if self.bytes() as usize > MOST {
            *self = Self::default();
        }
    }

    /// One of the outcomes that are made now. Equal ones become one.
    pub(super) fn push(
        &mut self,
        parts: impl Iterator<Item = Part>,
        rule: Option<usize>,
        share: u64,
    ) {
        let from = self.parts.len();
        self.parts.extend(parts);
        let (before, row) = self.parts.split_at(from);
        let made = &mut self.made;
        let same = |n: &u32| {
            let one = &made[*n as usize];
            one.rule == rule && before[one.parts as usize..].starts_with(row)
        };
        let hash = hash_of(rule, row);
        if let Some(n) = self.fresh.find(hash, same) {
            made[*n as usize].share += share;
            self.parts.truncate(from);
            return;
        }
        let again = |n: &u32| {
            let one = &made[*n as usize];
            hash_of(one.rule, &before[one.parts as usize..][..row.len()])
        };
        self.fresh.insert_unique(hash, made.len() as u32, again);
        made.push(Made {
            parts: from as u32,
            rule,
            share,
        });
    }

    /// The outcomes pushed since the last call were made after these questions and answers, unless there was a fault.
    pub(super) fn add(&mut self, asked: &[(u32, i32)], fault: Option<Fault>) -> u32 {
        let end = self.ends.len() as u32;
        let from = self.noted;
        if let (Some(_), Some(first)) = (fault, self.made.get(from)) {
            self.parts.truncate(first.parts as usize);
            self.made.truncate(from);
        }
        self.noted = self.made.len();
        match self.fresh.capacity() > LARGE {
            true => self.fresh = HashTable::new(),
            false => self.fresh.clear(),
        }
        self.ends.push(match fault {
            Some(fault) => Err(fault),
            None => Ok(from as u32..self.noted as u32),
        });
        let mut at = None;
        for (place, answer) in asked {
            let node = self.node(at, Node::Ask(*place, 0));
            debug_assert!(matches!(self.nodes[node as usize], Node::Ask(p, _) if p == *place));
            at = Some((node, *answer));
        }
        self.node(at, Node::End(end));
        end
    }

    /// The node behind an answer: this one if there is none yet.
    fn node(&mut self, after: Option<(u32, i32)>, node: Node) -> u32 {
        let fresh = self.nodes.len() as u32;
        match after {
            None if fresh > 0 => return 0,
            None => {}
            Some((before, answer)) => match self.behind(before, answer) {
                Ok(behind) => return behind,
                Err(false) => _ = self.others.insert((before, answer), fresh),
                Err(true) => {
                    if let Node::Ask(_, last) = &mut self.nodes[before as usize] {
                        self.answers.push(Answer(answer, fresh, *last));
                        *last = self.answers.len() as u32;
                    }
                }
            },
        }
        self.nodes.push(node);
        fresh
    }

    pub(super) fn bytes(&self) -> u64 {
        let bytes = self.nodes.capacity() * size_of::<Node>()
            + self.answers.capacity() * size_of::<Answer>()
            + self.others.capacity() * size_of::<((u32, i32), u32)>()
            + self.ends.capacity() * size_of::<Result<Range<u32>, Fault>>()
            + self.made.capacity() * size_of::<Made>()
            + self.parts.capacity() * size_of::<Part>();
        bytes as u64
    }
}

/// A number for what an outcome leaves, and its rule.
fn hash_of(rule: Option<usize>, parts: &[Part]) -> u64 {
    let mut hasher = FixedState::default().build_hasher();
    hasher.write_usize(rule.map_or(0, |rule| rule + 1));
    for part in parts {
        hasher.write_u64(match part {
            Part::Own(value) => u64::from(*value as u32),
            Part::Given(place) => 1 << 32 | u64::from(*place),
        });
    }
    hasher.finish()
}

/// The places of the values that a stage is given: the state variables that it reads, then what is kept before it.
#[derive(Default)]
pub(super) struct Places {
    pub(super) before: Vec<u32>,
    pub(super) now: Vec<u32>,
    pub(super) inputs: Vec<u32>,
    pub(super) names: Vec<u32>,
}

/// No place: nothing is given.
pub(super) const NONE: u32 = u32::MAX;

/// What a stage is given, by place.
pub(super) fn given<'a>(
    reads: &'a [usize],
    before: &'a [i32],
    class: &'a [i32],
) -> impl Fn(u32) -> i32 + 'a {
    move |place| match (place as usize).checked_sub(reads.len()) {
        _ if place == NONE => UNSET,
        Some(cell) => class[cell],
        None => before[reads[place as usize]],
    }
}
