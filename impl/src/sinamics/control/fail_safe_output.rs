//! F-DO of TM54F or CU310-2: the AND of up to six signals, and its two switches in the test stop.

pub use crate::contract::Stateless as State;

config! {
    /// How the output is wired.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        pub(crate) connected: [bool; 6],
        pub(crate) tested: bool,
    } accepted |_config| true
}

impl Config {
    /// `connected`: which of the six inputs p10042\[0..5\] (p10043 to p10045 for F-DO 1 to 3) have a source. `tested`: the output is
    /// registered in p10046.
    pub const fn new(connected: [bool; 6], tested: bool) -> Self {
        Self { connected, tested }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The sources, any of the signals of a drive or of a drive group, which the status word has, and Safe State (S120-FDO-501); of
        /// those that are not connected nothing counts.
        pub sources: [bool; 6],
        /// The test stop runs.
        pub testing: bool,
        /// The switch to plus in the test stop.
        pub test_plus: bool,
        /// The switch to minus in the test stop.
        pub test_minus: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The switch to plus, DO+.
        pub plus: bool,
        /// The switch to minus, DO-.
        pub minus: bool,
    }
}

monitor! { sinamics::fail_safe_output;
    /// Outside the test the output is on only where something is connected and every connected source is 1.
    every_source_allows ["S120-FDO-500", "S120-PC-14"]:
        when |s| !s.inputs.testing && (s.outputs.plus || s.outputs.minus)
            => s.config.connected != [false; 6]
                && s.config.connected.iter().zip(s.inputs.sources).all(|(connected, source)| !connected || source);

    /// Where they all are, it is.
    output_is_the_and ["S120-FDO-500"]:
        when |s| !s.inputs.testing && s.inputs.sources == [true; 6] && s.config.connected != [false; 6]
            => s.outputs.plus && s.outputs.minus;

    /// What is not connected does not count.
    unconnected_source_does_not_count ["S120-FDO-500"]:
        when |s| !s.inputs.testing && s.inputs.sources == s.config.connected && s.config.connected != [false; 6]
            => s.outputs.plus && s.outputs.minus;

    /// An output that is not registered is off during the test; a registered one follows it.
    test_switches_registered_outputs ["S120-FDO-505", "S120-TESTSTOP-508", "S120-PC-16"]:
        when |s| s.inputs.testing
            => s.outputs.plus == (s.config.tested && s.inputs.test_plus)
                && s.outputs.minus == (s.config.tested && s.inputs.test_minus);

    /// Outside the test both switches do the same.
    switches_agree ["S120-FDO-505"]:
        when |s| !s.inputs.testing
            => s.outputs.plus == s.outputs.minus;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let pairs = config.connected.iter().zip(inputs.sources);
    let blocked = pairs
        .into_iter()
        .any(|(connected, source)| *connected && !source);
    let on = config.connected.contains(&true) && !blocked;
    let outputs = if inputs.testing {
        Outputs {
            plus: config.tested && inputs.test_plus,
            minus: config.tested && inputs.test_minus,
        }
    } else {
        Outputs {
            plus: on,
            minus: on,
        }
    };
    (state, outputs)
}
