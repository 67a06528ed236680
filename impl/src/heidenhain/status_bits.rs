//! What the main computer (MC) and the controller computer (CC) do on the safe status bits of a telegram.
//!
//! A reaction is that of the cycle in which the bit arrives: the 3.2 ms of the MC and the 9.6 ms of the CC after an emergency stop
//! button are the way of the signal and one cycle (HFS-TIMING-005, HFS-TIMING-006).
//!
//! Every participant of the bus may set a bit; most are active as 0, hence the minus in their names. Of several active bits
//! the highest reaction counts. The safe outputs of a panel or I/O assembly are switched off only where the fault is, by the
//! internal fault bits of that participant and by no status bit (HFS-STAT-008).

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::Stop;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The bits of one cycle: `true` where the signal is active, which most of them are as 0.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Bit 0, `-ES.A`: emergency stop, channel A.
        pub es_a: bool,
        /// Bit 1, `-ES.B`: emergency stop, channel B.
        pub es_b: bool,
        /// Bit 2, `-ES.A.HW`: emergency stop of the handwheel, channel A.
        pub es_a_hw: bool,
        /// Bit 3, `-ES.B.HW`: emergency stop of the handwheel, channel B.
        pub es_b_hw: bool,
        /// Bit 4, `-STO.A.MC.WD`: watchdog of the MC.
        pub mc_wd: bool,
        /// Bit 5, `-STOS.A.MC`: the MC has switched the spindle off.
        pub stos_mc: bool,
        /// Bit 6, `-STO.B.CC.WD`: watchdog of the CC.
        pub cc_wd: bool,
        /// Bit 7, `-SMC.A.WD`: fast watchdog of the MC.
        pub smc_wd: bool,
        /// Bit 8, `-SPL.WD`: watchdog of an I/O assembly.
        pub spl_wd: bool,
        /// Bit 9, `-SMOP.WD`: watchdog of an operating panel.
        pub smop_wd: bool,
        /// Bit 10, `-PF.PS.AC`: line voltage fails.
        pub pf_ac: bool,
        /// Bit 11, `-PF.PS.DC`: DC-link voltage fails.
        pub pf_dc: bool,
        /// Bit 12, `-PF.BOARD`: supply voltage of a board.
        pub pf_board: bool,
        /// Bit 13, `-N0`.
        pub n0: bool,
        /// Bit 14, `-REQ.SS2`: a participant asks for SS2.
        pub req_ss2: bool,
        /// A module of the PLC has switched the evaluation of bits 10 and 11 off.
        pub masked: bool,
        /// The I/O assembly's own fault bits: the control has crashed, the component has a fault, or its HSCI communication.
        pub spl_fault: bool,
        /// The same of the operating panel.
        pub smop_fault: bool,
    }
}

impl Inputs {
    /// The bits with the same stop in both channels, and the stop; without those of bit 11 and bit 13.
    fn common(&self) -> Stop {
        if self.cc_wd || self.spl_wd || self.smop_wd || self.pf_board {
            Stop::Ss1F
        } else if self.es_a
            || self.es_b
            || self.es_a_hw
            || self.es_b_hw
            || self.mc_wd
            || self.smc_wd
        {
            Stop::Ss1
        } else if self.req_ss2 {
            Stop::Ss2
        } else {
            Stop::None
        }
    }
}

fields! {
    /// The reactions of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop that the MC raises.
        pub mc: Stop,
        /// The stop that the CC raises.
        pub cc: Stop,
        /// Both lift the tool off the workpiece; no stop.
        pub lift_off: bool,
        /// The MC still serves its watchdogs.
        pub mc_retrigger: bool,
        /// The I/O assembly switches its outputs off: the fault is its own.
        pub spl_off: bool,
        /// The operating panel switches its outputs off: the fault is its own.
        pub smop_off: bool,
        /// The CC notes for the self-test that the spindle is switched off; no stop.
        pub spindle_seen: bool,
    }
}

