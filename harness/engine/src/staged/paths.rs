//! What the step of an instance does, as a decision tree: what it asks for first, what next for each answer, and at the ends what it
//! makes. The interpreter makes a step once for each path; it is looked up from then on, whatever else the cells hold that it
//! does not ask for.

use super::plan::Source;

/// One step.
pub(super) enum End {
    Step {
        /// What it makes: places in the row of the stage, with their values.
        made: Vec<(u32, i32)>,
        /// The rule that fired, from 1; 0 for none.
        rule: usize,
    },
    /// The code of the fault that it meets.
    Fault(u32),
}

pub(super) enum Node {
    /// What is asked for, and by each answer so far the node that follows, in order.
    Ask(Source, Vec<(i32, u32)>),
    End(End),
}

#[derive(Default)]
pub(super) struct Paths {
    /// The first one is the root.
    nodes: Vec<Node>,
    bytes: u64,
}

impl Paths {
    /// A node; none if the tree is still empty.
    #[inline]
    pub(super) fn node(&self, at: u32) -> Option<&Node> {
        self.nodes.get(at as usize)
    }

    /// Adds a path, which leaves the tree where an answer is new.
    pub(super) fn add(&mut self, asked: Vec<(Source, i32)>, end: End) {
        let mut at = 0;
        for (source, value) in asked {
            if at == self.nodes.len() {
                self.push(Node::Ask(source, Vec::new()));
            }
            let fresh = self.nodes.len();
            let Node::Ask(old, next) = &mut self.nodes[at] else {
                unreachable!("a step that was over asks for more");
            };
            debug_assert_eq!(*old, source, "the same answers led to another question");
            at = match next.binary_search_by_key(&value, |(answer, _)| *answer) {
                Ok(place) => next[place].1 as usize,
                Err(place) => {
                    next.insert(place, (value, fresh as u32));
                    self.bytes += size_of::<(i32, u32)>() as u64;
                    fresh
                }
            };
        }
        debug_assert_eq!(at, self.nodes.len(), "the path was there already");
        if let End::Step { made, .. } = &end {
            self.bytes += size_of_val(&**made) as u64;
        }
        self.push(Node::End(end));
    }

    fn push(&mut self, node: Node) {
        self.bytes += size_of::<Node>() as u64;
        self.nodes.push(node);
    }

    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// The node that follows an answer, if a path with it is known.
#[inline]
pub(super) fn after(next: &[(i32, u32)], value: i32) -> Option<u32> {
    // Most cells have few values.
    let place = match next.len() {
        0..=8 => next.iter().position(|(answer, _)| *answer == value),
        _ => next
            .binary_search_by_key(&value, |(answer, _)| *answer)
            .ok(),
    };
    place.map(|place| next[place].1)
}
