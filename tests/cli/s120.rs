//! Simulations of the gantry with SINAMICS S120 and their replay, as their user meets them.

use crate::common::{Folder, root, status, stderr, stdout, stillpoint};
use crate::scenarios::{Scenarios, simulate};

const GANTRY: &str = "spec/machines/gantry-s120.toml";

/// The text of the gantry's file, its program in the folder.
fn gantry(folder: &Folder) -> String {
    let read = |path: &str| std::fs::read_to_string(root().join(path)).expect("readable");
    folder.write("gantry-s120.st", &read("spec/machines/gantry-s120.st"));
    read(GANTRY)
}

const SCENARIOS: Scenarios = Scenarios {
    machine: GANTRY,
    family: "sinamics-s120",
};

/// The other machines: drives with F-DIs and without encoder, and one with a gearbox.
const STACKER: Scenarios = Scenarios {
    machine: "spec/machines/stacker-s120.toml",
    family: "sinamics-s120-stacker",
};
const FEEDER: Scenarios = Scenarios {
    machine: "spec/machines/feeder-s120.toml",
    family: "sinamics-s120-feeder",
};

/// Every scenario holds, and its recording is what both channels say when they are given its inputs again.
#[test]
fn the_scenarios_hold_and_their_recordings_are_replayed() {
    let run = SCENARIOS.hold_and_are_replayed();
    assert!(run >= 10, "{run}");
    let run = STACKER.hold_and_are_replayed();
    assert!(run >= 12, "{run}");
    let run = FEEDER.hold_and_are_replayed();
    assert!(run >= 4, "{run}");
}

/// Each thing that a scenario depends on: with another one, it fails.
#[test]
fn a_scenario_of_the_gantry_can_fail() {
    SCENARIOS.can_fail(&[
        // A bridge that brakes less than p1135 says does not stand after 250 ms.
        [
            "emergency-stop.toml",
            "[axis.Z]",
            "[axis.X1]\npath_braking = \"1500 mm/s2\"\n\n[axis.Z]",
            "X1.ch1.STO_active",
        ],
        // Nobody acknowledges and switches on again.
        [
            "emergency-stop.toml",
            "[[reset]]\nat = \"2.4 s\"\n",
            "",
            "X1 and X2 and Z move in a cycle from 2.7 s",
        ],
        // The terminals stay open: C does not switch on, nor do the others.
        [
            "emergency-stop.toml",
            "until  = \"1.92 s\"\n",
            "",
            "X1 and X2 and Z move in a cycle from 2.7 s",
        ],
        // Somebody pushes the left motor out of the window of SOS.
        [
            "door-open.toml",
            "[[agreement]]                  # the enabling device\n",
            "[[moved]]\nat = \"1.4 s\"\naxis = \"X1\"\nby = \"1.1 mm\"\n\n[[agreement]]\n",
            "never X1.ch1.stop or X1.ch2.stop or X2.ch1.stop",
        ],
        [
            "door-open.toml",
            "door = \"front\"",
            "door = \"service\"",
            "X1.ch1.SOS_active",
        ],
        // Without the enabling device SOS stays.
        [
            "door-open.toml",
            "give = true",
            "give = false",
            "X1.ch1.SLS_active",
        ],
        [
            "speed-exceeded.toml",
            "\"102 % of SLS2\"",
            "\"100 % of SLS2\"",
            "X1.ch1.stop and X1.ch2.stop and X2.ch1.stop and X2.ch2.stop = C",
        ],
        // What only does not brake is nothing for SAM.
        [
            "no-braking.toml",
            "speed = \"30000 mm/min\"",
            "speed = \"6000 mm/min\"",
            "Y.ch1.stop and Y.ch2.stop = A",
        ],
        // It sees again before SLS is selected.
        [
            "channels-differ.toml",
            "value   = true\n",
            "value   = true\nuntil = \"0.5 s\"\n",
            "X1.ch1.stop = B",
        ],
        // Within p9542.
        [
            "encoder-freeze.toml",
            "kind    = \"encoder freeze\"",
            "kind    = \"encoder offset\"\noffset = \"0.1 mm\"",
            "alarm C01711 in Y.ch1.alarms",
        ],
        // Not referenced: SLP watches nothing.
        [
            "power-up.toml",
            "[[reference]]\nat   = \"1.32 s\"\naxis = \"Y\"\n",
            "",
            "Y.ch1.stop and Y.ch2.stop = C",
        ],
        [
            "power-up.toml",
            "run_up = \"0.6 s\"",
            "run_up = \"1.4 s\"",
            "Y.ch1.telegram_valid and Y.ch2.telegram_valid = TRUE",
        ],
        // Within p9650.
        [
            "terminals-differ.toml",
            "until   = \"1.5 s\"",
            "until   = \"0.888 s\"",
            "alarm F01611 in C.ch1.alarms",
        ],
        [
            "telegram-lost.toml",
            "until  = \"1.8 s\"",
            "until  = \"0.732 s\"",
            "X1.ch1.stop and X1.ch2.stop and X2.ch1.stop and X2.ch2.stop = A",
        ],
        // The brake sticks open.
        [
            "vertical-brake.toml",
            "[[stop]]",
            "[[brake]]\nat = \"0.3 s\"\naxis = \"Z\"\nbrake = 1\nstuck = true\n\n[[stop]]",
            "Z stands",
        ],
        [
            "vertical-brake.toml",
            "value   = true\n",
            "value   = false\n",
            "alarm F01630 in Z.ch1.alarms",
        ],
    ]);
}

