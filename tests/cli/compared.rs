//! `stillpoint diff` of the machines that ship.

use crate::common::{root, status, stderr, stillpoint};

/// Every one of them can be compared: its values fit the tables of all its monitors.
#[test]
fn machines_that_ship_are_compared() {
    for path in stillpoint_tests::files("spec/machines", "toml") {
        let file = path.strip_prefix(root()).unwrap_or(&path);
        let output = stillpoint(&["diff", &file.to_string_lossy(), "--random", "1000"]);
        assert_eq!(
            status(&output),
            0,
            "{}: {}",
            file.display(),
            stderr(&output)
        );
    }
}
