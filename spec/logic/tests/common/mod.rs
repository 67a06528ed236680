//! A program that runs in the interpreter of the tables.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::LazyKind;

/// One machine, with its state.
pub struct Running {
    bound: Bound,
    frame: Frame,
    state: Vec<i32>,
    first: Vec<i32>,
}

/// A port without its instance.
fn port(name: &str) -> &str {
    name.split_once('.').map_or("", |(_, port)| port)
}

impl Running {
    /// The machine at its start.
    pub fn new(bound: Bound) -> Self {
        let states = bound.system.states.iter();
        let state: Vec<i32> = states
            .map(|s| {
                s.init
                    .as_ref()
                    .map_or(0, |init| bound.constant(init) as i32)
            })
            .collect();
        Self {
            frame: Frame::new(&bound),
            first: state.clone(),
            state,
            bound,
        }
    }

    /// Back to the start.
    pub fn restart(&mut self) {
        self.state.clone_from(&self.first);
    }

    /// How many cells of state it has.
    pub fn cells(&self) -> usize {
        self.state.len()
    }

    /// One cycle with these inputs, the others 0: the outputs named. `None` where a value left its range.
    pub fn step<const N: usize>(
        &mut self,
        inputs: &[(&str, i32)],
        outputs: [&str; N],
    ) -> Option<[i64; N]> {
        self.frame.start(&self.state);
        let system = &self.bound.system;
        let mut read = |k: usize| {
            let name = port(&system.inputs[k].name);
            let found = inputs.iter().find(|(input, _)| *input == name);
            found.map_or(0, |(_, value)| *value)
        };
        self.bound.step(&mut self.frame, &mut read).ok()?;
        let mut out = [0; N];
        for (k, lazy) in system.lazies.iter().enumerate() {
            let place = outputs.iter().position(|o| *o == port(&lazy.name));
            if let (LazyKind::Output, Some(place)) = (lazy.kind, place) {
                out[place] = self.bound.lazy(k, &mut self.frame, &mut read);
            }
        }
        self.state.copy_from_slice(&self.frame.now);
        Some(out)
    }
}
