//! Result lists of one channel: what the cross comparison of the monitoring results compares (codes 1 and 2).
//!
//! Two bits for each function: 00 not selected, 01 selected and not violated, 10 beyond the lower limit, 11 beyond the
//! upper limit. Only the selected one of several stages or pairs has a field other than 00.

pub use crate::contract::Stateless as State;
use crate::kernel::ConfigError;
use crate::sinumerik::selection::{Monitored, Stage};

fields! {
    /// A field of a result list.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Field {
        /// The function is not selected.
        #[default]
        NotSelected,
        /// The function is selected; no limit is passed.
        Within,
        /// The lower limit is passed.
        Below,
        /// The upper limit is passed.
        Above,
    }
}

impl Field {
    /// The two bits.
    pub const fn bits(self) -> u8 {
        match self {
            Self::NotSelected => 0b00,
            Self::Within => 0b01,
            Self::Below => 0b10,
            Self::Above => 0b11,
        }
    }

    const fn new(selected: bool, above: bool, below: bool) -> Self {
        match (selected, above, below) {
            (false, _, _) => Self::NotSelected,
            (true, true, _) => Self::Above,
            (true, false, true) => Self::Below,
            (true, false, false) => Self::Within,
        }
    }
}

fields! {
    /// Result list 1 (MD 1391 / 1392).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct List1 {
        /// Operating stop.
        pub sbh: Field,
        /// The two pairs of limit switches.
        pub se: [Field; 2],
        /// The four speed stages.
        pub sg: [Field; 4],
    }
}

impl List1 {
    /// The list as the bits 13 to 0 of the machine data: SG4 to SG1, SE2, SE1, SBH.
    pub const fn bits(&self) -> u16 {
        let [se1, se2] = self.se;
        let [sg1, sg2, sg3, sg4] = self.sg;
        (self.sbh.bits() as u16)
            | (se1.bits() as u16) << 2
            | (se2.bits() as u16) << 4
            | (sg1.bits() as u16) << 6
            | (sg2.bits() as u16) << 8
            | (sg3.bits() as u16) << 10
            | (sg4.bits() as u16) << 12
    }

    /// The field of a stage.
    pub const fn stage(&self, stage: Stage) -> Field {
        let [sg1, sg2, sg3, sg4] = self.sg;
        match stage {
            Stage::Sg1 => sg1,
            Stage::Sg2 => sg2,
            Stage::Sg3 => sg3,
            Stage::Sg4 => sg4,
        }
    }
}

fields! {
    /// Result list 2 (MD 1393 / 1394).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct List2 {
        /// The cams SN1+, SN1-, SN2+ to SN4-: above means beyond the cam.
        pub cams: [Field; 8],
        /// The upper limit of n_x: above when not slower than n_x.
        pub n_x_upper: Field,
        /// The lower limit of n_x: below when not slower than n_x. The monitor compares the magnitude of the speed, so both
        /// fields change together.
        pub n_x_lower: Field,
        /// The modulo range of the cams: selected where positions are folded.
        pub modulo: Field,
    }
}

impl List2 {
    /// The list as the bits 21 to 0 of the machine data: modulo range, n_x lower and upper limit, SN4- to SN1+.
    pub fn bits(&self) -> u32 {
        let bits = |field: Field, _| u32::from(field.bits());
        let [a, b, c, d, e, f, g, h] = each(self.cams, self.cams, bits);
        a | b << 2
            | c << 4
            | d << 6
            | e << 8
            | f << 10
            | g << 12
            | h << 14
            | u32::from(self.n_x_upper.bits()) << 16
            | u32::from(self.n_x_lower.bits()) << 18
            | u32::from(self.modulo.bits()) << 20
    }
}

/// Both lists place by place, each place written out: a model checker that follows the pointers of iterators gives no answer.
fn each<A: Copy, B: Copy, C>(first: [A; 8], second: [B; 8], of: impl Fn(A, B) -> C) -> [C; 8] {
    let [a1, a2, a3, a4, a5, a6, a7, a8] = first;
    let [b1, b2, b3, b4, b5, b6, b7, b8] = second;
    [
        of(a1, b1),
        of(a2, b2),
        of(a3, b3),
        of(a4, b4),
        of(a5, b5),
        of(a6, b6),
        of(a7, b7),
        of(a8, b8),
    ]
}

config! {
    /// Which functions of list 2 exist.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        cams: [bool; 8],
        n_x: bool,
        modulo: bool,
    }
}

impl Config {
    /// `cams`: the cams enabled, SN1+, SN1-, SN2+ to SN4- (bits 8 to 15 of the enable word). `n_x`: the threshold is not 0.
    /// `modulo`: the positions of the cams are folded.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(cams: [bool; 8], n_x: bool, modulo: bool) -> Result<Self, ConfigError> {
        Ok(Self { cams, n_x, modulo })
    }
}

