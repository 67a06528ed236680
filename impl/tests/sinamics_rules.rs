//! What monitors of SINAMICS S120 do together, or over all values of a parameter, where the manual states it in one sentence.

use stillpoint_monitors::kernel::{Cycles, Distance, Percent, Position, Speed};
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::io_test::{self, Mode, TestStep};
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::sdi::{self, Permitted, SdiRef};
use stillpoint_monitors::sinamics::sls::{self, Level, Slsd};
use stillpoint_monitors::sinamics::ss2::{self, Ss2Deselect};
use stillpoint_monitors::sinamics::telegram::diagnosis::StatusSignals;
use stillpoint_monitors::sinamics::telegram::status::StatusWord2;
use stillpoint_monitors::sinamics::types::{self, Braking};
use stillpoint_monitors::sinamics::{
    basic_stop, fail_safe_input, fail_safe_output, setpoint_limit, sos, stop_arbiter,
};

/// S120-STO-002: STO can be selected with the printed values of p9601, and with no other.
#[test]
fn sto_can_be_selected_with_the_printed_codes() {
    let selects = |code: &u32| ControlPath::new(*code).is_ok_and(ControlPath::selects_sto);
    let found: Vec<u32> = (0..=0x1ff).filter(selects).collect();
    assert_eq!(found, [1, 4, 5, 8, 9, 0xc, 0xd, 0x25, 0x40, 0x41]);
}

/// S120-ARCH-005: without encoder SS2 cannot be configured, and SLS and SDI with STOP A and B only.
#[test]
fn without_encoder_some_functions_do_not_exist() {
    let time = Cycles::new(1);
    let kinds = [
        Braking::EncoderSam,
        Braking::EncoderSbr,
        Braking::BareSam,
        Braking::BareSbr,
    ];
    let ss2 = kinds.map(|kind| ss2::Config::new(time, time, time, kind, Ss2Deselect::RunToEnd));
    assert_eq!(ss2.map(|c| c.is_ok()), [true, true, false, false]);
    let responses = types::Stop::ALL.map(|response| {
        kinds.map(|kind| {
            let (limits, encoder) = ([Speed(1); 4], kind.encoder());
            let sls = sls::Config::new(
                limits,
                [response; 4],
                time,
                encoder,
                false,
                false,
                Slsd::Keep,
            );
            let sdi = sdi::Config::new(
                Permitted::Positive,
                time,
                Distance(1),
                response,
                encoder,
                false,
                false,
                SdiRef::Trail,
            );
            assert_eq!(sls.is_ok(), sdi.is_ok());
            sls.is_ok()
        })
    });
    let (none, encoder, all) = ([false; 4], [true, true, false, false], [true; 4]);
    // None, E, D, C, B, A.
    assert_eq!(responses, [none, encoder, encoder, encoder, all, all]);
}

/// S120-STOP-526: SDI and SLP cover nothing; SS2E before its end covers what D covers, and takes the place of nothing.
#[test]
fn the_rows_that_the_table_of_priorities_does_not_have() {
    let stops = [Stop::E, Stop::D, Stop::C, Stop::B, Stop::A, Stop::Locked];
    let covered = |function: Function| stops.map(|stop| function.covers(stop));
    assert_eq!(covered(Function::Watching), [false; 6]);
    assert_eq!(
        covered(Function::Ss2e),
        [true, true, false, false, false, false]
    );
    for function in [Function::Watching, Function::Ss2e] {
        assert!(stops.iter().all(|stop| !function.displaces(*stop)));
        assert!(function.follows_up() && !function.ends_without_pulses());
    }
}

/// S120-STOP-001: a fault that cannot be acknowledged takes the pulses at once; neither a deselection nor an acknowledgement ends that,
/// and POWER ON only with the cause gone.
#[test]
fn a_locked_stop_of_the_basic_functions_needs_power_on() {
    let config = basic_stop::Config::new(Cycles::new(5)).expect("a short delay");
    let mut stop = basic_stop::Monitor::new(config);
    let mut off = |power_on, locking, other: bool| {
        let inputs = basic_stop::Inputs {
            power_on,
            locking,
            acknowledge: other,
            internal_event_ack: other,
            ..basic_stop::Inputs::default()
        };
        stop.step(&inputs).pulses_off
    };
    assert!(!off(false, false, false));
    assert!(off(false, true, false), "in the same cycle");
    assert!(off(false, false, true) && off(false, false, false));
    assert!(off(true, true, false), "the cause is there");
    assert!(off(false, false, true));
    assert!(!off(true, false, false));
}

fn arbiter() -> stop_arbiter::Monitor {
    let [t_b, t_c, t_d, t_e, t_f] = [3, 2, 2, 2, 2].map(Cycles::new);
    let config = stop_arbiter::Config::new(t_b, t_c, t_d, t_e, t_f, false, false);
    stop_arbiter::Monitor::new(config.expect("short times"))
}

