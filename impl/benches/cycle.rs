//! The cost of a cycle: one axis, one channel, every function that can be active together. Prints the sizes too.
//!
//! `cargo bench -p stillpoint-monitors` measures; nothing here fails by a time.

use std::hint::black_box;

use divan::Bencher;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{self, Config, Inputs, Local, Side, State};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::parameters::{Configuration, Parameters};
use stillpoint_monitors::sinumerik::{channel, pair};

fn main() {
    println!("one axis, one channel, bytes:");
    println!("  state of the axis      {:5}", size_of::<State>());
    println!("  state of the monitors  {:5}", size_of::<channel::State>());
    println!("  configuration          {:5}", size_of::<Config>());
    println!("  inputs                 {:5}", size_of::<Inputs>());
    println!("  told to the other      {:5}", size_of::<axis::Exchange>());
    println!("  outputs                {:5}", size_of::<axis::Outputs>());
    divan::main();
}

/// SBH/SG, SE, STOP E, override, external stops, cam synchronisation, all eight cams.
fn configuration() -> Configuration {
    let parameters = Parameters {
        function_enable: 0xFFF3,
        velo_ovr_factor: [80; 16],
        ..Parameters::default()
    };
    parameters.validate().expect("plausible")
}

/// To and fro, 100 um a cycle.
fn way(cycle: i32) -> Position {
    let place = cycle % 2000;
    Position(100 * if place < 1000 { place } else { 2000 - place })
}

/// A referenced axis moving in SG2 with override, limit switches and cams in use.
fn moving(cycle: i32) -> Local {
    Local {
        power_on: cycle == 0,
        run_up: true,
        spl_started: true,
        sge: Sge {
            sbh_off: true,
            sg_0: true,
            override_0: true,
            ..Sge::UNUSED
        },
        position: way(cycle),
        referenced: true,
        ..Local::default()
    }
}

/// What is measured is an undisturbed axis: a thousand cycles raise neither stop nor fault nor alarm.
fn undisturbed(config: &Config, mut state: State) -> (State, axis::Exchange, i32) {
    let mut other = axis::Exchange::default();
    for cycle in 0..1000 {
        let inputs = Inputs {
            local: moving(cycle),
            other,
        };
        let (after, outputs) = axis::next(state, config, &inputs);
        (state, other) = (after, outputs.exchange);
        assert!(cycle < 3 || outputs.sga.safely_referenced && outputs.alarms.is_empty());
        assert!(!outputs.channel.start_inhibit);
    }
    (state, other, 1000)
}

/// One channel of an axis.
#[divan::bench]
fn one_axis_one_channel(bencher: Bencher) {
    let config = Config::new(Side::Nck, configuration());
    let start = State::restored(true, Some(Position(0)));
    let (mut state, mut other, mut cycle) = undisturbed(&config, start);
    bencher.bench_local(|| {
        let inputs = Inputs {
            local: moving(cycle),
            other,
        };
        let (after, outputs) = axis::next(black_box(state), black_box(&config), black_box(&inputs));
        // The other channel sees the same, so it tells the same.
        other = outputs.exchange;
        state = after;
        cycle += 1;
        outputs.channel.stop.level
    });
}

/// The monitors of one channel alone: without comparison, cams, referencing.
#[divan::bench]
fn monitors_of_one_channel(bencher: Bencher) {
    let configuration = configuration();
    let mut state = channel::State::INITIAL;
    let mut cycle = 0;
    bencher.bench_local(|| {
        let inputs = channel::Inputs {
            run_up: true,
            spl_started: true,
            sge_a: true,
            sge_c: true,
            sge_d: true,
            sge_e: true,
            sge_sbh: true,
            se_active: true,
            position: way(cycle),
            ..channel::Inputs::default()
        };
        let (after, outputs) = channel::next(
            black_box(state),
            black_box(configuration.channel()),
            black_box(&inputs),
        );
        state = after;
        cycle += 1;
        outputs.stop.level
    });
}

/// Both channels of an axis.
#[divan::bench]
fn both_channels(bencher: Bencher) {
    let mut pair = pair::Pair::new(pair::Config::new(configuration()));
    let mut cycle = 0;
    bencher.bench_local(|| {
        let outputs = pair.step(black_box(&pair::Inputs::both(moving(cycle))));
        cycle += 1;
        outputs.nck.channel.stop.level
    });
}