monitor! { heidenhain::status_bits;
    /// Any emergency stop contact, in either channel, stops in both.
    emergency_stop_stops_both ["HFS-STAT-002/a", "HFS-TIMING-005/a", "HFS-TIMING-006/a", "HFS-TIMING-006/b", "HFS-P-07", "HFS-STAT-005", "HFS-STAT-007", "HFS-FAULT-011", "HFS-FAULT-013", "HFS-ES-001"]:
        when |s| s.inputs.es_a || s.inputs.es_b || s.inputs.es_a_hw || s.inputs.es_b_hw
            => s.outputs.mc >= Stop::Ss1 && s.outputs.cc >= Stop::Ss1;

    /// The watchdogs of the MC stop in both channels.
    watchdog_of_the_mc_stops_both ["HFS-STAT-002/b", "HFS-STAT-005", "HFS-FAULT-013"]:
        when |s| s.inputs.mc_wd || s.inputs.smc_wd
            => s.outputs.mc >= Stop::Ss1 && s.outputs.cc >= Stop::Ss1;

    /// Watchdogs of the others and the voltage of a board are fatal.
    fatal_bits_are_ss1f ["HFS-STAT-002/c", "HFS-STAT-005", "HFS-FAULT-020", "HFS-MON-005"]:
        when |s| s.inputs.cc_wd || s.inputs.spl_wd || s.inputs.smop_wd || s.inputs.pf_board
            => s.outputs.mc == Stop::Ss1F && s.outputs.cc == Stop::Ss1F;

    /// The DC-link voltage, unless masked, and -N0 stop in the CC.
    power_failure_stops_in_the_cc ["HFS-STAT-002/f", "HFS-STAT-001", "HFS-STAT-005", "HFS-FAULT-021"]:
        when |s| s.inputs.n0 || (s.inputs.pf_dc && !s.inputs.masked)
            => s.outputs.cc >= Stop::Ss1;

    /// The MC does not stop for these two bits itself.
    power_failure_alone_is_no_stop_of_the_mc ["HFS-STAT-001", "HFS-FAULT-021"]:
        when |s| (s.inputs.n0 || s.inputs.pf_dc) && s.inputs.common() == Stop::None
            => s.outputs.mc == Stop::None;

    /// On the failure of the DC-link voltage the MC lets its watchdogs run out; masked, it serves them.
    mc_lets_its_watchdogs_run_out ["HFS-STAT-006/b"]:
        when |s| s.inputs.pf_dc
            => s.outputs.mc_retrigger == s.inputs.masked;

    /// A request for SS2 is followed by both.
    request_is_followed ["HFS-STAT-002/g", "HFS-STAT-005", "HFS-FAULT-022", "HFS-MON-003"]:
        when |s| s.inputs.req_ss2
            => s.outputs.mc >= Stop::Ss2 && s.outputs.cc >= Stop::Ss2;

    /// The line voltage lifts the tool off unless masked, and the spindle bit is noted; neither stops anything.
    notes_are_no_stops ["HFS-STAT-002/d", "HFS-STAT-002/e", "HFS-STAT-005", "HFS-STAT-006/a"]:
        when |s| Inputs { pf_ac: false, stos_mc: false, masked: false, spl_fault: false, smop_fault: false, ..s.inputs } == Inputs::default()
            => s.outputs == Outputs {
                lift_off: s.inputs.pf_ac && !s.inputs.masked,
                spindle_seen: s.inputs.stos_mc,
                mc_retrigger: true,
                spl_off: s.inputs.spl_fault,
                smop_off: s.inputs.smop_fault,
                ..Outputs::default()
            };

    /// Safe outputs are switched off only where the fault is, whatever the status bits say.
    outputs_are_switched_off_locally ["HFS-STAT-001", "HFS-STAT-006/c", "HFS-STAT-008"]:
        when |s| s.outputs.spl_off || s.outputs.smop_off
            => (!s.outputs.spl_off || s.inputs.spl_fault) && (!s.outputs.smop_off || s.inputs.smop_fault);

    /// A participant with a fault of its own does switch its outputs off.
    faulty_participant_switches_off ["HFS-STAT-005", "HFS-STAT-006/c"]:
        when |s| s.inputs.spl_fault || s.inputs.smop_fault
            => s.outputs.spl_off == s.inputs.spl_fault && s.outputs.smop_off == s.inputs.smop_fault;
}

pub(crate) fn transition(_: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let dc = inputs.pf_dc && !inputs.masked;
    let mc = inputs.common();
    let outputs = Outputs {
        mc,
        cc: if dc || inputs.n0 {
            mc.max(Stop::Ss1)
        } else {
            mc
        },
        lift_off: inputs.pf_ac && !inputs.masked,
        mc_retrigger: !dc,
        spl_off: inputs.spl_fault,
        smop_off: inputs.smop_fault,
        spindle_seen: inputs.stos_mc,
    };
    (State, outputs)
}
