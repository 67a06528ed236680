//! The blocks for storage and retrieval machines as a library.

use std::collections::BTreeSet;

use stillpoint_harness::families::FAMILIES;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::srm::common::ErrReact;
use stillpoint_monitors::srm::interpolation::{self, Curve};
use stillpoint_monitors::srm::{brake_test, endzone, load_monitor, safe_pos, sbr_monitor};

const CALCULATION: u16 = 0x800;

fn curve() -> Curve {
    Curve {
        x: std::array::from_fn(|k| if k == 0 { 0 } else { 4_000 }),
        v: std::array::from_fn(|k| if k == 0 { 0 } else { 120_000 }),
        x_16: 4_000,
        v_16: 120_000,
    }
}

fn safe_position() -> safe_pos::Config {
    safe_pos::Config {
        t_sample: 20,
        pos_config: false,
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
        sync_pos2: safe_pos::SyncPos2::Keep,
        count_watch: safe_pos::CountWatch::Watch,
        err_react: ErrReact::Safe,
    }
}

/// SRM-ARCH-001: table 3-1 (lines 528 to 540) has twelve blocks. Each is a monitor that is compared with a table; F_LOAD_MONITOR is two,
/// its supervision and its calibration.
#[test]
fn every_block_of_the_library_is_a_monitor() {
    let printed = [
        "safe_pos",
        "slp_monitor",
        "endzone",
        "brake_test",
        "load_monitor",
        "load_calibration",
        "sbr_monitor",
        "min_max",
        "interpolation",
        "add_dint",
        "sub_dint",
        "mul_dint",
        "div_dint",
    ];
    let family = FAMILIES.into_iter().find(|f| f.name == "srm-fblocks");
    let peers = &family.expect("the family").peers;
    let compared = peers.machines().chain(peers.systems());
    let modules: BTreeSet<&str> = compared.map(|(_, module)| module).collect();
    assert_eq!(modules, BTreeSet::from(printed));
}

/// SRM-ARCH-004: a calculation of each block that leaves a DInt is told, and takes its enables; F_SLP_MONITOR calculates nothing.
#[test]
fn every_overflow_is_told() {
    let mut position = safe_pos::Monitor::new(safe_position());
    let valid = safe_pos::Inputs {
        pos1: -i32::MAX,
        pos1_valid: true,
        possi_valid: true,
        ..safe_pos::Inputs::default()
    };
    position.step(&valid);
    let told = position.step(&safe_pos::Inputs {
        reference: true,
        ..valid
    });
    assert!(told.diag & 0x2000 != 0 && told.error && !told.pos_valid && !told.referenced);

    let mut zone = endzone::Monitor::new(endzone::Config {
        vmax_release: 1_000,
        interpolation: curve(),
        vinv_retract: endzone::VinvRetract::Stop,
        ez_dir: endzone::EzDir::Expire,
        err_react: ErrReact::Safe,
    });
    let told = zone.step(&endzone::Inputs {
        safe_pos: -i32::MAX,
        pos_valid: true,
        v_valid: true,
        x_negative: -i32::MAX,
        x_positive: i32::MAX,
        ..endzone::Inputs::default()
    });
    assert!(told.diag & CALCULATION != 0 && told.error && !told.x_positive_ok && !told.sls_ok);

    let mut ramp = sbr_monitor::Monitor::new(sbr_monitor::Config {
        t_sample: 20,
        t_ramp: 8_000,
        v_max: 240_000,
        v_stop_monitoring: 100,
        maxtol_v: 10_000,
        maxtol_pos: 200,
        sbr_pos: sbr_monitor::SbrPos::Cum,
        sbr_retrig: sbr_monitor::SbrRetrig::Ignore,
        err_react: ErrReact::Safe,
    });
    let from = sbr_monitor::Inputs {
        safe_pos: -i32::MAX,
        ..sbr_monitor::Inputs::default()
    };
    ramp.step(&from);
    ramp.step(&sbr_monitor::Inputs {
        execute: true,
        ..from
    });
    let told = ramp.step(&sbr_monitor::Inputs {
        safe_pos: i32::MAX,
        execute: true,
        ..from
    });
    assert!(told.diag & CALCULATION != 0 && told.error && !told.sbr_ok);

    let mut brake = brake_test::Monitor::new(brake_test::Config {
        t_interval: Cycles::new(1_000),
        t_sample: 20,
        sequence_br_1: 17,
        t_open_br_1: 100,
        t_close_br_1: 100,
        sequence_br_2: 0,
        t_open_br_2: 100,
        t_close_br_2: 100,
        pos_tolerance: 5,
        vmax_release: 1_000,
        t_mon_sel: Cycles::new(10),
        t_mon_req: Cycles::new(10),
        unproven: brake_test::Unproven::Restricted,
        sbt_fresh: brake_test::SbtFresh::Fresh,
        err_react: ErrReact::Safe,
    });
    let still = brake_test::Inputs {
        safe_pos: -i32::MAX,
        v_valid: true,
        pos_valid: true,
        sbt: brake_test::Status {
            selected: true,
            ..brake_test::Status::default()
        },
        ..brake_test::Inputs::default()
    };
    brake.step(&still);
    brake.step(&brake_test::Inputs {
        execute: true,
        ..still
    });
    assert!(brake.step(&still).busy);
    let told = brake.step(&brake_test::Inputs {
        safe_pos: i32::MAX,
        ..still
    });
    assert!(told.diag & CALCULATION != 0 && told.error && !told.busy && !told.release_dir);

    let mut load = load_monitor::Monitor::new(load_monitor::Config {
        maxtol_load: 200,
        maxload_dyn: 10_000,
        maxload_stat: 9_000,
        minload: 800,
        vmax_release: 1_000,
        cal_value: 5_000,
        maxtol_cal: 200,
        t_sample: 20,
        t_test: 3_000,
        t_settle: 1_000,
        err_react: ErrReact::Safe,
    });
    let told = load.step(&load_monitor::Inputs {
        load1: -i32::MAX,
        load2: i32::MAX,
        v_valid: true,
        ..load_monitor::Inputs::default()
    });
    assert!(told.diag & CALCULATION != 0 && told.error && !told.stat_load_ok);

    let steep = Curve {
        x_16: 2_000_000_000,
        v_16: 2_000_000_000,
        ..curve()
    };
    let told = interpolation::Monitor::new(interpolation::Config { curve: steep }).step(
        &interpolation::Inputs {
            x_actual: 1_000_000_000,
        },
    );
    assert!(told.error && told.v_limit == 0);
}

/// SRM-ARCH-006: two instances of a block, one of which is referenced: the other one is not.
#[test]
fn instances_are_independent() {
    let (mut one, mut two) = (
        safe_pos::Monitor::new(safe_position()),
        safe_pos::Monitor::new(safe_position()),
    );
    let valid = safe_pos::Inputs {
        pos1: 5_000,
        pos1_valid: true,
        possi_valid: true,
        ..safe_pos::Inputs::default()
    };
    for reference in [false, true, false] {
        let first = one.step(&safe_pos::Inputs { reference, ..valid });
        let second = two.step(&valid);
        assert!(!second.referenced && second.diag == 0x80);
        assert!(first.referenced || first.diag == 0x80);
    }
    assert!(one.step(&valid).referenced);
}
