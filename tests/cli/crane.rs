//! Simulations of the storage crane and their replay, as their user meets them.

use crate::common::{Folder, messages, root, status, stderr, stdout, stillpoint};
use crate::scenarios::{Scenarios, simulate};

const CRANE: &str = "spec/machines/storage-crane.toml";

const SCENARIOS: Scenarios = Scenarios {
    machine: CRANE,
    family: "srm-fblocks",
};

/// Every scenario holds, and its recording is what the blocks say when they are given its inputs again.
#[test]
fn the_scenarios_hold_and_their_recordings_are_replayed() {
    let run = SCENARIOS.hold_and_are_replayed();
    assert!(run >= 8, "{run}");
}

/// Each thing that a scenario depends on: with another one, it fails.
#[test]
fn a_scenario_of_the_crane_can_fail() {
    SCENARIOS.can_fail(&[
        // It brakes late, and does not obey the limit.
        [
            "end-zone.toml",
            "[axis.X]",
            "acceptance_mode = true\n\n[axis.X]\nacceleration = \"900 mm/s2\"",
            "never X.cpu.stop = SS1",
        ],
        // The setpoint does not obey the envelope, but it is slow enough for it.
        [
            "over-speed.toml",
            "speed = \"230000 mm/min\"",
            "speed = \"230000 mm/min\"\nto = \"99000 mm\"",
            "alarm EZ.9 in X.cpu.alarms",
        ],
        // A drive that brakes less than its ramp passes the end.
        [
            "over-speed.toml",
            "position = \"60000 mm\"",
            "position = \"60000 mm\"\npath_braking = \"420 mm/s2\"",
            "never X.cpu.X_POSITIVE_OK = FALSE",
        ],
        // The external brake sticks open: T_CLOSE_BR_1 is over without its feedback.
        [
            "brake-test.toml",
            "[[signal]]",
            "[[brake]]\nat = \"0 s\"\naxis = \"Y\"\nbrake = 1\nstuck = true\n\n[[signal]]",
            "Y.cpu.BR_1_OK = TRUE",
        ],
        [
            "weak-brake.toml",
            "torque = \"60 %\"",
            "torque = \"100 %\"",
            "alarm BT.6 in Y.cpu.alarms",
        ],
        // It hangs free.
        [
            "slack-rope.toml",
            "rests = \"3000 mm\"",
            "",
            "alarm LOAD.2 in Y.cpu.alarms",
        ],
        // Without RELEASE nothing goes back up.
        [
            "slack-rope.toml",
            "give = true",
            "give = false",
            "Y.cpu.stop = NONE in a cycle from 7.5 s",
        ],
        // Within both windows.
        [
            "encoder-stands.toml",
            "kind    = \"encoder freeze\"",
            "kind = \"encoder offset\"\noffset = \"19 mm\"",
            "alarm POS.8 in X.cpu.alarms",
        ],
        [
            "encoder-jumps.toml",
            "offset  = \"300 mm\"",
            "offset  = \"19 mm\"",
            "alarm POS.9 in Y.cpu.alarms",
        ],
        [
            "encoder-jumps.toml",
            "speed   = \"2400 mm/min\"",
            "speed   = \"1000 mm/min\"",
            "alarm POS.6 in Y.cpu.alarms in a cycle from 4.48 s",
        ],
        [
            "no-braking.toml",
            "kind = \"no braking\"",
            "encoder = \"POS1\"\nkind = \"encoder offset\"\noffset = \"1 mm\"",
            "X.cpu.stop = STO",
        ],
        [
            "power-up.toml",
            "signal = \"SYNC\"",
            "signal = \"RELEASE\"",
            "X.cpu.POS_VALID = TRUE in a cycle from 2 s",
        ],
        [
            "power-up.toml",
            "signal = \"EXECUTE\"",
            "signal = \"CALIBRATE\"",
            "Y.cpu.BT_TEST_REQ = FALSE",
        ],
    ]);
}

