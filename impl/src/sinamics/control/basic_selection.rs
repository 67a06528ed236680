//! Selection of the Basic Functions over terminals and PROFIsafe in parallel, in one channel.
//!
//! Each enabled path selects by itself. The terminals select STO, or SS1 where p9652 is set; PROFIsafe selects both. STO comes
//! before SS1.

pub use crate::contract::Stateless as State;

config! {
    /// The enabled paths, from p9601.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        pub(crate) terminals: bool,
        pub(crate) profisafe: bool,
        pub(crate) delayed: bool,
    } accepted |_config| true
}

impl Config {
    /// `terminals`: p9601.0, else the terminals have no effect (S120-CTRL-506). `profisafe`: p9601.3. `delayed`: p9652 is not 0.
    pub const fn new(terminals: bool, profisafe: bool, delayed: bool) -> Self {
        Self {
            terminals,
            profisafe,
            delayed,
        }
    }
}

fields! {
    /// The inputs of one cycle; 1 deselects.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The terminal of this channel: the digital input of the Control Unit, or EP of the Motor Module.
        pub terminal: bool,
        /// Bit STO of the control word; 0 as a substitute value.
        pub sto: bool,
        /// Bit SS1 of the control word.
        pub ss1: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// STO is selected.
        pub sto: bool,
        /// SS1 is selected, and STO is not.
        pub ss1: bool,
        /// STO over the terminals, r9772.17.
        pub sto_terminals: bool,
        /// STO over PROFIsafe, r9772.20.
        pub sto_profisafe: bool,
        /// SS1 over the terminals, r9772.22.
        pub ss1_terminals: bool,
        /// SS1 over PROFIsafe, r9772.23.
        pub ss1_profisafe: bool,
    }
}

monitor! { sinamics::basic_selection;
    /// A terminal at 0, an open wire, selects; with p9652 SS1, without it STO.
    terminal_selects ["S120-CTRL-504", "S120-CTRL-505", "S120-CTRL-517", "S120-DIAG-503"]:
        when |s| s.config.terminals && !s.inputs.terminal
            => s.outputs.sto_terminals != s.config.delayed && s.outputs.ss1_terminals == s.config.delayed
                && (s.outputs.sto || s.outputs.ss1);

    /// Terminals that are not enabled, or deselect, select nothing.
    terminal_may_select_nothing ["S120-CTRL-506", "S120-CTRL-504"]:
        when |s| !s.config.terminals || s.inputs.terminal
            => !s.outputs.sto_terminals && !s.outputs.ss1_terminals;

    /// The bits of PROFIsafe select STO and SS1, whatever the terminals do.
    profisafe_selects ["S120-CTRL-517", "S120-PSAFE-508", "S120-PSAFE-509", "S120-DIAG-503"]:
        when |s| s.config.profisafe
            => s.outputs.sto_profisafe != s.inputs.sto && s.outputs.ss1_profisafe != s.inputs.ss1
                && (s.inputs.sto || s.outputs.sto);

    /// STO comes before SS1.
    sto_comes_first ["S120-CTRL-517", "S120-PSAFE-526", "S120-PC-21"]:
        when |s| s.outputs.sto
            => !s.outputs.ss1 && (s.outputs.sto_terminals || s.outputs.sto_profisafe);

    /// SS1 is selected where a path selects it and none STO.
    ss1_without_sto ["S120-CTRL-517"]:
        when |s| !s.outputs.sto
            => s.outputs.ss1 == (s.outputs.ss1_terminals || s.outputs.ss1_profisafe);

    /// Without an enabled path nothing is selected.
    no_path_no_selection ["S120-CTRL-506"]:
        when |s| !s.config.terminals && !s.config.profisafe
            => s.outputs == Outputs::default();
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let terminal = config.terminals && !inputs.terminal;
    let sto_terminals = terminal && !config.delayed;
    let ss1_terminals = terminal && config.delayed;
    let sto_profisafe = config.profisafe && !inputs.sto;
    let ss1_profisafe = config.profisafe && !inputs.ss1;
    let sto = sto_terminals || sto_profisafe;
    let outputs = Outputs {
        sto,
        ss1: !sto && (ss1_terminals || ss1_profisafe),
        sto_terminals,
        sto_profisafe,
        ss1_terminals,
        ss1_profisafe,
    };
    (state, outputs)
}
