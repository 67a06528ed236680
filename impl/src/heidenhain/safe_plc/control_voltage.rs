//! What one safe PLC tells the kernel about the control voltage: `PP_GenCVO` and the permission of each group to switch its
//! drives on.
//!
//! `PP_GenCVO` is 1 while the key is pressed or the latch circuit (K1) is set; the permission copies the key alone, for a latch
//! that stays gives no edge. On a machine that cannot be seen as a whole a reset button outside the danger zone comes first. A
//! magazine may have a key of its own.

use crate::kernel::ConfigError;

config! {
    /// What the machine has.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        reset: bool,
        t_key: bool,
    }
}

impl Config {
    /// `reset`: there is a reset button. `t_key`: the magazine has its own key to switch its drives on.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(reset: bool, t_key: bool) -> Result<Self, ConfigError> {
        Ok(Self { reset, t_key })
    }
}

fields! {
    /// The state between two cycles of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The reset button was pressed since the control voltage went.
        pub armed: bool,
    }
}

impl State {
    /// Nobody has looked whether the danger zone is empty.
    pub const INITIAL: Self = Self { armed: false };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The kernel has switched the control voltage off.
        pub dropped: bool,
        /// The reset button, both contacts.
        pub reset: bool,
        /// The key "control voltage on", both contacts.
        pub key: bool,
        /// The latch circuit is set (K1).
        pub latched: bool,
        /// The key of the magazine, both contacts.
        pub t_key: bool,
    }
}

fields! {
    /// The outputs of one cycle: fields of the interface to the kernel.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `PP_GenCVO`.
        pub voltage: bool,
        /// `PP_AxGrpPermitDrvOn` of axes and spindle.
        pub drives: bool,
        /// `PP_AxGrpPermitDrvOn` of the magazine.
        pub t_drives: bool,
    }
}

monitor! { heidenhain::control_voltage;
    /// Where there is a reset button nothing is switched on before it was pressed, after the last time the voltage went.
    reset_comes_first ["HFS-ACK-002"]:
        when |s| s.config.reset && !s.before.armed && !s.inputs.reset
            => !s.outputs.voltage && !s.outputs.drives && !s.outputs.t_drives;

    /// The reset is good for one switching on.
    dropped_voltage_needs_a_new_reset ["HFS-ACK-002"]:
        when |s| s.inputs.dropped
            => !s.after.armed && !(s.config.reset && (s.outputs.voltage || s.outputs.drives || s.outputs.t_drives));

    /// The voltage is asked for by the key or the latch circuit, and by nothing else.
    key_or_latch_asks ["HFS-API-028"]:
        when |s| !s.config.reset
            => s.outputs.voltage == (s.inputs.key || s.inputs.latched);

    /// The permission is a copy of the key: a latch that stays restarts nothing.
    permission_copies_the_key ["HFS-API-029"]:
        when |s| !s.config.reset
            => s.outputs.drives == s.inputs.key;

    /// A magazine with its own key follows that, every other one the common key.
    magazine_follows_its_key ["HFS-API-029"]:
        when |s| !s.config.reset
            => s.outputs.t_drives == if s.config.t_key { s.inputs.t_key } else { s.inputs.key };

    /// After the reset the key counts as on a machine without one.
    reset_sets_free ["HFS-ACK-002", "HFS-API-028"]:
        when |s| (s.before.armed || s.inputs.reset) && !s.inputs.dropped
            => s.after.armed && s.outputs.voltage == (s.inputs.key || s.inputs.latched) && s.outputs.drives == s.inputs.key;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let armed = !inputs.dropped && (state.armed || inputs.reset);
    let free = armed || !config.reset;
    let t_key = if config.t_key {
        inputs.t_key
    } else {
        inputs.key
    };
    let outputs = Outputs {
        voltage: free && (inputs.key || inputs.latched),
        drives: free && inputs.key,
        t_drives: free && t_key,
    };
    (State { armed }, outputs)
}