/// The same for the lift: range, direction, reference, brakes and test stops.
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

/// SBR watches the ramp: an axis that only does not brake is STOP A, where SAM says nothing before p9556 is over.
#[test]
fn an_axis_that_does_not_brake_is_seen_by_the_ramp() {
    let folder = Folder::new("s120-sbr");
    let machine = gantry(&folder);
    let ramp = "p9506 = \"encoder, SBR\"\np9581 = \"40000 mm/min\"\np9582 = \"36 ms\"\np9583 = \"1 s\"\np9610  = 102";
    let machine = folder.write("sbr.toml", &machine.replacen("p9610  = 102", ramp, 1));
    let scenario = folder.write(
        "deaf.toml",
        "duration = \"1.5 s\"\n[axis.Y]\nposition = \"500 mm\"\n\
         [[motion]]\nat = \"0.12 s\"\naxis = \"Y\"\nspeed = \"6000 mm/min\"\n\
         [[fault]]\nat = \"0.6 s\"\naxis = \"Y\"\nkind = \"no braking\"\n\
         [[stop]]\nat = \"0.72 s\"\naxis = \"Y\"\nstop = \"SS1\"\n\
         [[expect]]\naxis = \"Y\"\nalarm = \"C01706\"\nafter = \"0.756 s\"\nby = \"0.792 s\"\n\
         [[expect]]\naxis = \"Y\"\nstop = \"A\"\nafter = \"0.756 s\"\nby = \"0.792 s\"\n",
    );
    let output = simulate(&machine, &scenario, &[]);
    let said = stdout(&output);
    assert_eq!(status(&output), 0, "{said}{}", stderr(&output));
    assert!(said.contains("Y STOP A in cycle 6"), "{said}");
    let output = simulate(GANTRY, &scenario, &[]);
    assert_eq!(status(&output), 1, "{}", stdout(&output));
}

/// The replay finds a recorded output that the monitors do not say.
#[test]
fn a_changed_recording_of_the_gantry_diverges() {
    // The axis moves: its position changes in each cycle.
    SCENARIOS.a_change_diverges(
        "no-braking.toml",
        [
            "{\"cycle\":40,\"time_us\":480000,\"signals\":{",
            "\"Y.ch2.OFF3\":true,",
            "cycle 40: Y.ch2.OFF3: recorded",
        ],
    );
}

#[test]
fn what_is_no_signal_or_function_of_the_gantry_is_refused() {
    SCENARIOS.are_refused(&[
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"B\"\nsignal = \"terminal\"\nvalue = false\n",
            "axis B has no signal terminal",
        ),
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"X1\"\nsignal = \"SLS_level\"\nvalue = 4\n",
            "allowed: 0 to 3",
        ),
        (
            "[[select]]\nat = \"0 s\"\naxis = \"C\"\nfunction = \"SLS1\"\n",
            "axis C has no function \"motion monitoring\"",
        ),
        (
            "[[select]]\nat = \"0 s\"\naxis = \"X1\"\nfunction = \"SLS5\"\n",
            "\"SLS5\" is no function to select",
        ),
        (
            "[[brake]]\nat = \"0 s\"\naxis = \"X1\"\nbrake = 1\n",
            "axis X1 has no function \"SBC\"",
        ),
        (
            "[[expect]]\naxis = \"X1\"\nstop = \"SS1\"\n",
            "\"SS1\" is no stop",
        ),
        (
            "[[expect]]\naxis = \"X1\"\nalarm = \"C01777\"\n",
            "\"C01777\" is no alarm of the monitors",
        ),
    ]);
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

/// The whole text, with the diagram.
#[test]
fn the_exceeded_speed_is_drawn() {
    let scenario = "spec/scenarios/sinamics-s120/speed-exceeded.toml";
    let output = stillpoint(&["simulate", GANTRY, "--scenario", scenario]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    insta::assert_snapshot!(stdout(&output));
}
