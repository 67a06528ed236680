//! The numbers and bits that the manual prints.

use super::*;
use crate::kernel::Cycles;

fn config(pos_config: bool) -> Config {
    Config {
        t_sample: 20,
        pos_config,
        possi_t_sample: 12,
        pos_min: 0,
        pos_max: 50_000,
        pos_disc_window: 20,
        pos2_disc_window: 10,
        possi_disc_window: 30,
        pos_startup_tol: 5,
        v_standstill: 60,
        v_max: 240_000,
        v_disc_window: 8,
        v_sync_intervall: 100,
        pos_reference: 1_000,
        count_margin: Cycles::new(1),
        sync_pos2: SyncPos2::Keep,
        count_watch: CountWatch::Watch,
        err_react: ErrReact::Safe,
    }
}

fn inputs(pos1: i32, pos2: i32, possi: i32, possi_count: i32) -> Inputs {
    Inputs {
        pos1,
        pos1_valid: true,
        pos2,
        pos2_valid: true,
        possi,
        possi_valid: true,
        possi_count,
        ..Inputs::default()
    }
}

/// SRM-REF-001 to SRM-REF-008: restart, SYNC, REFERENCE.
#[test]
fn from_the_restart_to_the_reference() {
    let mut monitor = Monitor::new(config(false));
    let outputs = monitor.step(&inputs(5_000, 0, 100, 1));
    assert_eq!(
        (outputs.diag, outputs.error, outputs.pos_valid),
        (0x80, false, false)
    );
    let outputs = monitor.step(&Inputs {
        sync: true,
        ..inputs(5_000, 0, 100, 3)
    });
    assert!(outputs.pos_valid && outputs.v_valid && !outputs.referenced);
    let outputs = monitor.step(&Inputs {
        reference: true,
        ..inputs(5_000, 0, 100, 5)
    });
    assert!(outputs.referenced && outputs.diag == 0 && outputs.safe_pos == 1_000);
}

/// SRM-POSV-001: 20 mm in 2 cycles of 12 ms is 50000 mm/min; one um more is rounded up. The counter wraps.
#[test]
fn velocities() {
    assert_eq!(velocity::velocity(20_000, 2, 12), Some(50_000));
    assert_eq!(velocity::velocity(-20_001, 2, 12), Some(50_003));
    assert_eq!(velocity::velocity(1, 0, 12), None);
    let mut monitor = Monitor::new(config(false));
    monitor.step(&inputs(5_000, 0, 0, 32_767));
    assert_eq!(
        monitor.step(&inputs(5_000, 0, 20_000, -32_767)).safe_v,
        50_000
    );
    assert_eq!(
        monitor.step(&inputs(5_000, 0, 20_000, -32_767)).safe_v,
        50_000
    );
}

/// SRM-POS-011, SRM-POS-012: 30 mm is within the window, more is not, and no acknowledgement helps.
#[test]
fn two_encoders_go_apart() {
    let mut monitor = Monitor::new(Config {
        v_disc_window: 100,
        ..config(false)
    });
    monitor.step(&inputs(5_000, 0, 0, 1));
    monitor.step(&Inputs {
        reference: true,
        ..inputs(5_000, 0, 0, 2)
    });
    assert!(monitor.step(&inputs(5_030, 0, 0, 3)).referenced);
    let outputs = monitor.step(&inputs(5_030, 0, -1, 4));
    assert_eq!(
        (outputs.diag, outputs.pos_valid, outputs.v_valid),
        (0x100, false, false)
    );
    let outputs = monitor.step(&Inputs {
        ack: true,
        ..inputs(5_000, 0, 0, 5)
    });
    assert_eq!((outputs.diag, outputs.ack_req), (0x100, false));
    assert!(
        monitor
            .step(&Inputs {
                sync: true,
                ..inputs(5_000, 0, 0, 6)
            })
            .pos_valid
    );
}