/// S120-SOS-006: a difference between the channels while SOS is active is STOP F, and p9555 later STOP B, then STOP A.
#[test]
fn a_system_error_during_sos() {
    let mut arbiter = arbiter();
    let mut inputs = stop_arbiter::Inputs {
        difference: true,
        function: Function::Sos,
        ..stop_arbiter::Inputs::default()
    };
    let seen: [(bool, Stop); 6] = core::array::from_fn(|_| {
        let outputs = arbiter.step(&inputs);
        inputs.difference = false;
        (outputs.fault, outputs.stop)
    });
    let stops = [Stop::None, Stop::None, Stop::B, Stop::B, Stop::B, Stop::A];
    assert_eq!(seen, stops.map(|stop| (true, stop)));
}

/// S120-SDI-009, S120-SDI-004: SDI with STOP C is deselected and selected anew, and only then acknowledged; until then the
/// setpoint has no effect. An acknowledgement while the direction is violated releases nothing.
#[test]
fn a_blocked_direction_is_selected_anew_and_acknowledged() {
    let config = sdi::Config::new(
        Permitted::Positive,
        Cycles::ZERO,
        Distance(100),
        types::Stop::C,
        true,
        false,
        false,
        SdiRef::Trail,
    );
    let mut sdi = sdi::Monitor::new(config.expect("accepted"));
    let mut arbiter = arbiter();
    let mut cycle = |selected, position, acknowledge| {
        let inputs = sdi::Inputs {
            selected,
            position: Position(position),
            pulses: true,
        };
        let watched = sdi.step(&inputs);
        let stop = match watched.demand {
            types::Stop::None => Stop::None,
            _ => Stop::C,
        };
        let told = arbiter.step(&stop_arbiter::Inputs {
            request: stop,
            remaining: stop,
            function: if watched.active {
                Function::Watching
            } else {
                Function::None
            },
            acknowledge,
            ..stop_arbiter::Inputs::default()
        });
        (watched.violated, told.stop, told.setpoint_zero)
    };
    let free = (false, Stop::None, false);
    assert_eq!(cycle(true, 0, false), free);
    assert_eq!(cycle(true, -101, false), (true, Stop::C, true));
    assert_eq!(
        cycle(true, -101, true),
        (true, Stop::C, true),
        "still violated"
    );
    let stopped = (false, Stop::C, true);
    assert_eq!(cycle(false, -101, false), stopped, "deselected");
    assert_eq!(cycle(true, -101, false), stopped, "selected anew");
    assert_eq!(cycle(true, -101, true), free, "acknowledged");
    assert_eq!(
        cycle(true, -202, false),
        (true, Stop::C, true),
        "from the new place"
    );
}

fn speed_limits(delay: Cycles) -> sls::Monitor {
    let limits = [100, 200, 300, 400].map(Speed);
    let config = sls::Config::new(
        limits,
        [types::Stop::A; 4],
        delay,
        true,
        false,
        false,
        Slsd::Keep,
    );
    sls::Monitor::new(config.expect("accepted"))
}

/// S120-SLS-500: one value of p9551 delays the selection of SLS and of SOS and a lower level of SLS; the setpoint is limited at once,
/// to the part p9533 of the limit.
#[test]
fn one_delay_for_sls_and_sos() {
    for cycles in 1..6 {
        let delay = Cycles::new(cycles);
        let mut sls = speed_limits(delay);
        let mut sos = sos::Monitor::new(sos::Config {
            delay,
            tolerance: Distance(0),
        });
        let mut inputs = sls::Inputs {
            selected: true,
            level: Level::from_bits(true, true),
            ..sls::Inputs::default()
        };
        let selected = sos::Inputs {
            selected: true,
            ..sos::Inputs::default()
        };
        for cycle in 0..=cycles {
            let active = cycle == cycles;
            assert_eq!(sls.step(&inputs).active, active);
            assert_eq!(sos.step(&selected).active, active);
        }
        inputs.level = Level::FIRST;
        for cycle in 0..=cycles {
            let limit = Speed(if cycle == cycles { 100 } else { 400 });
            assert_eq!(sls.step(&inputs).limit, limit);
        }
    }
    let percent = Percent::new(80).expect("a part");
    let config = setpoint_limit::Config::new(percent, 1, 1, false).expect("a ratio");
    let mut limit = setpoint_limit::Monitor::new(config);
    let limited = limit.step(&setpoint_limit::Inputs {
        sls: true,
        limit: Speed(100),
        ..setpoint_limit::Inputs::default()
    });
    assert_eq!((limited.positive, limited.negative), (Speed(80), Speed(80)));
}

