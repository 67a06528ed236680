//! Names of cells as identifiers of another language.

use std::collections::BTreeSet;

/// Gives identifiers, each once.
#[derive(Default)]
pub struct Names {
    used: BTreeSet<String>,
}

impl Names {
    /// An identifier for `name` that starts with `prefix`: letters and digits kept, the rest one underscore each run.
    pub fn give(&mut self, prefix: &str, name: &str) -> String {
        let mut plain = prefix.to_owned();
        for c in name.chars() {
            if c.is_ascii_alphanumeric() {
                plain.push(c);
            } else if !plain.ends_with('_') {
                plain.push('_');
            }
        }
        let plain = plain.trim_end_matches('_').to_owned();
        let mut given = plain.clone();
        let mut n = 1;
        while !self.used.insert(given.clone()) {
            n += 1;
            given = format!("{plain}__{n}");
        }
        given
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_unique() {
        let mut names = Names::default();
        assert_eq!(names.give("s_", "stop[1].level"), "s_stop_1_level");
        assert_eq!(names.give("s_", "stop_1.level"), "s_stop_1_level__2");
        assert_eq!(names.give("s_", "limit[0]"), "s_limit_0");
    }
}
