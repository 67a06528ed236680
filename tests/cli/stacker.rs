//! Simulations of the other machines with SINAMICS S120: a stacker, whose drives have F-DIs or no encoder, and a feeder with a gearbox.

use crate::common::{Folder, root, status, stderr, stdout, stillpoint};
use crate::scenarios::Scenarios;

const STACKER: Scenarios = Scenarios {
    machine: "spec/machines/stacker-s120.toml",
    family: "sinamics-s120-stacker",
};
const FEEDER: Scenarios = Scenarios {
    machine: "spec/machines/feeder-s120.toml",
    family: "sinamics-s120-feeder",
};

/// Both machines keep what they promise and raise no warning; with a time that is too short one does not.
#[test]
fn the_machines_keep_their_guarantees() {
    let folder = Folder::new("stacker-guarantees");
    for (machine, within, values) in [
        (
            STACKER.machine,
            "1200 ms",
            "1 warning, accepted with reasons",
        ),
        (FEEDER.machine, "700 ms", "no warning"),
    ] {
        let output = stillpoint(&["check", machine]);
        let said = stdout(&output);
        assert_eq!(status(&output), 0, "{machine}: {said}{}", stderr(&output));
        assert!(said.contains("ALL GUARANTEES HOLD"), "{said}");
        assert!(said.contains(&format!("These values: {values}")), "{said}");
        let text = std::fs::read_to_string(root().join(machine)).expect("readable");
        let claim = format!("within  = \"{within}\"");
        assert_eq!(text.matches(&claim).count(), 1, "{machine}: {claim}");
        let file = folder.write(
            "short.toml",
            &text.replacen(&claim, "within  = \"300 ms\"", 1),
        );
        let output = stillpoint(&["check", &file]);
        let said = stdout(&output);
        assert_eq!(status(&output), 1, "{machine}: {said}{}", stderr(&output));
    }
}

/// Every scenario holds, and its recording is what both channels say when they are given its inputs again.
#[test]
fn the_scenarios_hold_and_their_recordings_are_replayed() {
    let run = STACKER.hold_and_are_replayed();
    assert!(run >= 12, "{run}");
    let run = FEEDER.hold_and_are_replayed();
    assert!(run >= 4, "{run}");
}