/// S120-FDI-504: level 11, SLS4. A discrepancy at one of both F-DIs leaves its bit 0, at both SLS1; the lower limit has its p9551.
#[test]
fn frozen_level_inputs_select_sls1() {
    let config = fail_safe_input::Config::new(Cycles::new(2), false, false).expect("a time");
    let run = |broken: [bool; 2]| {
        let mut fdi = [fail_safe_input::Monitor::new(config); 2];
        let mut sls = speed_limits(Cycles::new(3));
        let mut levels = Vec::new();
        for cycle in 0..12 {
            let read = [0, 1].map(|k| {
                let input2 = cycle < 6 || !broken[k];
                fdi[k].step(&fail_safe_input::Inputs {
                    input1: true,
                    input2,
                    ..fail_safe_input::Inputs::default()
                })
            });
            let outputs = sls.step(&sls::Inputs {
                selected: true,
                level: Level::from_bits(read[1].value, read[0].value),
                ..sls::Inputs::default()
            });
            levels.push(outputs.limit.0);
            assert_eq!(read.map(|r| r.fault), broken.map(|b| b && cycle >= 8));
        }
        levels
    };
    let after = |limit: u32| [vec![0; 3], vec![400; 6], vec![limit; 3]].concat();
    assert_eq!(run([false, false]), after(400));
    assert_eq!(run([true, false]), after(300));
    assert_eq!(run([false, true]), after(200));
    assert_eq!(run([true, true]), after(100));
}

/// Every level that a test must read comes in the last cycle that is granted: how many cycles it runs.
fn longest_test(tm54f: bool, read: u32) -> u32 {
    let [wait, interval] = [read, 1000].map(Cycles::new);
    let config = io_test::Config::new(tm54f, Mode::Actuator, wait, interval, false);
    let mut test = io_test::Monitor::new(config.expect("times"));
    test.step(&io_test::Inputs::default());
    let mut inputs = io_test::Inputs {
        start: true,
        ready: true,
        ..io_test::Inputs::default()
    };
    let mut outputs = test.step(&inputs);
    let mut cycles = 0;
    while outputs.running {
        cycles += 1;
        let step = test.state().step;
        let good = test.state().timer == Cycles::new(1);
        let expected = step.expected(Mode::Actuator);
        inputs.first_inputs = !good;
        inputs.second_inputs = !good;
        inputs.read_back = expected == good;
        outputs = test.step(&inputs);
    }
    assert!(!outputs.due && test.state().step == TestStep::Idle);
    cycles
}

/// S120-TESTSTOP-502, S120-TESTSTOP-510: the longest test that passes takes no longer than the printed formulas say.
#[test]
fn a_test_ends_in_the_printed_time() {
    for read in 1..20 {
        let (output, both) = (longest_test(false, read), longest_test(true, read));
        assert_eq!((output, both), (5 * read, 7 * read));
        assert!(output <= 8 + 6 * read, "8 p9500 and 6 p10001");
        assert!(
            both <= 3 + 3 * read + 8 + 6 * read,
            "3 r10015 and 3 X, 8 r10015 and 6 Y"
        );
    }
}

/// S120-FDO-501: each printed signal of a drive switches an F-DO that it alone is connected to; "SLP active" is qualified by the
/// reference. Safe State is a monitor of its own.
#[test]
fn each_printed_signal_switches_an_output() {
    type Source = fn(&StatusWord2) -> bool;
    // STO, SS1, SS2, SOS, SLS, SSM, SOS selected, internal event, SLS level bits 0 and 1, SDI positive and negative, SLP, area.
    let sources: [(u32, Source); 14] = [
        (0, |w| w.sto_active),
        (1, |w| w.ss1_active),
        (2, |w| w.ss2_active),
        (3, |w| w.sos_active),
        (4, |w| w.sls_active),
        (15, |w| w.ssm),
        (29, |w| w.sos_selected),
        (7, |w| w.internal_event),
        (9, |w| w.sls_level_0),
        (10, |w| w.sls_level_1),
        (12, |w| w.sdi_positive_active),
        (13, |w| w.sdi_negative_active),
        (6, |w| w.slp_active),
        (19, |w| w.slp_area_2),
    ];
    let mut output = fail_safe_output::Monitor::new(fail_safe_output::Config::new(
        [false, false, true, false, false, false],
        false,
    ));
    let mut on = |signal: bool| {
        let mut inputs = fail_safe_output::Inputs::default();
        inputs.sources[2] = signal;
        output.step(&inputs).plus
    };
    for (bit, source) in sources {
        assert!(on(source(&StatusWord2::decode(1 << bit))), "bit {bit}");
        assert!(!on(source(&StatusWord2::decode(!(1 << bit)))), "bit {bit}");
    }
    let slp = |safely_referenced| StatusSignals {
        slp_active: true,
        safely_referenced,
        ..StatusSignals::decode(0)
    };
    for safe in [false, true] {
        assert_eq!(on(slp(safe).status_word(false).slp_active), safe);
    }
}
