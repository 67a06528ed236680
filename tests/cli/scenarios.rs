//! What the tests of the scenarios of a family share.

use std::process::Output;

use crate::common::{Folder, messages, root, status, stderr, stdout, stillpoint};

/// The machine of a family and the folder of its scenarios.
pub struct Scenarios {
    pub machine: &'static str,
    pub family: &'static str,
}

impl Scenarios {
    /// Runs a scenario on the machine.
    pub fn simulate(&self, scenario: &str, more: &[&str]) -> Output {
        simulate(self.machine, scenario, more)
    }

    /// The path of a scenario of the family.
    pub fn path(&self, name: &str) -> String {
        let path = root().join("spec/scenarios").join(self.family).join(name);
        path.to_str().expect("UTF-8").to_owned()
    }

    /// Every scenario holds, and its recording is what the monitors say when they are given its inputs again. How many there are.
    pub fn hold_and_are_replayed(&self) -> usize {
        let folder = Folder::new(&format!("{}-scenarios", self.family));
        let all = std::fs::read_dir(root().join("spec/scenarios").join(self.family));
        let mut run = 0;
        for entry in all.expect("readable") {
            let path = entry.expect("readable").path();
            let trace = folder.file("trace.ndjson");
            let output = self.simulate(path.to_str().expect("UTF-8"), &["--trace", &trace]);
            let said = stdout(&output);
            assert_eq!(status(&output), 0, "{path:?}: {said}{}", stderr(&output));
            assert!(said.contains("holds") && !said.contains("FAILS"), "{said}");
            let output = stillpoint(&["diff", self.machine, "--trace", &trace]);
            let said = stdout(&output);
            assert_eq!(status(&output), 0, "{path:?}: {said}{}", stderr(&output));
            assert!(said.starts_with("NO DIVERGENCE"), "{said}");
            run += 1;
        }
        run
    }

    /// Each thing that a scenario depends on, as the name of the scenario, what stands there, what takes its place, and the
    /// expectation that then fails.
    pub fn can_fail(&self, cases: &[[&str; 4]]) {
        // Several tests of a family run at once.
        let first = cases.first().map_or("", |case| case[0]);
        let folder = Folder::new(&format!("{}-fails-{first}", self.family));
        for [name, from, to, fails] in cases {
            let text = std::fs::read_to_string(self.path(name)).expect("readable");
            assert!(text.contains(from), "{name}: {from}");
            let file = folder.write(name, &text.replacen(from, to, 1));
            let output = self.simulate(&file, &[]);
            let text = stdout(&output);
            let code = status(&output);
            assert_eq!(code, 1, "{name}, {to}: {text}{}", stderr(&output));
            let mut failed = text.lines().filter(|l| l.starts_with("FAILS"));
            assert!(failed.any(|l| l.contains(fails)), "{name}, {to}: {text}");
        }
    }

    /// The replay of a scenario finds an output that is recorded otherwise: `to`, put behind `from`, and what is said of it.
    pub fn a_change_diverges(&self, name: &str, [from, to, says]: [&str; 3]) {
        let folder = Folder::new(&format!("{}-changed", self.family));
        let trace = folder.file("trace.ndjson");
        let output = self.simulate(&self.path(name), &["--trace", &trace]);
        assert_eq!(status(&output), 0, "{}", stderr(&output));
        let text = std::fs::read_to_string(&trace).expect("written");
        assert!(text.contains(from), "{text}");
        let changed = text.replacen(from, &format!("{from}{to}"), 1);
        let file = folder.write("changed.ndjson", &changed);
        let output = stillpoint(&["diff", self.machine, "--trace", &file]);
        let said = stdout(&output);
        assert_eq!(status(&output), 1, "{said}{}", stderr(&output));
        assert!(said.contains(says), "{said}");
    }

    /// A scenario of a second with this in it is bad input, and the message says why.
    pub fn are_refused(&self, cases: &[(&str, &str)]) {
        let folder = Folder::new(&format!("{}-mistakes", self.family));
        for (scenario, message) in cases {
            let file = folder.write("m.toml", &format!("duration = \"1 s\"\n{scenario}"));
            let output = self.simulate(&file, &[]);
            assert_eq!(status(&output), 2, "{scenario}{}", stdout(&output));
            assert!(messages(&output).contains(message), "{}", stderr(&output));
        }
    }
}

/// Runs a scenario, without its diagram.
pub fn simulate(machine: &str, scenario: &str, more: &[&str]) -> Output {
    let arguments = ["simulate", machine, "--scenario", scenario, "--brief"];
    stillpoint(&[&arguments, more].concat())
}
