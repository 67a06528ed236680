//! `stillpoint diff` of the machines that ship.

use crate::common::{status, stderr, stillpoint};

/// Every one of them can be compared: its values fit the tables of all its monitors.
#[test]
fn machines_that_ship_are_compared() {
    for path in stillpoint_tests::files("spec/machines", "toml") {
        let file = path.to_str().expect("UTF-8");
        let output = stillpoint(&["diff", file, "--random", "1000"]);
        assert_eq!(status(&output), 0, "{file}: {}", stderr(&output));
    }
}
