//! Runs of the blocks for storage and retrieval machines over many calls: properties that one call cannot show.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::srm::brake_test::{self, SbtFresh, Status, Unproven};
use stillpoint_monitors::srm::common::ErrReact;
use stillpoint_monitors::srm::safe_pos::{self, CountWatch, SyncPos2};
use stillpoint_monitors::srm::sbr_monitor::{self, SbrPos, SbrRetrig};

/// Numbers that come again: xorshift.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn upto(&mut self, most: i32) -> i32 {
        (self.next() % (most as u64 + 1)) as i32
    }

    fn one_in(&mut self, count: u64) -> bool {
        self.next() % count == 0
    }
}

fn ramp(t_ramp: i32, v_max: i32) -> sbr_monitor::Config {
    sbr_monitor::Config {
        t_sample: 20,
        t_ramp,
        v_max,
        v_stop_monitoring: 60,
        maxtol_v: 100,
        maxtol_pos: 3,
        sbr_pos: SbrPos::Cum,
        sbr_retrig: SbrRetrig::Ignore,
        err_react: ErrReact::Safe,
    }
}

/// SRM-P-41, SRM-P-42, SRM-SBR-019: after N calls the ramp is 0, and its way that of the sum, whatever EXECUTE does on the way.
#[test]
fn the_ramp_ends_after_its_calls() {
    for calls in 1..=40 {
        for hold in [false, true] {
            let mut monitor = sbr_monitor::Monitor::new(ramp(20 * calls, 600 * calls));
            let mut inputs = sbr_monitor::Inputs::default();
            let _ = monitor.step(&inputs);
            inputs.execute = true;
            let mut parts = 0_i64;
            for call in 0..calls {
                let outputs = monitor.step(&inputs);
                assert!(outputs.busy && outputs.ramping && outputs.sbr_ok);
                assert_eq!(outputs.v_threshold, 600 * (calls - call) + 100);
                assert_eq!(i64::from(outputs.pos_threshold), parts / 60_000 + 3);
                parts += i64::from(600 * (calls - call)) * 20;
                inputs.execute = hold || call % 2 == 1;
            }
            inputs.execute = hold;
            let outputs = monitor.step(&inputs);
            assert_eq!((outputs.busy, outputs.ramping), (hold, false));
            inputs.execute = false;
            assert!(!monitor.step(&inputs).busy);
        }
    }
}

/// SRM-P-40: while the enable is there an axis has gone at most the way of the ramp and the tolerance.
#[test]
fn the_way_is_bounded() {
    let mut dice = Dice(1);
    let config = ramp(200, 6_000);
    let whole = (0..10)
        .map(|k| i64::from(6_000 - 600 * k) * 20)
        .sum::<i64>()
        / 60_000;
    let mut furthest = 0;
    for _ in 0..2_000 {
        let mut monitor = sbr_monitor::Monitor::new(config);
        let mut inputs = sbr_monitor::Inputs::default();
        let _ = monitor.step(&inputs);
        inputs.execute = true;
        for _ in 0..20 {
            let outputs = monitor.step(&inputs);
            if outputs.busy && outputs.sbr_ok {
                furthest = furthest.max(inputs.safe_pos);
            }
            inputs.safe_pos += dice.upto(3);
        }
    }
    assert!(
        i64::from(furthest) <= whole + 3 && furthest > 3,
        "{furthest}"
    );
}

/// SRM-P-44: at rest a violation can be acknowledged within N + 1 calls after EXECUTE has gone.
#[test]
fn a_violation_can_be_left() {
    for calls in 1..=10 {
        let mut monitor = sbr_monitor::Monitor::new(ramp(20 * calls, 600 * calls));
        let mut inputs = sbr_monitor::Inputs::default();
        let _ = monitor.step(&inputs);
        inputs.execute = true;
        inputs.safe_v = 100_000;
        assert!(!monitor.step(&inputs).sbr_ok);
        let mut left = None;
        for call in 1..=calls + 1 {
            inputs = sbr_monitor::Inputs {
                ack: call % 2 == 1,
                ..sbr_monitor::Inputs::default()
            };
            if monitor.step(&inputs).sbr_ok {
                left = left.or(Some(call));
            }
        }
        assert!(left.is_some(), "{calls}");
    }
}