/// Each thing that a scenario of the lift depends on: with another one, it fails. Range, direction, reference, brakes and test stops.
#[test]
fn a_scenario_of_the_lift_can_fail() {
    STACKER.can_fail(&[
        // The F-DI of the retraction does not come.
        [
            "slp-retraction.toml",
            "signal = \"retract\"\nvalue  = true",
            "signal = \"retract\"\nvalue  = false",
            "L.ch1.SDI_negative_active",
        ],
        // It comes in one channel only: the other one still monitors the range.
        [
            "slp-retraction.toml",
            "axis   = \"L\"\nsignal = \"retract\"",
            "axis   = \"L\"\nchannel = \"ch1\"\nsignal = \"retract\"",
            "L.ch1.stop and L.ch2.stop = NONE",
        ],
        // Nobody moves it inside: the falling edge finds it outside.
        [
            "slp-retraction.toml",
            "speed = \"-6000 mm/min\"\nto    = \"1900 mm\"",
            "speed = \"0 mm/min\"",
            "never L.ch1.stop or L.ch2.stop = C",
        ],
        // The right way.
        [
            "slp-wrong-way.toml",
            "speed = \"1200 mm/min\"",
            "speed = \"-1200 mm/min\"",
            "alarm C01716 in L.ch1.alarms",
        ],
        // Within p9564.
        [
            "sdi.toml",
            "at    = \"0.9 s\"\naxis  = \"L\"\nspeed = \"-3000 mm/min\"",
            "at    = \"0.9 s\"\naxis  = \"L\"\nspeed = \"3000 mm/min\"",
            "alarm C01716 in L.ch1.alarms",
        ],
        // SDI is not deselected before the acknowledgement.
        [
            "sdi.toml",
            "at       = \"2.4 s\"\naxis     = \"L\"\nfunction = \"none\"",
            "at       = \"2.4 s\"\naxis     = \"L\"\nfunction = \"SDI+\"",
            "L.ch1.stop and L.ch2.stop = NONE",
        ],
        // Both channels agree the first time: no message, and safe earlier than expected.
        [
            "referencing.toml",
            "channel = \"ch1\"\nsignal  = \"user_agreement\"",
            "signal  = \"user_agreement\"",
            "alarm C01711 in L.ch1.alarms",
        ],
        // The lift has sunk by more than p9544.
        [
            "referencing.toml",
            "\"-0.09 mm\"",
            "\"-0.11 mm\"",
            "L.ch1.safely_referenced and L.ch2.safely_referenced = TRUE in a cycle from 7.2 s",
        ],
        // A brake that holds two thirds.
        [
            "brake-test.toml",
            "[[signal]]",
            "[[brake]]\nat = \"0 s\"\naxis = \"L\"\nbrake = 1\ntorque = \"66 %\"\n\n[[signal]]",
            "L.ch1.SBT_successful",
        ],
        // The external one does not close.
        [
            "brake-test.toml",
            "[[signal]]",
            "[[brake]]\nat = \"0 s\"\naxis = \"L\"\nbrake = 2\nstuck = true\n\n[[signal]]",
            "L.ch1.external_brake_closed",
        ],
        // The brake is in order.
        ["weak-brake.toml", "\"33 %\"", "\"100 %\"", "L moves"],
        // The test is not broken off.
        [
            "weak-brake.toml",
            "until  = \"3.6 s\"",
            "until  = \"4.2 s\"",
            "alarm A01782 in L.ch1.alarms",
        ],
        [
            "external-brake.toml",
            "stuck = true",
            "torque = \"100 %\"",
            "L.ch1.SBT_late",
        ],
        // The pulses cannot be suppressed at once: the automatic test fails.
        [
            "test-stop.toml",
            "at      = \"5.4 s\"",
            "at      = \"0.6 s\"",
            "L.ch1.test_stop_due",
        ],
        // No STO is selected: the test begins.
        [
            "test-stop.toml",
            "axis = \"L\"\nstop = \"STO\"",
            "axis = \"L\"\nstop = \"none\"",
            "never L.ch1.test_stop_active or L.ch2.test_stop_active = TRUE",
        ],
        // Both paths are in order.
        [
            "test-stop.toml",
            "signal  = \"path_fault\"\nvalue   = true",
            "signal  = \"path_fault\"\nvalue   = false",
            "L.ch1.test_stop_failed",
        ],
    ]);
}

/// The same for the drives without encoder.
#[test]
fn a_scenario_without_encoder_can_fail() {
    STACKER.can_fail(&[
        // STO is not selected: the internal one stays.
        [
            "conveyor-restart.toml",
            "at   = \"9 s\"\naxis = \"R\"\nstop = \"STO\"",
            "at   = \"9 s\"\naxis = \"R\"\nstop = \"none\"",
            "R.ch1.torque and R.ch2.torque = TRUE in a cycle from 10.1",
        ],
        // Switched on too late.
        [
            "conveyor-restart.toml",
            "[[reset]]                      # OFF and ON\nat = \"10 s\"",
            "[[reset]]\nat = \"13.9 s\"",
            "R.ch1.torque and R.ch2.torque = TRUE in a cycle from 10.1",
        ],
        [
            "conveyor-restart.toml",
            "\"104 % of SLS2\"",
            "\"98 % of SLS2\"",
            "alarm C01714 in R.ch1.alarms",
        ],
        // Somebody tells the motion.
        [
            "conveyor-ramp.toml",
            "[[select]]                     # nobody tells the motion",
            "[[motion]]\nat = \"1.8 s\"\naxis = \"R\"\nspeed = \"1800 mm/min\"\n\n[[select]]",
            "alarm C01706 in R.ch1.alarms",
        ],
        // The start phase is over while the value is wrong.
        [
            "conveyor-ramp.toml",
            "until  = \"5.2 s\"",
            "until  = \"5.4 s\"",
            "never alarm C01711 in R.ch1.alarms",
        ],
        // Without SDI no status stays.
        [
            "conveyor-direction.toml",
            "function = \"SDI+\"",
            "function = \"none\"",
            "R.ch1.internal_STO",
        ],
        [
            "conveyor-direction.toml",
            "speed = \"-3000 mm/min\"",
            "speed = \"3000 mm/min\"",
            "alarm C01716 in R.ch1.alarms",
        ],
        // The current comes.
        [
            "wrapper-unselected.toml",
            "signal = \"minimum_current\"\nvalue  = false",
            "signal = \"minimum_current\"\nvalue  = true",
            "W.ch1.C01711 and W.ch2.C01711 = 1041",
        ],
        [
            "wrapper-unselected.toml",
            "\"103 % of SLS1\"",
            "\"99 % of SLS1\"",
            "alarm C01714 in W.ch1.alarms",
        ],
    ]);
}

