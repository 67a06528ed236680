//! Random systems whose graph has a shape: groups of states that are mostly strongly connected, with ways from group to
//! group that mostly lead forward.

use super::{Random, Table};

/// A system of 12 to 60 states with the atoms: 0 starts a duty, 1 ends it (rarely), the others hold on some cycles, the
/// last one (an assumption) on most.
pub fn large_table(seed: u64, atoms: usize) -> Table {
    let mut random = Random(seed);
    let states = 12 + random.below(49);
    let group = 2 + random.below(6);
    let sizes = [2 + random.below(2) as u32, 1 + random.below(2) as u32, 1];
    let mut table = Table::basic(states, sizes, Vec::new());
    table.initial = vec![0, random.below(states)];
    let per_state = table.cells() / states;
    let faults = if random.percent(25) { 2 } else { 0 };
    let back = [0, 0, 3][random.below(3)];
    for index in 0..table.cells() {
        let state = index / per_state;
        let start = state / group * group;
        let size = group.min(states - start);
        let within = start + (state - start + 1 + random.below(2)) % size;
        table.next[index] = match random.below(100) {
            chance if chance < faults => Err(0),
            chance if chance < faults + back => Ok(random.below(states)),
            chance if chance < 15 => Ok((state + random.below(2 * group)).min(states - 1)),
            _ => Ok(within),
        };
    }
    for atom in 0..atoms {
        let chance = match atom {
            0 => 20,
            1 => [1, 4][random.below(2)],
            last if last + 1 == atoms => 90,
            _ => [3, 8, 20][random.below(3)],
        };
        let depends = [true, random.percent(50), false];
        let values = (0..table.cells()).map(|_| random.percent(chance)).collect();
        table.atoms.push((depends, values));
    }
    table
}