fn brakes(first: u16, second: u16) -> brake_test::Config {
    brake_test::Config {
        t_interval: Cycles::new(1_000),
        t_sample: 20,
        sequence_br_1: first,
        t_open_br_1: 40,
        t_close_br_1: 60,
        sequence_br_2: second,
        t_open_br_2: 20,
        t_close_br_2: 20,
        pos_tolerance: 0,
        vmax_release: 600,
        t_mon_sel: Cycles::new(4),
        t_mon_req: Cycles::new(4),
        unproven: Unproven::Restricted,
        sbt_fresh: SbtFresh::Fresh,
        err_react: ErrReact::Safe,
    }
}

fn calm() -> brake_test::Inputs {
    brake_test::Inputs {
        v_valid: true,
        pos_valid: true,
        fdback_drive: true,
        ..brake_test::Inputs::default()
    }
}

/// SRM-P-58: no word of the drive that stays as it is passes a test, whatever brakes are configured and whatever they read back.
#[test]
fn a_frozen_drive_passes_nothing() {
    for (first, second) in [(0b1, 0), (0b1_0001, 0), (0, 0b1_1111), (0b1111, 0b1_0101)] {
        for word in 0..256 {
            for closed in [false, true] {
                let mut monitor = brake_test::Monitor::new(brakes(first, second));
                let mut inputs = brake_test::Inputs {
                    sbt: Status::from_word(word),
                    fdback_br_1: closed,
                    fdback_br_2: closed,
                    ..calm()
                };
                for call in 0..60 {
                    inputs.execute = call % 20 > 0;
                    inputs.ack = call % 20 == 19;
                    assert!(!monitor.step(&inputs).test_ok, "{word:b}");
                }
            }
        }
    }
}

/// A drive that does what it is told, one call later.
fn drive(config: &brake_test::Config, last: &brake_test::Outputs, age: u32) -> (Status, u32) {
    let stw = last.stw;
    let external = config.external(stw.br_select);
    let mut status = Status {
        selected: stw.select,
        active_br: stw.br_select,
        ..Status::default()
    };
    if !stw.start {
        return (status, 0);
    }
    let torque = !external || stw.fdback_br;
    let age = age + u32::from(torque);
    status.close_br = external && age < 4;
    status.active = torque && age < 4;
    status.finished = age >= 4 && (!external || !stw.fdback_br);
    status.result = status.finished;
    (status, age)
}

/// SRM-P-59, SRM-BRAKETEST-013, SRM-BRAKETEST-024: a drive that works passes every configuration, and one without a sequence never.
#[test]
fn a_healthy_drive_passes() {
    for first in 0..32 {
        for second in [0, 0b1, 0b1_0010, 0b1111] {
            let config = brakes(first, second);
            let mut monitor = brake_test::Monitor::new(config);
            let mut last = brake_test::Outputs::default();
            let (mut age, mut passed, mut started) = (0, false, Vec::new());
            for call in 0..200 {
                let (sbt, now) = drive(&config, &last, age);
                age = now;
                let inputs = brake_test::Inputs {
                    sbt,
                    fdback_br_1: !last.open_br_1,
                    fdback_br_2: !last.open_br_2,
                    execute: call > 0,
                    ..calm()
                };
                let inputs = if call == 0 {
                    brake_test::Inputs {
                        fdback_br_1: false,
                        fdback_br_2: false,
                        ..inputs
                    }
                } else {
                    inputs
                };
                let outputs = monitor.step(&inputs);
                if outputs.stw.start && !last.stw.start {
                    let stw = outputs.stw;
                    started.push((stw.br_select, stw.sequence, stw.torque_dir));
                }
                passed |= outputs.test_ok;
                assert!(!outputs.error, "{first:b} {second:b} {:?}", monitor.state());
                last = outputs;
            }
            let tests = config.tests(false) || config.tests(true);
            assert_eq!(passed, tests, "{first:b} {second:b} {:?}", monitor.state());
            let configured = [(false, first), (true, second)].map(|(brake, word): (bool, u16)| {
                (0..4_u16)
                    .filter(move |k| (word >> k) & 1 == 1)
                    .map(move |k| (brake, k >= 2, k % 2 == 1))
            });
            assert_eq!(
                started,
                configured.into_iter().flatten().collect::<Vec<_>>()
            );
        }
    }
}

