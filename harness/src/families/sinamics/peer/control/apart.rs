//! Monitors that are driven otherwise than their tables: a configuration of the monitor is a state of the table that never changes.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::ConfigError;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::message_buffer::Case;
use stillpoint_monitors::sinamics::{
    basic_selection, fail_safe_output, io_test, message_buffer, replacement, safe_state,
};

use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::cells::{load, store, stored};
use crate::diff::peer::numbers::{bit, ordinal, truth, upto, value};
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The machines of this topic, each with the module of its monitor.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("enabling", "basic_selection"),
    ("fdo", "fail_safe_output"),
    ("safe_state", "safe_state"),
    ("io_test", "io_test"),
    ("buffer", "message_buffer"),
    ("replacement", "replacement"),
];

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "enabling" => enabling(mutant),
        "fdo" => output(mutant),
        "safe_state" => safe(mutant),
        "io_test" => test(p, mutant)?,
        "buffer" => buffer(mutant),
        "replacement" => replaced(mutant),
        _ => return Ok(None),
    }))
}

/// What selects the Basic Functions, with every p9601. The F-DI of a TM54F select as the bits of PROFIsafe do.
fn enabling(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<basic_selection::Monitor>(mutant);
    Adapter::of(
        vec!["terminal", "f_di_sto", "f_di_ss1", "bus_sto", "bus_ss1"],
        vec![
            "can_sto", "sto", "asked", "r9772_17", "r9772_20", "r9772_22", "r9772_23",
        ],
        vec![upto(65), truth()],
        vec![0, 0],
        move |cells, i, o| {
            let Ok(path) = ControlPath::new(cells[0].unsigned_abs()) else {
                o.extend([0; 7]);
                return;
            };
            let delayed = cells[1] != 0;
            let telegram = path.profisafe();
            let config =
                basic_selection::Config::new(path.terminals(), telegram || path.inputs(), delayed);
            let (sto, ss1) = match telegram {
                true => (i[3], i[4]),
                false => (i[1], i[2]),
            };
            let inputs = basic_selection::Inputs {
                terminal: i[0] != 0,
                sto: sto != 0,
                // SS1 of the Extended Functions is another one, and without p9652 there is none.
                ss1: ss1 != 0 || path.extended() || !delayed,
            };
            let (_, out) = next(basic_selection::State, &config, &inputs);
            o.extend([
                bit(path.selects_sto()),
                bit(out.sto),
                bit(out.ss1_terminals || out.ss1_profisafe),
                bit(out.sto_terminals),
                bit(out.sto_profisafe && telegram),
                bit(out.ss1_terminals),
                bit(out.ss1_profisafe && telegram),
            ]);
        },
    )
    .kept(0, "code")
    .kept(1, "ss1")
}

/// An F-DO: which of its sources are connected and whether it is registered for the test.
fn output(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<fail_safe_output::Monitor>(mutant);
    let adapter = Adapter::of(
        vec![
            "s0", "s1", "s2", "s3", "s4", "s5", "testing", "do_plus", "do_minus",
        ],
        vec!["plus", "minus"],
        vec![truth(); 7],
        vec![0; 7],
        move |cells, i, o| {
            let connected = std::array::from_fn(|k| cells[k] != 0);
            let config = fail_safe_output::Config::new(connected, cells[6] != 0);
            let inputs = fail_safe_output::Inputs {
                sources: std::array::from_fn(|k| i[k] != 0),
                testing: i[6] != 0,
                test_plus: i[7] != 0,
                test_minus: i[8] != 0,
            };
            let (_, out) = next(fail_safe_output::State, &config, &inputs);
            o.extend([bit(out.plus), bit(out.minus)]);
        },
    );
    let states = ["c0", "c1", "c2", "c3", "c4", "c5", "tested"];
    kept(adapter, &states)
}