/// A monitor that is called before F_SAFE_POS, and the logic before the monitor, stop the drive a call later each.
#[test]
fn the_order_of_the_calls_of_the_file_is_that_of_the_simulation() {
    let folder = Folder::new("crane-order");
    let machine = std::fs::read_to_string(root().join(CRANE)).expect("readable");
    let stop = |order: &str| -> u64 {
        let text = machine.replacen("[control]", &format!("[control]\nCALL_ORDER = {order}"), 1);
        // Without the guarantees: in another order one of them does not hold.
        let (text, _) = text.split_once("[guarantee.aisle]").expect("it has some");
        let file = folder.write("crane.toml", text);
        let scenario = root().join("spec/scenarios/srm-fblocks/over-speed.toml");
        let output = simulate(&file, scenario.to_str().expect("UTF-8"), &[]);
        let said = stdout(&output);
        let line = said.lines().find(|l| l.starts_with("X SS1 in cycle"));
        let line = line.unwrap_or_else(|| panic!("{said}{}", stderr(&output)));
        let cycle = line.split(' ').nth(4).expect("its number");
        cycle.parse().expect("a number")
    };
    let first = stop("[1, 2, 3, 4, 5, 6]");
    assert_eq!(stop("[2, 1, 3, 4, 5, 6]"), first + 1);
    assert_eq!(stop("[2, 3, 4, 5, 6, 1]"), first + 1);
    assert_eq!(stop("[3, 2, 4, 5, 6, 1]"), first + 2);
}

/// The replay finds a recorded output that the blocks do not say.
#[test]
fn a_changed_recording_of_the_crane_diverges() {
    // The counter of the telegram changes in each cycle.
    SCENARIOS.a_change_diverges(
        "encoder-jumps.toml",
        [
            "{\"cycle\":299,\"time_us\":5980000,\"signals\":{",
            "\"Y.cpu.V_VALID\":true,",
            "cycle 299: Y.cpu.V_VALID: recorded",
        ],
    );
}

#[test]
fn what_is_no_signal_or_part_of_the_crane_is_refused() {
    SCENARIOS.are_refused(&[
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"Z\"\nsignal = \"LOAD1\"\nvalue = 3\n",
            "axis Z has no signal LOAD1",
        ),
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"Y\"\nsignal = \"LOAD1\"\nvalue = true\n",
            "LOAD1 is a whole number; got TRUE",
        ),
        (
            "[[signal]]\nat = \"0 s\"\naxis = \"Y\"\nsignal = \"POSSI_COUNT\"\nvalue = 32768\n",
            "allowed: -32768 to 32767",
        ),
        (
            "[[brake]]\nat = \"0 s\"\naxis = \"X\"\nbrake = 1\n",
            "axis X has no function \"brake test\"",
        ),
        (
            "[[brake]]\nat = \"0 s\"\naxis = \"Y\"\nbrake = 3\n",
            "3 is no brake",
        ),
        (
            "[[brake]]\nat = \"0 s\"\naxis = \"Y\"\nbrake = 1\ntorque = \"60\"\n",
            "\"60\" is no share of a torque",
        ),
        (
            "[[load]]\nat = \"0 s\"\naxis = \"Y\"\nload = -1\n",
            "a load of -1 is none",
        ),
        (
            "[[fault]]\nat = \"0 s\"\naxis = \"X\"\nkind = \"encoder freeze\"\n",
            "which encoder?",
        ),
        (
            "[[fault]]\nat = \"0 s\"\naxis = \"X\"\nkind = \"encoder freeze\"\nencoder = \"POS3\"\n",
            "\"POS3\" is no encoder",
        ),
        (
            "[[fault]]\nat = \"0 s\"\naxis = \"X\"\nkind = \"telegram freeze\"\nencoder = \"POS1\"\n",
            "POS1 comes by no telegram",
        ),
        (
            "[[fault]]\nat = \"0 s\"\naxis = \"X\"\nkind = \"encoder freeze\"\nchannel = \"cpu\"\n",
            "a fault of an encoder is in no channel here",
        ),
        (
            "[[expect]]\naxis = \"X\"\nchannel = \"nck\"\nstop = \"SS1\"\n",
            "remove channel: there is one only",
        ),
        (
            "[[motion]]\nat = \"0 s\"\naxis = \"X\"\nspeed = \"50 % of SG1\"\n",
            "120 % of VMAX_RELEASE",
        ),
    ]);
    let folder = Folder::new("crane-others");
    // Nothing of a hoist is simulated for a machine tool.
    let file = folder.write(
        "tool.toml",
        "duration = \"1 s\"\n[[load]]\nat = \"0 s\"\naxis = \"X\"\nload = 5000\n",
    );
    let output = simulate("spec/machines/milling-840d.toml", &file, &[]);
    assert_eq!(status(&output), 2);
    let message = "nothing of the kind is simulated for sinumerik-840d";
    assert!(messages(&output).contains(message), "{}", stderr(&output));
}

/// The whole text, with the diagram.
#[test]
fn the_brake_test_is_drawn() {
    let scenario = "spec/scenarios/srm-fblocks/weak-brake.toml";
    let output = stillpoint(&["simulate", CRANE, "--scenario", scenario]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    insta::assert_snapshot!(stdout(&output));
}