fn encoders(pos_config: bool) -> safe_pos::Config {
    safe_pos::Config {
        t_sample: 20,
        pos_config,
        possi_t_sample: 12,
        pos_min: 0,
        pos_max: 100_000,
        pos_disc_window: 8,
        pos2_disc_window: 10,
        possi_disc_window: 12,
        pos_startup_tol: 4,
        v_standstill: 60,
        v_max: 240_000,
        v_disc_window: 20,
        v_sync_intervall: 200,
        pos_reference: 1_000,
        count_margin: Cycles::new(1),
        sync_pos2: SyncPos2::Keep,
        count_watch: CountWatch::Watch,
        err_react: ErrReact::Safe,
    }
}

/// SRM-P-16: with a true POSSI, and no SYNC and no fault of POSSI since the reference, a position that counts is true within the window.
/// SRM-P-17: with three encoders and a true POS2 it is too, whatever POS1 and POSSI do.
#[test]
fn one_wrong_encoder_is_found() {
    let mut dice = Dice(2);
    for pos_config in [false, true] {
        let config = encoders(pos_config);
        let window = if pos_config {
            config.pos2_disc_window
        } else {
            config.possi_disc_window
        };
        let (mut counted, mut wrong) = (0, 0);
        for _ in 0..400 {
            let mut monitor = safe_pos::Monitor::new(config);
            // The true place at the reference is 5000 in POS1, 1000 in the axis.
            let (mut place, mut error1, mut slip) = (1_000, 0, 0);
            for call in 0..300 {
                place += dice.upto(80) - 40;
                if call > 3 && dice.one_in(4) {
                    error1 += dice.upto(8) - 4;
                }
                if pos_config && call > 3 && dice.one_in(4) {
                    slip += dice.upto(6_000) - 3_000;
                }
                if dice.one_in(60) {
                    (error1, slip) = (0, 0);
                }
                if call <= 3 {
                    place = 1_000;
                }
                let inputs = safe_pos::Inputs {
                    pos1: 4_000 + place + error1,
                    pos1_valid: !dice.one_in(30),
                    pos2: 50_000 - place,
                    pos2_valid: true,
                    possi: 1_000 * place + slip,
                    possi_valid: true,
                    possi_count: call * 2,
                    // A reference is set at the reference point only, by people who stand there.
                    reference: call == 2,
                    sync: false,
                    ack: dice.one_in(2),
                };
                let inputs = if call <= 3 {
                    safe_pos::Inputs {
                        pos1_valid: true,
                        ..inputs
                    }
                } else {
                    inputs
                };
                let outputs = monitor.step(&inputs);
                if outputs.pos_valid && outputs.referenced {
                    counted += 1;
                    assert!(
                        (outputs.safe_pos - place).abs() <= window,
                        "{inputs:?} {outputs:?}"
                    );
                } else if call > 2 {
                    wrong += 1;
                }
            }
        }
        assert!(counted > 5_000 && wrong > 5_000, "{counted} {wrong}");
    }
}

/// SRM-P-13: from anywhere, with all encoders valid and at rest for two calls, REFERENCE references and SYNC synchronises.
#[test]
fn a_command_leads_out() {
    let mut dice = Dice(3);
    for pos_config in [false, true] {
        for _ in 0..3_000 {
            let mut monitor = safe_pos::Monitor::new(encoders(pos_config));
            let mut inputs = safe_pos::Inputs::default();
            for call in 0..30 {
                inputs = safe_pos::Inputs {
                    pos1: 5_000 + dice.upto(100),
                    pos1_valid: !dice.one_in(5),
                    pos2: 50_000 + dice.upto(20),
                    pos2_valid: !dice.one_in(5),
                    possi: dice.upto(100_000),
                    possi_valid: !dice.one_in(5),
                    possi_count: call,
                    reference: dice.one_in(3),
                    sync: dice.one_in(3),
                    ack: dice.one_in(2),
                };
                let _ = monitor.step(&inputs);
            }
            inputs = safe_pos::Inputs {
                pos1_valid: true,
                pos2_valid: true,
                possi_valid: true,
                reference: false,
                sync: false,
                ack: false,
                ..inputs
            };
            let _ = monitor.step(&inputs);
            let _ = monitor.step(&inputs);
            let referenced = monitor.state().phase == safe_pos::Phase::Referenced;
            let reference = dice.one_in(2);
            let outputs = monitor.step(&safe_pos::Inputs {
                reference,
                sync: !reference,
                ..inputs
            });
            let expected = if reference || referenced {
                safe_pos::Phase::Referenced
            } else {
                safe_pos::Phase::Synced
            };
            assert_eq!(monitor.state().phase, expected);
            assert!(outputs.diag & 0x1F00 == 0);
        }
    }
}
