//! Replaced components: at each start the component that is there is compared with the stored one.
//!
//! A component that is another one is told, F01641, and by F01640 where the drive needs p9702 = 29 for it: a Motor Module under a
//! TM54F, CPU 2 of a Sensor Module. The drive may run all the same. The message goes with an acknowledgement and is there again
//! at the next start, until the component has been saved.

config! {
    /// The kind of the component.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        pub(crate) needs: bool,
    } accepted |_config| true
}

impl Config {
    /// `needs`: the replacement has to be confirmed by p9702 (S120-MAINT-510).
    pub const fn new(needs: bool) -> Self {
        Self { needs }
    }

    /// The message of this component.
    const fn message(&self) -> Message {
        if self.needs {
            Message::Confirm
        } else {
            Message::Replaced
        }
    }
}

fields! {
    /// The message about the component.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Message {
        /// None.
        #[default]
        None,
        /// F01641: replaced.
        Replaced,
        /// F01640: replaced, p9702 is required.
        Confirm,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The component is not the stored one.
        pub foreign: bool,
        /// The replacement was confirmed.
        pub confirmed: bool,
        /// The message.
        pub message: Message,
    }
}

impl State {
    /// The stored component.
    pub const INITIAL: Self = Self {
        foreign: false,
        confirmed: false,
        message: Message::None,
    };

    /// Every state is possible: a message outlives the saving.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON: the components are compared.
        pub power_on: bool,
        /// The component was replaced while the drive was off; of effect at POWER ON.
        pub exchanged: bool,
        /// The acknowledgement of faults.
        pub acknowledge: bool,
        /// p9702 = 29 is written.
        pub confirm: bool,
        /// p0977 = 1 is written.
        pub save: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The message.
        pub message: Message,
        /// r9776.2: a component was replaced, and is not saved.
        pub replaced: bool,
        /// r9776.3: it needs p9702.
        pub confirmation: bool,
    }
}

monitor! { sinamics::replacement;
    /// A component that is not the stored one is told at each start, by the message of its kind.
    each_start_tells ["S120-MAINT-500", "S120-MAINT-501", "S120-MAINT-505", "S120-MAINT-507"]:
        when |s| s.inputs.power_on && (s.before.foreign || s.inputs.exchanged)
            => s.outputs.replaced && s.outputs.message == s.config.message() && s.after.foreign;

    /// The stored one is not.
    stored_component_is_silent ["S120-MAINT-500"]:
        when |s| s.inputs.power_on && !s.before.foreign && !s.inputs.exchanged
            => !s.outputs.replaced && s.outputs.message == Message::None;

    /// Only a start finds a component to be another one.
    only_a_start_compares ["S120-MAINT-500"]:
        when |s| !s.inputs.power_on && s.after.foreign
            => s.before.foreign;

    /// It is stored by saving, and where p9702 is needed only after it.
    saving_stores ["S120-MAINT-501", "S120-MAINT-505", "S120-MAINT-507", "S120-MAINT-510"]:
        when |s| s.before.foreign && !s.inputs.power_on
            => s.after.foreign != (s.inputs.save && (!s.config.needs || s.before.confirmed || s.inputs.confirm));

    /// Another component has to be confirmed anew.
    confirmation_belongs_to_a_component ["S120-MAINT-505", "S120-MAINT-507", "S120-MAINT-510"]:
        when |s| s.inputs.power_on && s.inputs.exchanged
            => s.after.confirmed != s.config.needs;

    /// Only p9702 confirms what needs it.
    confirmation_is_written ["S120-MAINT-505", "S120-MAINT-507", "S120-MAINT-510"]:
        when |s| s.config.needs && s.after.confirmed && !s.before.confirmed
            => s.inputs.confirm && !s.inputs.power_on;

    /// An acknowledgement takes the message away, nothing else does before the next start.
    acknowledgement_takes_the_message ["S120-MAINT-501"]:
        when |s| !s.inputs.power_on
            => s.outputs.message == if s.inputs.acknowledge { Message::None } else { s.before.message };

    /// What has to be confirmed is shown.
    need_is_shown ["S120-MAINT-500", "S120-MAINT-505", "S120-MAINT-507"]:
        when |s| s.outputs.replaced || s.outputs.confirmation
            => s.outputs.confirmation == s.config.needs && s.outputs.replaced && s.outputs.message == s.after.message;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = state;
    if inputs.power_on {
        after.foreign |= inputs.exchanged;
        after.confirmed = !config.needs || (state.confirmed && !inputs.exchanged);
        after.message = if after.foreign {
            config.message()
        } else {
            Message::None
        };
    } else {
        after.confirmed |= inputs.confirm;
        if inputs.save && (after.confirmed || !config.needs) {
            after.foreign = false;
        }
        if inputs.acknowledge {
            after.message = Message::None;
        }
    }
    let outputs = Outputs {
        message: after.message,
        replaced: after.foreign,
        confirmation: after.foreign && config.needs,
    };
    (after, outputs)
}
