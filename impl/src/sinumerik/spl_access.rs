//! Who may do what with the variables and synchronised actions of the NCK-SPL (machine `spl_access`).
//!
//! Reading B-06: WP_17070.

pub use crate::contract::Stateless as State;
use crate::kernel::ConfigError;

config! {
    /// The protected actions: MD 11500.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        first: u32,
        last: u32,
    }
}

impl Config {
    /// `first`, `last`: MD 11500[0] and [1], the numbers of the first and the last protected action.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when the last one is before the first.
    pub const fn new(first: u32, last: u32) -> Result<Self, ConfigError> {
        if last < first {
            return Err(ConfigError::LimitsCrossed);
        }
        Ok(Self { first, last })
    }

    const fn contains(&self, action: u32) -> bool {
        self.first <= action && action <= self.last
    }
}

fields! {
    /// What is accessed.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Object {
        /// What the SPL forms: `$A_OUTSI`, `$A_OUTSE`, `$A_MARKERSI`, `$A_TIMERSI`, `$A_CMDSI`.
        #[default]
        Formed,
        /// Single-channel signals: `$A_PLCSIIN`, `$A_PLCSIOUT`.
        Exchanged,
        /// Images of the PLC: `$A_INSEP` and the like.
        Image,
        /// What can only be read: `$A_INSE`, `$A_INSI`, `$A_STATSID`, `$A_LEVELSID`.
        Given,
        /// A synchronised action, which CANCEL and LOCK would change.
        Action,
    }
}

fields! {
    /// One access.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What is accessed.
        pub data: Object,
        /// It is to be changed; else it is read.
        pub write: bool,
        /// By SAFE.SPF itself.
        pub by_spl: bool,
        /// Commissioning of the NCK-SPL is completed.
        pub protected: bool,
        /// SAFE.SPF has been started.
        pub started: bool,
        /// The number of the action.
        pub action: u32,
    }
}

fields! {
    /// The alarm of a refused access.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Alarm {
        /// None.
        #[default]
        None,
        /// Write-protected.
        A17070,
        /// No access to the variable.
        A17210,
        /// Only from the NCK-SPL; not used under the reading of this module.
        A27094,
    }
}

fields! {
    /// What becomes of the access.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// It is made; else the value or the action stays as it is.
        pub allowed: bool,
        /// The alarm.
        pub alarm: Alarm,
    }
}

monitor! { sinumerik::spl_access;
    /// What the SPL forms is changed by SAFE.SPF alone.
    only_the_program_writes ["S840D-SPLPROT-004", "S840D-ALARM-724/a"]:
        when |s| s.inputs.data == Object::Formed && s.inputs.write
            => s.outputs.allowed == s.inputs.by_spl && (s.outputs.alarm == Alarm::A17070) != s.inputs.by_spl;

    /// Everybody may read it.
    everybody_reads ["S840D-SPLPROT-004"]:
        when |s| (s.inputs.data == Object::Formed || s.inputs.data == Object::Given) && !s.inputs.write
            => s.outputs.allowed && s.outputs.alarm == Alarm::None;

    /// The single-channel signals belong to SAFE.SPF, for reading too.
    exchange_belongs_to_the_program ["S840D-SPLPROT-004"]:
        when |s| s.inputs.data == Object::Exchanged
            => s.outputs.allowed == s.inputs.by_spl && (s.outputs.alarm == Alarm::A17070) != s.inputs.by_spl;

    /// The images are read in the commissioning state only, by whichever program.
    images_while_commissioning ["S840D-SPLPROT-005"]:
        when |s| s.inputs.data == Object::Image && !s.inputs.write
            => s.outputs.allowed != s.inputs.protected && (s.outputs.alarm == Alarm::A17210) == s.inputs.protected;

    /// Images, and what is given, are never written.
    images_are_not_written ["S840D-SPLPROT-005"]:
        when |s| (s.inputs.data == Object::Image || s.inputs.data == Object::Given) && s.inputs.write
            => !s.outputs.allowed && s.outputs.alarm != Alarm::None;

    /// CANCEL and LOCK do nothing to a protected action once SAFE.SPF has been started, and to others what they do.
    protected_actions_stay ["S840D-SPLPROT-003"]:
        when |s| s.inputs.data == Object::Action && s.inputs.write
            => s.outputs.alarm == Alarm::None && s.outputs.allowed != (s.inputs.protected && s.inputs.started
                && s.config.first <= s.inputs.action && s.inputs.action <= s.config.last);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let answer = |allowed: bool, refusal: Alarm| Outputs {
        allowed,
        alarm: if allowed { Alarm::None } else { refusal },
    };
    let outputs = match (inputs.data, inputs.write) {
        (Object::Formed, true) | (Object::Exchanged, _) => answer(inputs.by_spl, Alarm::A17070),
        (Object::Formed | Object::Given, false) => answer(true, Alarm::None),
        (Object::Image, false) => answer(!inputs.protected, Alarm::A17210),
        (Object::Image | Object::Given, true) => answer(false, Alarm::A17070),
        (Object::Action, write) => answer(
            !(write && inputs.protected && inputs.started && config.contains(inputs.action)),
            Alarm::None,
        ),
    };
    (state, outputs)
}
