//! Brake outputs of one safe PLC: what it makes of the release requests of its kernel (safe brake control, SBC).
//!
//! An output of one axis follows the request. An output shared by several axes opens when all of them ask for it; in the test
//! of the brake control, when one does. The safe PLC never opens a brake on its own, and outside the test none whose drive
//! is off: that the kernel does not ask for it (HFS-SBC-007) is checked here too, since closing is always permitted.

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// One braked axis as the kernel reports it.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Axis {
        /// `NN_AxBrkReleaseReq`: the brake is to be released.
        pub release: bool,
        /// The drive of the axis is switched on.
        pub drive: bool,
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// `NN_BrkActivationTest`: the test of the brake control runs.
        pub test: bool,
        /// The axis whose brake has an output of its own.
        pub own: Axis,
        /// The axes whose brakes share an output.
        pub shared: [Axis; 2],
    }
}

impl Axis {
    /// Whether the request counts: the drive holds its axis, or the test wants it.
    const fn released(self, test: bool) -> bool {
        self.release && (self.drive || test)
    }
}

fields! {
    /// The outputs of one cycle: `true` releases.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The output of the single axis.
        pub own: bool,
        /// The output shared by the others; so is -BRK.A.G formed of the releases of its axes (HFS-SBC-009).
        pub collected: bool,
    }
}

monitor! { heidenhain::brakes;
    /// The brake of a single axis is released exactly while it is asked for.
    own_output_follows_the_request ["HFS-SBC-001", "HFS-SBC-004", "HFS-API-035"]:
        when |s| s.inputs.own.drive || s.inputs.test
            => s.outputs.own == s.inputs.own.release;

    /// In operation a shared output releases only when all its axes ask for it.
    all_must_ask ["HFS-ARCH-004/i", "HFS-P-28", "HFS-SBC-005", "HFS-SBC-009"]:
        when |s| !s.inputs.test && s.inputs.shared[0].drive && s.inputs.shared[1].drive
            => s.outputs.collected == (s.inputs.shared[0].release && s.inputs.shared[1].release);

    /// In the test of the brake control one is enough.
    one_is_enough_in_the_test ["HFS-P-28", "HFS-SBC-006", "HFS-SBC-010", "HFS-BCT-007"]:
        when |s| s.inputs.test
            => s.outputs.collected == (s.inputs.shared[0].release || s.inputs.shared[1].release);

    /// Without any request no brake is released: a fault in the test closes them all.
    no_release_without_request ["HFS-SBC-008", "HFS-ARCH-007"]:
        when |s| !s.inputs.own.release && !s.inputs.shared[0].release && !s.inputs.shared[1].release
            => s.outputs == Outputs::default();

    /// Outside the test no brake of a drive without torque is released.
    released_axis_has_torque ["HFS-P-27", "HFS-SBC-007"]:
        when |s| !s.inputs.test
            => (!s.outputs.own || s.inputs.own.drive)
                && (!s.outputs.collected || (s.inputs.shared[0].drive && s.inputs.shared[1].drive));
}

pub(crate) fn transition(_: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let test = inputs.test;
    let [first, second] = inputs.shared;
    let (first, second) = (first.released(test), second.released(test));
    let outputs = Outputs {
        own: inputs.own.released(test),
        collected: if test {
            first || second
        } else {
            first && second
        },
    };
    (State, outputs)
}