/// The first cells start with the values of these states.
fn kept(adapter: Adapter, states: &[&'static str]) -> Adapter {
    let states = states.iter().enumerate();
    states.fold(adapter, |adapter, (cell, name)| adapter.kept(cell, name))
}

/// The word of these bits, the lowest first.
fn word(bits: &[i32]) -> u8 {
    let bits = bits.iter().enumerate();
    bits.fold(0, |word, (k, bit)| word | u8::from(*bit != 0) << k)
}

/// Safe State of two drives with four of the functions.
fn safe(mutant: Option<Mutant>) -> Adapter {
    const INPUTS: [&str; 8] = [
        "a[0]", "a[1]", "a[2]", "a[3]", "b[0]", "b[1]", "b[2]", "b[3]",
    ];
    let next = chosen::<safe_state::Monitor>(mutant);
    let adapter = Adapter::of(
        INPUTS.to_vec(),
        vec!["group_sto", "safe"],
        vec![truth(); 4],
        vec![0; 4],
        move |cells, i, o| {
            let config = safe_state::Config::new(word(cells), 2);
            // What drives beyond the second one say does not count.
            let mut active = [0; 6];
            active[0] = word(&i[..4]);
            active[1] = word(&i[4..]);
            let inputs = safe_state::Inputs { active };
            let out = config.map(|config| next(safe_state::State, &config, &inputs).1);
            let out = out.unwrap_or_default();
            o.extend([bit(out.group & 1 != 0), bit(out.safe)]);
        },
    );
    kept(adapter, &["e[0]", "e[1]", "e[2]", "e[3]"])
}

/// The test stop of inputs and outputs. The mode and the test at POWER ON are states of the table; a step that has failed is one
/// of its own there.
fn test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let inputs = p.is("inputs");
    let (level, interval) = (p.time("t_level"), p.time("t_interval"));
    let config = move |cells: &[i32]| {
        let mode = value(&io_test::Mode::ALL, cells[0] - 1);
        io_test::Config::new(inputs, mode, level, interval, cells[1] != 0)
    };
    config(&[1, 0])?;
    let next = chosen::<io_test::Monitor>(mutant);
    let initial = [vec![1, 0], stored(io_test::State::INITIAL)].concat();
    let domains = vec![
        Domain { lo: 1, hi: 3 },
        truth(),
        upto(7),
        truth(),
        upto(p.value("t_level")),
        upto(p.value("t_interval")),
        truth(),
    ];
    let adapter = Adapter::of(
        vec![
            "power_on", "start", "ready", "zero_1", "zero_2", "level", "ack",
        ],
        vec![
            "running", "required", "fault", "failed", "l1", "l2", "do_plus", "do_minus", "timer",
            "was",
        ],
        domains,
        initial,
        move |cells, i, o| {
            let Ok::<_, ConfigError>(config) = config(cells) else {
                return;
            };
            let inputs = io_test::Inputs {
                power_on: i[0] != 0,
                start: i[1] != 0,
                ready: i[2] != 0,
                first_inputs: i[3] == 0,
                second_inputs: i[4] == 0,
                read_back: i[5] != 0,
                acknowledge: i[6] != 0,
            };
            let (after, out) = next(load(&cells[2..]), &config, &inputs);
            store(after, &mut cells[2..]);
            o.extend([
                bit(out.running),
                bit(out.due),
                bit(out.fault),
                i64::from(ordinal(&io_test::TestStep::ALL, out.fault_step)),
                bit(out.l1),
                bit(out.l2),
                bit(out.plus),
                bit(out.minus),
                i64::from(after.timer.count()),
                bit(after.started),
            ]);
        },
    );
    Ok(kept(adapter, &["mode", "auto"]))
}

/// A message that is none of the table's: six of them fill the current case but for the two places that the table has.
const FILLER: u16 = 9;

/// Two cells: the messages of a case that are the table's.
fn places(case: &Case) -> [i32; 2] {
    let mut codes = case.messages().iter().filter(|code| **code != FILLER);
    std::array::from_fn(|_| codes.next().map_or(0, |code| i32::from(*code)))
}