/// SRM-POS-006 to SRM-POS-009: POSSI returns with another value; POS1 has moved by 5 mm, then by 6.
#[test]
fn a_fault_of_the_motor_encoder() {
    for (moved, valid) in [(5, true), (6, false)] {
        let mut monitor = Monitor::new(config(false));
        monitor.step(&inputs(5_000, 0, 0, 1));
        monitor.step(&Inputs {
            reference: true,
            ..inputs(5_000, 0, 0, 2)
        });
        let lost = Inputs {
            possi_valid: false,
            ..inputs(5_000 + moved, 0, 0, 3)
        };
        assert_eq!(monitor.step(&lost).diag, 0x200);
        let back = inputs(5_000 + moved, 0, 777_000, 4);
        let outputs = monitor.step(&back);
        assert_eq!(
            (outputs.ack_req, outputs.diag),
            (valid, if valid { 0x200 } else { 0x600 })
        );
        let outputs = monitor.step(&Inputs { ack: true, ..back });
        assert_eq!((outputs.referenced, outputs.v_valid), (valid, valid));
    }
}

/// SRM-POS-015 to SRM-POS-018: slip of POSSI is acknowledged where POS2, which counts down, confirms POS1.
#[test]
fn slip_with_three_encoders() {
    let mut monitor = Monitor::new(Config {
        v_disc_window: 100,
        ..config(true)
    });
    monitor.step(&inputs(5_000, 20_000, 0, 1));
    monitor.step(&Inputs {
        reference: true,
        ..inputs(5_000, 20_000, 0, 2)
    });
    assert!(monitor.step(&inputs(5_030, 19_980, 0, 3)).referenced);
    assert_eq!(monitor.step(&inputs(5_031, 19_969, 0, 4)).diag, 0x200);
    let outputs = monitor.step(&inputs(5_031, 19_969, 0, 5));
    assert!(outputs.ack_req && outputs.diag == 0x200);
    let outputs = monitor.step(&Inputs {
        ack: true,
        ..inputs(5_031, 19_969, 0, 6)
    });
    assert!(outputs.referenced && outputs.diag == 0 && outputs.safe_pos == 1_031);
}

/// SRM-POS-005: 160 mm in 20 ms are twice 240000 mm/min; one more is a step.
#[test]
fn a_step_of_pos1() {
    for (way, step) in [(160, false), (161, true), (-161, true)] {
        let mut monitor = Monitor::new(config(false));
        monitor.step(&inputs(5_000, 0, 0, 1));
        let outputs = monitor.step(&inputs(5_000 + way, 0, 0, 2));
        assert_eq!(outputs.diag, if step { 0x280 } else { 0x80 });
    }
}

/// SRM-POSPARAM-013 to SRM-POSPARAM-016: the printed ranges.
#[test]
fn parameters_have_their_bits() {
    let right = config(false);
    for (wrong, bits) in [
        (right, 0),
        (
            Config {
                possi_t_sample: 0,
                ..right
            },
            1,
        ),
        (
            Config {
                possi_t_sample: 1_024,
                ..right
            },
            1,
        ),
        (
            Config {
                possi_t_sample: 1_023,
                ..right
            },
            0,
        ),
        (
            Config {
                t_sample: 25,
                ..right
            },
            1,
        ),
        (
            Config {
                t_sample: 24,
                v_sync_intervall: 96,
                ..right
            },
            0,
        ),
        (
            Config {
                v_sync_intervall: 0,
                ..right
            },
            1,
        ),
        (
            Config {
                v_disc_window: -1,
                ..right
            },
            1,
        ),
        (
            Config {
                v_sync_intervall: 110,
                ..right
            },
            2,
        ),
        (Config { v_max: 59, ..right }, 4),
        (
            Config {
                pos_max: -1,
                ..right
            },
            4,
        ),
    ] {
        assert_eq!(wrong.parameter_bits(), bits);
        let outputs = Monitor::new(wrong).step(&inputs(0, 0, 0, 0));
        assert_eq!((outputs.diag, outputs.error), (0x80 | bits, bits != 0));
    }
}

/// SRM-POSV-016: whatever the margin is, a counter that stands for longer is found.
#[test]
fn a_standing_counter_is_found_with_the_greatest_margin() {
    let config = Config {
        count_margin: Cycles::new(u32::MAX),
        ..config(false)
    };
    let state = State {
        phase: Phase::Synced,
        seen_si: true,
        count: 7,
        still: config.standing(),
        ..State::INITIAL
    };
    let (after, outputs) = next(state, &config, &inputs(0, 0, 0, 7));
    assert!(after.phase.formed() && !outputs.v_valid && outputs.diag & 0x40 == 0x40);
}
