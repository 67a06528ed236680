//! Referencing, outputs, self-test and checks.

use stillpoint_monitors::heidenhain::reference::AxisRef;
use stillpoint_monitors::heidenhain::sampling::Pulse;
use stillpoint_monitors::heidenhain::start_checks::Start;
use stillpoint_monitors::heidenhain::types::{GroupState, Som, Unit};
use stillpoint_monitors::heidenhain::{
    acceptance, agreement, brakes, cut_out, holding_brake, reference, sampling, self_checks,
    self_test, start_checks, status_bits, tool_holder,
};
use stillpoint_monitors::kernel::Cycles;

use crate::source::Source;

/// The longest delay there is.
const LONGEST: Cycles = Cycles::new(u32::MAX);

/// Any step of the referencing.
pub fn reference<S: Source>(
    source: &mut S,
) -> Option<(reference::State, reference::Config, reference::Inputs)> {
    let config = reference::Config::new(source.any_bool()).ok()?;
    let state = reference::State {
        axis: source.any_of(&AxisRef::ALL),
        saved: source.any_bool(),
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = reference::Inputs {
        power_on: source.any_bool(),
        check_cause: source.any_bool(),
        homed: source.any_bool(),
        own_matches: source.any_bool(),
        peer_matches: source.any_bool(),
        own_at_mark: source.any_bool(),
        peer_at_mark: source.any_bool(),
        confirm: source.any_bool(),
        som: source.any_of(&Som::ALL),
        unit: source.any_of(&Unit::ALL),
        door_open: source.any_bool(),
        moving: source.any_bool(),
        peer_checked: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the comparison between the channels.
pub fn agreement<S: Source>(
    source: &mut S,
) -> Option<(agreement::State, agreement::Config, agreement::Inputs)> {
    let window = source.any_delay(LONGEST);
    let config = agreement::Config::new(window).ok()?;
    let config = if source.any_bool() {
        config.fatal()
    } else {
        config
    };
    let state = agreement::State {
        cycles: source.any_cycles(window),
    };
    let inputs = agreement::Inputs {
        differ: source.any_bool(),
    };
    Some((state, config, inputs))
}

fn braked_axis<S: Source>(source: &mut S) -> brakes::Axis {
    brakes::Axis {
        release: source.any_bool(),
        drive: source.any_bool(),
    }
}

/// Any step of the brake outputs.
pub fn brakes<S: Source>(
    source: &mut S,
) -> Option<(brakes::State, brakes::Config, brakes::Inputs)> {
    let inputs = brakes::Inputs {
        test: source.any_bool(),
        own: braked_axis(source),
        shared: [braked_axis(source), braked_axis(source)],
    };
    Some((brakes::State::INITIAL, brakes::Config, inputs))
}

/// Any step of the tool holder.
pub fn tool_holder<S: Source>(
    source: &mut S,
) -> Option<(tool_holder::State, tool_holder::Config, tool_holder::Inputs)> {
    let state = tool_holder::State {
        open: source.any_bool(),
        asked: source.any_bool(),
    };
    let inputs = tool_holder::Inputs {
        request: source.any_bool(),
        door_open: source.any_bool(),
        moving: source.any_bool(),
        state: source.any_of(&GroupState::ALL),
    };
    Some((state, tool_holder::Config, inputs))
}

/// Any number of parameters; the enumeration takes small ones and the highest.
fn changes<S: Source>(source: &mut S, reach: u32) -> u16 {
    source.any_u32(reach, u32::from(u16::MAX)) as u16
}

/// Any step of the acceptance.
pub fn acceptance<S: Source>(
    source: &mut S,
) -> Option<(acceptance::State, acceptance::Config, acceptance::Inputs)> {
    let config = acceptance::Config::new(changes(source, 3)).ok()?;
    let phase = source.any_of(&acceptance::Phase::ALL);
    let listed = matches!(
        phase,
        acceptance::Phase::Changed | acceptance::Phase::Confirming
    );
    let state = acceptance::State {
        phase,
        open: if listed { changes(source, 3) } else { 0 },
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = acceptance::Inputs {
        boot: source.any_bool(),
        matches: source.any_bool(),
        changes: changes(source, 3),
        password: source.any_bool(),
        cancel: source.any_bool(),
        permissive: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the self-test.
pub fn self_test<S: Source>(
    source: &mut S,
) -> Option<(self_test::State, self_test::Config, self_test::Inputs)> {
    let interval = source.any_delay(LONGEST);
    let config = self_test::Config::new(
        interval,
        source.any_bool(),
        source.any_bool(),
        source.any_bool(),
    )
    .ok()?;
    let phase = source.any_of(&self_test::Phase::ALL);
    let repeated = source.any_bool();
    // Elsewhere no test is good.
    let good = phase == self_test::Phase::Passed || (repeated && phase != self_test::Phase::Failed);
    let state = self_test::State {
        phase,
        repeated,
        rest: if good {
            source.any_cycles(interval)
        } else {
            Cycles::ZERO
        },
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = self_test::Inputs {
        power_on: source.any_bool(),
        start: source.any_bool(),
        configured: source.any_bool(),
        done: source.any_bool(),
        fault: source.any_bool(),
        es_closed: source.any_bool(),
        cvo: source.any_bool(),
        keys_free: source.any_bool(),
        doors_shut: source.any_bool(),
        omitted: source.any_bool(),
        brake_good: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the status bits.
pub fn status_bits<S: Source>(
    source: &mut S,
) -> Option<(status_bits::State, status_bits::Config, status_bits::Inputs)> {
    let inputs = status_bits::Inputs {
        es_a: source.any_bool(),
        es_b: source.any_bool(),
        es_a_hw: source.any_bool(),
        es_b_hw: source.any_bool(),
        mc_wd: source.any_bool(),
        stos_mc: source.any_bool(),
        cc_wd: source.any_bool(),
        smc_wd: source.any_bool(),
        spl_wd: source.any_bool(),
        smop_wd: source.any_bool(),
        pf_ac: source.any_bool(),
        pf_dc: source.any_bool(),
        pf_board: source.any_bool(),
        n0: source.any_bool(),
        req_ss2: source.any_bool(),
        masked: source.any_bool(),
        spl_fault: source.any_bool(),
        smop_fault: source.any_bool(),
    };
    Some((status_bits::State::INITIAL, status_bits::Config, inputs))
}

/// Any step of the forced dynamic sampling.
pub fn sampling<S: Source>(
    source: &mut S,
) -> Option<(sampling::State, sampling::Config, sampling::Inputs)> {
    let t_low = source.any_delay(LONGEST);
    let config = sampling::Config::new(t_low, source.any_bool()).ok()?;
    let pulse = source.any_of(&Pulse::ALL);
    let state = sampling::State {
        pulse,
        timer: if matches!(pulse, Pulse::ALow | Pulse::BLow) {
            source.any_cycles(t_low)
        } else {
            Cycles::ZERO
        },
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = sampling::Inputs {
        due: source.any_bool(),
        contact_a: source.any_bool(),
        contact_b: source.any_bool(),
        stuck_a: source.any_bool(),
        stuck_b: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the kernel's own checks.
pub fn self_checks<S: Source>(
    source: &mut S,
) -> Option<(self_checks::State, self_checks::Config, self_checks::Inputs)> {
    let config = self_checks::Config::new(source.any_bool(), source.any_bool()).ok()?;
    let inputs = self_checks::Inputs {
        amplitude: source.any_bool(),
        frequency: source.any_bool(),
        temperature: source.any_bool(),
        fan: source.any_bool(),
        supply: source.any_bool(),
        watchdog: source.any_bool(),
        software: source.any_bool(),
        fatal: source.any_bool(),
        checksum: source.any_bool(),
        runtime: source.any_bool(),
        internal_es: source.any_bool(),
        readback: source.any_bool(),
    };
    Some((self_checks::State::INITIAL, config, inputs))
}

/// Any step of the checks while booting. The enumeration takes motor speeds around both ends of their range.
pub fn start_checks<S: Source>(
    source: &mut S,
) -> Option<(
    start_checks::State,
    start_checks::Config,
    start_checks::Inputs,
)> {
    let config = start_checks::Config::new(source.any_bool()).ok()?;
    let state = start_checks::State {
        start: source.any_of(&Start::ALL),
    };
    let inputs = start_checks::Inputs {
        power_on: source.any_bool(),
        booted: source.any_bool(),
        mixed: source.any_bool(),
        motor_speed: if source.any_bool() {
            source.any_i32(1)
        } else {
            source.any_in(99, 101) as i32
        },
        rated_speed: source.any_i32(1),
        feed_constant: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the test of the cut-out channels.
pub fn cut_out<S: Source>(
    source: &mut S,
) -> Option<(cut_out::State, cut_out::Config, cut_out::Inputs)> {
    let longest = cut_out::Config::LONGEST;
    let config = cut_out::Config::new(
        source.any_delay(longest),
        source.any_delay(longest),
        source.any_delay(longest),
        source.any_bool(),
        source.any_bool(),
    )
    .ok()?;
    let step = source.any_of(&cut_out::Phase::ALL);
    let state = cut_out::State {
        step,
        timer: source.any_cycles(config.time(step)),
        ask: step == cut_out::Phase::Idle && source.any_bool(),
    };
    let inputs = cut_out::Inputs {
        power_on: source.any_bool(),
        start: source.any_bool(),
        t_brk: source.any_bool(),
        chain: source.any_bool(),
        ready: source.any_bool(),
        outputs: source.any_bool(),
        moved: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any step of the test of a holding brake.
pub fn holding_brake<S: Source>(
    source: &mut S,
) -> Option<(
    holding_brake::State,
    holding_brake::Config,
    holding_brake::Inputs,
)> {
    let factor = source.any_u32(1, u32::from(holding_brake::Config::HIGHEST)) as u16;
    let config = holding_brake::Config::new(factor).ok()?;
    let state = holding_brake::State {
        step: source.any_of(&holding_brake::Phase::ALL),
    };
    let inputs = holding_brake::Inputs {
        start: source.any_bool(),
        done: source.any_bool(),
        too_far: source.any_bool(),
        current: source.any_bool(),
        safe_now: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}
