//! From STO back to torque: no drive starts by itself.
//!
//! When nothing asks for STO any more and no stop is latched, the drive is inhibited from switching on. The falling edge of
//! ON/OFF1 ends that, and the next rising one, with the enables, gives torque.
//!
//! Readings: AC-26 PEND_BLOCKS_RUN.

config! {
    /// Nothing is set.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// How far the drive is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Phase {
        /// STO is active, or a stop is latched; also after POWER ON.
        #[default]
        Active,
        /// Inhibited from switching on.
        Inhibit,
        /// ON/OFF1 has fallen.
        Ready,
        /// Torque.
        Run,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the drive is.
        pub phase: Phase,
        /// ON/OFF1 in the last cycle.
        pub last: bool,
    }
}

impl State {
    /// No torque.
    pub const INITIAL: Self = Self {
        phase: Phase::Active,
        last: false,
    };

    /// A drive that is ready has seen OFF, one that runs ON.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// Something asks for STO: a selection, an ended SS1, a stop, parking, a test, commissioning.
        pub sto: bool,
        /// A stop or STOP F is latched.
        pub latched: bool,
        /// ON/OFF1.
        pub on: bool,
        /// The other enables of the drive.
        pub enabled: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Pulses are allowed.
        pub torque: bool,
        /// STO is active.
        pub sto_active: bool,
    }
}

monitor! { sinamics::restart;
    /// STO takes the torque in the same cycle, whatever the drive does.
    sto_takes_the_torque ["S120-STO-001", "S120-PC-02"]:
        when |s| s.inputs.sto
            => !s.outputs.torque && s.outputs.sto_active && s.after.phase == Phase::Active;

    /// Torque comes back by the rising edge of ON/OFF1 of a ready drive, with its enables and without a latched stop.
    torque_needs_the_rising_edge ["S120-STO-005", "S120-STOP-525", "S120-PC-20"]:
        when |s| s.outputs.torque && s.before.phase != Phase::Run
            => s.before.phase == Phase::Ready && s.inputs.on && !s.before.last && s.inputs.enabled && !s.inputs.power_on
                && !s.inputs.latched;

    /// A drive becomes ready by the falling edge of ON/OFF1 while it is inhibited.
    ready_needs_the_falling_edge ["S120-STO-005", "S120-PC-20"]:
        when |s| s.after.phase == Phase::Ready && s.before.phase != Phase::Ready
            => (s.before.phase == Phase::Inhibit || s.before.phase == Phase::Run) && !s.inputs.power_on && !s.inputs.on
                && (s.before.phase == Phase::Run || s.before.last);

    /// Both edges start it.
    edges_start_it ["S120-STO-005", "S120-PC-31"]:
        when |s| s.before.phase == Phase::Ready && s.inputs.on && !s.before.last && s.inputs.enabled && !s.inputs.sto
            && !s.inputs.power_on && !s.inputs.latched
            => s.outputs.torque;

    /// While a stop is latched STO is not left.
    latched_stop_keeps_sto ["S120-STOP-525", "S120-PC-20"]:
        when |s| (s.before.phase == Phase::Active || s.inputs.power_on) && s.inputs.latched
            => s.after.phase == Phase::Active && !s.outputs.torque;

    /// The end of STO leads to the inhibition, and no further.
    end_of_sto_inhibits ["S120-STO-005", "S120-CTRL-510", "S120-CTRL-515", "S120-STD-500"]:
        when |s| s.before.phase == Phase::Active && !s.inputs.sto && !s.inputs.latched && !s.inputs.power_on
            => s.after.phase == Phase::Inhibit && !s.outputs.sto_active && !s.outputs.torque;

    /// POWER ON starts nothing.
    power_on_starts_nothing ["S120-PC-20", "S120-ACK-515"]:
        when |s| s.inputs.power_on
            => s.after.phase == Phase::Active && !s.outputs.torque;

    /// The outputs are those of the phase.
    outputs_belong_to_the_phase ["S120-STO-001"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.torque == (s.after.phase == Phase::Run) && s.outputs.sto_active == (s.after.phase == Phase::Active)
                && s.after.last == s.inputs.on;
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let rose = inputs.on && !state.last;
    let fell = !inputs.on && state.last;
    let phase = match state.phase {
        _ if inputs.power_on || inputs.sto => Phase::Active,
        Phase::Active if inputs.latched => Phase::Active,
        Phase::Active => Phase::Inhibit,
        Phase::Inhibit if fell => Phase::Ready,
        Phase::Ready if rose && inputs.enabled && !inputs.latched => Phase::Run,
        Phase::Run if !inputs.on => Phase::Ready,
        phase => phase,
    };
    let after = State {
        phase,
        last: inputs.on,
    };
    let outputs = Outputs {
        torque: phase == Phase::Run,
        sto_active: phase == Phase::Active,
    };
    (after, outputs)
}