/// A case with the messages of two cells behind some fillers.
fn case(cells: &[i32], fillers: usize) -> Case {
    let messages = cells.iter().copied().filter(|code| *code != 0);
    let fillers = std::iter::repeat_n(i32::from(FILLER), fillers);
    // First how many there are.
    let mut numbers = vec![0];
    numbers.extend(fillers.chain(messages));
    numbers[0] = numbers.len() as i32 - 1;
    numbers.resize(message_buffer::MESSAGES + 1, 0);
    load(&numbers)
}

/// The message buffer. The table has the last two places of the current case, and the first two acknowledged cases.
fn buffer(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<message_buffer::Monitor>(mutant);
    let domains = [vec![upto(2); 6], vec![upto(3)]].concat();
    Adapter::of(
        vec!["power_on", "message", "ack", "gone_1", "gone_2", "clear"],
        vec![
            "a0", "a1", "b0", "b1", "c0", "c1", "changes", "changed", "present",
        ],
        domains,
        vec![0; 7],
        move |cells, i, o| {
            let step = |fillers: usize| {
                let mut acknowledged = [Case::EMPTY; 7];
                acknowledged[0] = case(&cells[2..4], 0);
                acknowledged[1] = case(&cells[4..6], 0);
                let state = message_buffer::State {
                    current: case(&cells[..2], fillers),
                    acknowledged,
                    changes: cells[6].unsigned_abs() as u16,
                };
                let gone = |code: &i32| (*code == 1 && i[3] != 0) || (*code == 2 && i[4] != 0);
                let bits = cells[..2].iter().enumerate();
                let mask = bits.fold(0, |mask, (k, code)| mask | u8::from(gone(code)) << k);
                let inputs = message_buffer::Inputs {
                    power_on: i[0] != 0,
                    clear: i[5] != 0,
                    message: i[1].unsigned_abs() as u16,
                    acknowledge: i[2] != 0,
                    rectified: mask << fillers,
                };
                next(state, &message_buffer::Config, &inputs)
            };
            // Clearing takes the fillers away too, which is a change that the table does not have. Whether a message is present
            // shows without them only.
            let cleared = i[0] != 0 || i[5] != 0;
            let (_, alone) = step(0);
            let (after, out) = step(if cleared {
                0
            } else {
                message_buffer::MESSAGES - 2
            });
            let cases = [
                places(&after.current),
                places(&after.acknowledged[0]),
                places(&after.acknowledged[1]),
            ];
            cells[..6].copy_from_slice(&cases.concat());
            cells[6] = i32::from(after.changes % 4);
            o.extend(cells.iter().map(|cell| i64::from(*cell)));
            o.extend([bit(out.changed), bit(alone.present)]);
        },
    )
}

/// A replaced component of either kind.
fn replaced(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<replacement::Monitor>(mutant);
    Adapter::of(
        vec!["power_on", "exchange", "ack", "p9702", "save"],
        vec!["message", "confirmed", "r9776_2", "r9776_3"],
        vec![truth(), truth(), truth(), upto(2)],
        [vec![0], stored(replacement::State::INITIAL)].concat(),
        move |cells, i, o| {
            let config = replacement::Config::new(cells[0] != 0);
            let inputs = replacement::Inputs {
                power_on: i[0] != 0,
                exchanged: i[1] != 0,
                acknowledge: i[2] != 0,
                confirm: i[3] != 0,
                save: i[4] != 0,
            };
            let (after, out) = next(load(&cells[1..]), &config, &inputs);
            store(after, &mut cells[1..]);
            o.extend([
                i64::from(ordinal(&replacement::Message::ALL, out.message)),
                bit(after.confirmed),
                bit(out.replaced),
                bit(out.confirmation),
            ]);
        },
    )
    .kept(0, "needs")
    .kept(2, "confirmed")
}
