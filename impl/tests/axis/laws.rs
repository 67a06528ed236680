//! The laws of the channel and of the axis on long random runs of both channels: every law holds in every cycle, and every
//! premise is met. Debug builds check the contract of every monitor inside as well.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop};
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Pair, State};
use stillpoint_monitors::sinumerik::parameters::{Encoders, Installation, Parameters};
use stillpoint_monitors::{contract::Evaluation, sinumerik::channel};

use crate::machine::parameters;

/// A fixed sequence of numbers (xorshift), so that a failure is found again.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// True once in `rarity` calls on average.
    fn once_in(&mut self, rarity: u64) -> bool {
        self.next() % rarity == 0
    }
}

/// The next inputs of one channel: legal sequences, most signals stay, the axis mostly moves slowly.
fn vary(local: &mut Local, numbers: &mut Numbers) {
    let sge = &mut local.sge;
    for signal in [
        &mut sge.sbh_sg_off,
        &mut sge.sbh_off,
        &mut sge.sg_0,
        &mut sge.sg_1,
        &mut sge.se,
        &mut sge.override_0,
        &mut sge.gear_0,
        &mut sge.test_stop,
        &mut local.shutdown_test_select,
        &mut local.parking,
        &mut local.spl_error,
        &mut local.feedback,
    ] {
        if numbers.once_in(150) {
            *signal = !*signal;
        }
    }
    for signal in [
        &mut sge.stop_a_off,
        &mut sge.stop_c_off,
        &mut sge.stop_d_off,
        &mut sge.stop_e_off,
        &mut local.run_up,
    ] {
        *signal = !numbers.once_in(if *signal { 400 } else { 3 });
    }
    local.power_on = numbers.once_in(500);
    local.reset = numbers.once_in(20);
    local.set_agreement = numbers.once_in(30);
    local.cancel_agreement = numbers.once_in(300);
    local.key = !numbers.once_in(5);
    local.altered = numbers.once_in(1_000);
    local.referenced = numbers.once_in(8);
    local.reference_lost = numbers.once_in(300);
    let stretch = if numbers.once_in(40) { 900 } else { 30 };
    let way = (numbers.next() % (2 * stretch + 1)) as i32 - stretch as i32;
    local.position = Position((local.position.0 + way).clamp(-20_000, 20_000));
    local.refpos = local.position;
    local.encoder_speed = Speed((numbers.next() % 3_700) as u32);
}

/// Both channels against each other; gives the premises of the axis that were met.
fn run_pair(parameters: &Parameters, seed: u64, cycles: u32) -> u64 {
    let config = Config::new(parameters.validate().expect("plausible"));
    let mut pair = Pair::resume(config, State::initial()).expect("consistent");
    let mut numbers = Numbers(seed);
    let mut inputs = Inputs::both(Local::idle());
    let mut seen = 0;
    for cycle in 0..cycles {
        vary(&mut inputs.nck, &mut numbers);
        // Mostly the channels see the same; sometimes one signal differs for a while.
        if !numbers.once_in(10) {
            inputs.drive = inputs.nck;
            if numbers.once_in(20) {
                inputs.drive.position.0 += 150;
            }
        }
        let before = *pair.state();
        let outputs = pair.step(&inputs);
        let after = *pair.state();
        let step = |config: &axis::Config, before, local, other, after, outputs| axis::Step {
            before,
            config: *config,
            inputs: axis::Inputs { local, other },
            after,
            outputs,
        };
        let (nck, drive) = (before.from_nck, before.from_drive);
        for step in [
            step(
                config.nck(),
                before.nck,
                inputs.nck,
                drive,
                after.nck,
                outputs.nck,
            ),
            step(
                config.drive(),
                before.drive,
                inputs.drive,
                nck,
                after.drive,
                outputs.drive,
            ),
        ] {
            seen |= checked(axis::evaluate(step), axis::CLAUSES.len(), cycle, |n| {
                axis::CLAUSES[n].name
            });
        }
    }
    seen
}

/// A channel on its own, told anything; gives the premises that were met.
fn run_channel(parameters: &Parameters, seed: u64, cycles: u32) -> u64 {
    let config = *parameters.validate().expect("plausible").channel();
    let mut numbers = Numbers(seed);
    let mut local = Local::idle();
    let mut state = channel::State::INITIAL;
    let mut seen = 0;
    for cycle in 0..cycles {
        vary(&mut local, &mut numbers);
        let rare = |numbers: &mut Numbers| numbers.once_in(60);
        let inputs = channel::Inputs {
            power_on: local.power_on,
            run_up: local.run_up,
            reset: local.reset,
            spl_started: local.spl_started,
            sge_a: local.sge.stop_a_off,
            sge_c: local.sge.stop_c_off,
            sge_d: local.sge.stop_d_off,
            sge_e: local.sge.stop_e_off,
            sge_sbh_sg: local.sge.sbh_sg_off,
            sge_sbh: local.sge.sbh_off,
            se_active: local.key,
            position: local.position,
            parking: local.parking,
            test_select: local.sge.test_stop,
            feedback: local.feedback,
            set_anew: rare(&mut numbers),
            external_test: rare(&mut numbers),
            discrepancy: rare(&mut numbers),
            rx_fault: rare(&mut numbers),
            rx_internal: InternalStop::ALL[if rare(&mut numbers) { 3 } else { 0 }],
            rx_external: ExternalStop::ALL[if rare(&mut numbers) { 2 } else { 0 }],
            ..channel::Inputs::default()
        };
        let before = state;
        let (after, outputs) = channel::next(before, &config, &inputs);
        state = after;
        let step = channel::Step {
            before,
            config,
            inputs,
            after,
            outputs,
        };
        seen |= checked(
            channel::evaluate(step),
            channel::CLAUSES.len(),
            cycle,
            |n| channel::CLAUSES[n].name,
        );
    }
    seen
}

fn checked(
    result: Evaluation,
    count: usize,
    cycle: u32,
    name: impl Fn(usize) -> &'static str,
) -> u64 {
    if let Some(broken) = result.first_broken(count) {
        panic!("cycle {cycle}: {} is broken", name(broken));
    }
    result.premises
}

/// The laws whose premise was not met.
fn missed(seen: u64, names: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    names
        .enumerate()
        .filter(|(n, _)| seen >> n & 1 == 0)
        .map(|(_, name)| name)
        .collect()
}

/// A linear axis with one encoder and position monitors; a linear axis with two encoders and slip.
fn machines() -> [Parameters; 2] {
    let position = Parameters {
        pos_limit_plus: [15_000, 18_000],
        pos_limit_minus: [-15_000, -18_000],
        ..parameters()
    };
    let slip = Parameters {
        installation: Installation {
            encoders: Encoders::Two,
            ..Installation::default()
        },
        function_enable: 0b100_1001,
        ..parameters()
    };
    [position, slip]
}

#[test]
fn laws_of_the_axis_hold_on_random_runs() {
    let seen = machines()
        .iter()
        .map(|p| run_pair(p, 0x9E37_79B9_7F4A_7C15, 60_000))
        .fold(0, |a, b| a | b);
    assert_eq!(missed(seen, axis::CLAUSES.iter().map(|c| c.name)), [""; 0]);
}

#[test]
fn laws_of_the_channel_hold_on_random_runs() {
    let seen = machines()
        .iter()
        .map(|p| run_channel(p, 0x1234_5678_9ABC_DEF1, 200_000))
        .fold(0, |a, b| a | b);
    assert_eq!(
        missed(seen, channel::CLAUSES.iter().map(|c| c.name)),
        [""; 0]
    );
}