fields! {
    /// The inputs of one cycle: the results of the monitors in this cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What is monitored.
        pub monitored: Monitored,
        /// The stage in force.
        pub stage: Stage,
        /// The speed is above the limit of the stage.
        pub speed_violated: bool,
        /// The position is beyond the upper limit of the operating stop.
        pub standstill_upper: bool,
        /// The position is beyond the lower limit of the operating stop.
        pub standstill_lower: bool,
        /// A pair of limit switches is watched.
        pub se_watched: bool,
        /// The pair selected: 0 is SE1, 1 is SE2.
        pub se_select: bool,
        /// The position is beyond the plus end.
        pub se_upper: bool,
        /// The position is beyond the minus end.
        pub se_lower: bool,
        /// The own results of the cams, before they are combined with those of the other channel.
        pub cams: [bool; 8],
        /// The speed is below n_x.
        pub below: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Result list 1.
        pub list_1: List1,
        /// Result list 2.
        pub list_2: List2,
    }
}

monitor! { sinumerik::results;
    /// The field of the operating stop: not selected, within the window, or the side that was left.
    operating_stop_has_its_field ["S840D-KDV-515", "S840D-KDV-509"]:
        when |s| s.inputs.monitored == Monitored::Standstill || s.outputs.list_1.sbh != Field::NotSelected
            => s.inputs.monitored == Monitored::Standstill
                && s.outputs.list_1.sbh == if s.inputs.standstill_upper {
                    Field::Above
                } else if s.inputs.standstill_lower {
                    Field::Below
                } else {
                    Field::Within
                };

    /// The stage in force has a field: within its limit or above.
    stage_has_its_field ["S840D-KDV-515", "S840D-KDV-509"]:
        when |s| s.inputs.monitored == Monitored::Speed
            => s.outputs.list_1.stage(s.inputs.stage)
                == if s.inputs.speed_violated { Field::Above } else { Field::Within };

    /// No other stage is selected.
    one_stage_at_most ["S840D-KDV-515"]:
        when |s| s.inputs.monitored != Monitored::Nothing
            => Stage::ALL.iter().all(|stage| {
                (s.inputs.monitored == Monitored::Speed && *stage == s.inputs.stage)
                    || s.outputs.list_1.stage(*stage) == Field::NotSelected
            });

    /// The watched pair of limit switches has a field, the other one has none.
    limit_switches_have_their_field ["S840D-KDV-515", "S840D-SE-007"]:
        when |s| s.inputs.se_watched
            => {
                let [se1, se2] = s.outputs.list_1.se;
                let (selected, other) = if s.inputs.se_select { (se2, se1) } else { (se1, se2) };
                other == Field::NotSelected
                    && selected == if s.inputs.se_upper {
                        Field::Above
                    } else if s.inputs.se_lower {
                        Field::Below
                    } else {
                        Field::Within
                    }
            };

    /// With nothing selected list 1 is empty.
    nothing_selected_is_empty ["S840D-KDV-515", "S840D-SG-012"]:
        when |s| s.inputs.monitored == Monitored::Nothing && !s.inputs.se_watched
            => s.outputs.list_1.bits() == 0;

    /// Two different results give different bits: nothing is hidden from the comparison.
    bits_show_every_field ["S840D-KDV-515", "S840D-KDV-509"]:
        when |s| s.outputs.list_1 != List1::default() || s.outputs.list_2 != List2::default()
            => s.outputs.list_1.bits() != 0 || s.outputs.list_2.bits() != 0;

    /// Every enabled cam shows on which side the axis is; the others show nothing.
    cams_show_their_side ["S840D-KDV-515", "S840D-SN-001"]:
        when |s| s.config.cams != [false; 8]
            => s.outputs.list_2.cams == each(s.config.cams, s.inputs.cams, |enabled, beyond| match (enabled, beyond) {
                (false, _) => Field::NotSelected,
                (true, false) => Field::Within,
                (true, true) => Field::Above,
            });

    /// The threshold shows whether the axis is slower, in both fields.
    threshold_has_its_fields ["S840D-KDV-515", "S840D-NX-002"]:
        when |s| s.config.n_x
            => (s.outputs.list_2.n_x_upper == Field::Within) == s.inputs.below
                && (s.outputs.list_2.n_x_lower == Field::Within) == s.inputs.below
                && s.outputs.list_2.n_x_upper != Field::NotSelected
                && s.outputs.list_2.n_x_lower != Field::NotSelected;
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let stage = |stage| {
        let selected = inputs.monitored == Monitored::Speed && inputs.stage == stage;
        Field::new(selected, inputs.speed_violated, false)
    };
    let pair = |second| {
        let selected = inputs.se_watched && inputs.se_select == second;
        Field::new(selected, inputs.se_upper, inputs.se_lower)
    };
    let cams = each(config.cams, inputs.cams, |enabled, beyond| {
        Field::new(enabled, beyond, false)
    });
    let outputs = Outputs {
        list_1: List1 {
            sbh: Field::new(
                inputs.monitored == Monitored::Standstill,
                inputs.standstill_upper,
                inputs.standstill_lower,
            ),
            se: [pair(false), pair(true)],
            sg: [
                stage(Stage::Sg1),
                stage(Stage::Sg2),
                stage(Stage::Sg3),
                stage(Stage::Sg4),
            ],
        },
        list_2: List2 {
            cams,
            n_x_upper: Field::new(config.n_x, !inputs.below, false),
            n_x_lower: Field::new(config.n_x, false, !inputs.below),
            modulo: Field::new(config.modulo, false, false),
        },
    };
    (State, outputs)
}
