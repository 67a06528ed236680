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

/// Every scenario holds, and its recording is what both channels say when they are given its inputs again.
#[test]
fn the_scenarios_hold_and_their_recordings_are_replayed() {
    let run = SCENARIOS.hold_and_are_replayed();
    assert!(run >= 10, "{run}");
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
}

/// The whole text, with the diagram.
#[test]
fn the_exceeded_speed_is_drawn() {
    let scenario = "spec/scenarios/sinamics-s120/speed-exceeded.toml";
    let output = stillpoint(&["simulate", GANTRY, "--scenario", scenario]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    insta::assert_snapshot!(stdout(&output));
}