/// The same for gear and position.
#[test]
fn a_scenario_of_the_feeder_can_fail() {
    FEEDER.can_fail(&[
        // Nobody references it again.
        [
            "gear.toml",
            "[[reference]]\nat   = \"1.2 s\"\naxis = \"F\"\n",
            "",
            "F.ch1.safely_referenced and F.ch2.safely_referenced = TRUE",
        ],
        // Without the increased tolerance.
        [
            "gear.toml",
            "signal = \"gear_tolerance\"\nvalue  = true",
            "signal = \"gear_tolerance\"\nvalue  = false",
            "never alarm C01711 in F.ch1.alarms",
        ],
        // One channel does not see the stage.
        [
            "gear.toml",
            "axis   = \"F\"\nsignal = \"gear_stage\"\nvalue  = 2",
            "axis   = \"F\"\nchannel = \"ch1\"\nsignal = \"gear_stage\"\nvalue  = 2",
            "never alarm C01711 in F.ch1.alarms",
        ],
        // 2 min and no longer.
        [
            "gear-too-long.toml",
            "at     = \"0.6 s\"",
            "at     = \"0.6 s\"\nuntil  = \"120.6 s\"",
            "F.ch1.C01711 and F.ch2.C01711 = 1015",
        ],
        // The least share that is one.
        [
            "limit-by-telegram.toml",
            "value  = 0\n",
            "value  = 1\n",
            "F.ch1.C01711 and F.ch2.C01711 = 1041",
        ],
        // At another level the word has no effect.
        [
            "limit-by-telegram.toml",
            "function = \"SLS1\"",
            "function = \"SLS2\"",
            "alarm C01711 in F.ch1.alarms",
        ],
        // It stops where it fits.
        [
            "safe-position.toml",
            "speed = \"1200 mm/min\"",
            "speed = \"1200 mm/min\"\nto = \"3276.7 mm\"",
            "F.ch1.C01711 and F.ch2.C01711 = 7001",
        ],
        [
            "safe-position.toml",
            "signal = \"user_agreement\"\nvalue  = true",
            "signal = \"user_agreement\"\nvalue  = false",
            "F.ch1.SP_valid and F.ch2.SP_valid = TRUE",
        ],
    ]);
}

#[test]
fn what_is_no_signal_of_these_drives_is_refused() {
    STACKER.are_refused(&[
        // An F-DI retracts, no telegram; without encoder nothing holds an axis.
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"R\"\nsignal = \"SOS\"\nvalue = false\n",
            "axis R has no signal SOS",
        ),
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"L\"\nsignal = \"plausible\"\nvalue = false\n",
            "axis L has no signal plausible",
        ),
    ]);
    FEEDER.are_refused(&[
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"F\"\nsignal = \"gear_stage\"\nvalue = 8\n",
            "allowed: 0 to 7",
        ),
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"F\"\nsignal = \"retract\"\nvalue = true\n",
            "retract",
        ),
    ]);
}
