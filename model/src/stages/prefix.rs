//! What the first stages make, kept whole: states that agree in all that these stages read have the same ways through them.
//!
//! A prefix is a path in a tree: each stage adds the number of the values that it reads. What a state shares with one before it is
//! known from the second visit on, so that a state which nothing follows costs no more than its place in the tree.

use super::Way;
use super::index::Index;

/// Lookups at a depth after which it is judged, and the share of them that must find something.
const JUDGED: u32 = 8192;
const WORTH: u32 = 8;

/// A place looked up: its stage, the place, the input combinations that came there.
pub(super) type Looked = (u32, u32, u128);

/// The prefixes of the states seen.
pub(super) struct Prefixes<K> {
    depths: Vec<Depth>,
    nodes: Vec<Node>,
    ways: Vec<Way<K>>,
    looked: Vec<Looked>,
    /// The nodes of the prefixes of this state that have been seen before, the shortest first.
    path: Vec<u32>,
    /// The nodes behind which states have begun that are not counted yet.
    visited: Vec<u32>,
    /// What may be held.
    most: u64,
}

/// The prefixes of one length.
#[derive(Default)]
struct Depth {
    /// By the shorter prefix and the number of what the stage reads.
    nodes: Index,
    lookups: u32,
    found: u32,
}

/// A prefix.
#[derive(Clone, Copy, Default)]
struct Node {
    /// Ends of what is kept of it; nothing is, as long as there are no ways.
    ways: (u32, u32),
    looked: (u32, u32),
    /// States that have begun behind it and are not counted yet.
    visits: u64,
}

impl Node {
    fn is_kept(&self) -> bool {
        self.ways.1 > self.ways.0
    }
}

impl<K: Copy> Prefixes<K> {
    /// For so many stages; it holds about `most` bytes.
    pub(super) fn new(stages: usize, most: u64) -> Self {
        let mut depths = Vec::new();
        // After the last stage comes nothing that could be saved, and states differ in it.
        depths.resize_with(stages.saturating_sub(1), Depth::default);
        Prefixes {
            depths,
            nodes: vec![Node::default()],
            ways: Vec::new(),
            looked: Vec::new(),
            path: Vec::new(),
            visited: Vec::new(),
            most,
        }
    }

    /// Walks along the prefixes of a state, which differ from stage to stage by these numbers. The longest one that is kept: the
    /// number of its stages, and the node.
    #[inline]
    pub(super) fn walk(&mut self, mut number: impl FnMut(usize) -> u32) -> Option<(usize, u32)> {
        self.path.clear();
        let (mut above, mut kept, mut cut) = (0, None, None);
        for (stage, depth) in self.depths.iter_mut().enumerate() {
            let fresh = self.nodes.len() as u32;
            let at = u64::from(above) << 32 | u64::from(number(stage));
            let node = depth.nodes.number(at, fresh);
            depth.lookups += 1;
            if depth.lookups == JUDGED {
                if depth.found < JUDGED / WORTH {
                    cut = Some(stage);
                }
                (depth.lookups, depth.found) = (0, 0);
            }
            if node == fresh {
                self.nodes.push(Node::default());
                break;
            }
            depth.found += 1;
            if self.nodes[node as usize].is_kept() {
                kept = Some((stage + 1, node));
            }
            self.path.push(node);
            above = node;
        }
        if let Some(stage) = cut {
            // Hardly two states share so long a prefix: looking for it costs more than it saves.
            self.depths.truncate(stage);
        }
        kept
    }

    /// Whether a prefix of so many stages has been seen before and is not kept.
    #[inline]
    pub(super) fn wants(&self, stages: usize) -> bool {
        self.path.len() >= stages
    }

    /// Whether any prefix of more stages than these is to be kept.
    pub(super) fn wants_more(&self, stages: usize) -> bool {
        self.path.len() > stages
    }

    /// Keeps the ways through the first stages of this state. Whether there was room.
    pub(super) fn keep(&mut self, stages: usize, ways: &[Way<K>], looked: &[Looked]) -> bool {
        let Some(node) = self.path.get(stages - 1).copied() else {
            return false;
        };
        let bytes = self.bytes() + (size_of_val(ways) + size_of_val(looked)) as u64;
        if bytes > self.most {
            return false;
        }
        let (a, b) = (self.ways.len() as u32, self.looked.len() as u32);
        self.ways.extend_from_slice(ways);
        self.looked.extend_from_slice(looked);
        let node = &mut self.nodes[node as usize];
        node.ways = (a, self.ways.len() as u32);
        node.looked = (b, self.looked.len() as u32);
        true
    }

    /// The ways through a prefix that is kept.
    #[inline]
    pub(super) fn ways(&self, node: u32) -> &[Way<K>] {
        let node = &self.nodes[node as usize];
        &self.ways[node.ways.0 as usize..node.ways.1 as usize]
    }

    /// The places looked up in it.
    pub(super) fn looked(&self, node: u32) -> &[Looked] {
        let node = &self.nodes[node as usize];
        &self.looked[node.looked.0 as usize..node.looked.1 as usize]
    }

    /// Counts a state that has begun behind it.
    #[inline]
    pub(super) fn visit(&mut self, node: u32) {
        let visits = &mut self.nodes[node as usize].visits;
        if *visits == 0 {
            self.visited.push(node);
        }
        *visits += 1;
    }

    /// Hands over the places looked up by the states that have begun behind a prefix, each with the number of these states.
    pub(super) fn settle(&mut self, mut each: impl FnMut(&Looked, u64)) {
        for node in self.visited.drain(..) {
            let node = &mut self.nodes[node as usize];
            let visits = std::mem::take(&mut node.visits);
            let looked = &self.looked[node.looked.0 as usize..node.looked.1 as usize];
            looked.iter().for_each(|looked| each(looked, visits));
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        let lists = self.nodes.capacity() * size_of::<Node>()
            + self.ways.capacity() * size_of::<Way<K>>()
            + self.looked.capacity() * size_of::<Looked>()
            + self.visited.capacity() * size_of::<u32>();
        let depths = self.depths.iter().map(|depth| depth.nodes.bytes());
        lists as u64 + depths.sum::<u64>()
    }

    /// Forgets all prefixes, and goes on with the same depths.
    pub(super) fn forget(&mut self) {
        let depths = self.depths.len();
        *self = Self::new(depths + 1, self.most);
    }
}
