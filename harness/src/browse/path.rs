//! A walk as text, short enough for a link.
//!
//! The first part chooses the initial state, each further one makes a cycle; they stand between dots. A part lists the values
//! of the choices in the order in which the step reads them, each as its distance from the least value: `0` to `9`, `a` to `z`
//! for 10 to 35, `(36)` and so on beyond; zeros at its end may be missing. `!3=1` after them gives a value to input number 3,
//! which the step does not read but a property may. `*12` at the end repeats the part. So `0.0*5.01` is a walk of six cycles.

use std::fmt::{self, Display};

/// Cycles a walk may have.
pub const MOST_CYCLES: usize = 10_000;
/// Choices that one cycle may list.
const MOST_CHOICES: usize = 10_000;

/// The choices of one cycle.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Choice {
    /// Distances from the least value, in the order of reading; what is missing is 0.
    pub values: Vec<u32>,
    /// Inputs that the step does not read: (number, distance from the least value).
    pub also: Vec<(u32, u32)>,
}

impl Choice {
    /// The choice with these values, without the zeros at their end.
    pub fn new(mut values: Vec<u32>, also: Vec<(u32, u32)>) -> Self {
        while values.last() == Some(&0) {
            values.pop();
        }
        Self { values, also }
    }
}

/// A walk: the choice of the initial state, then one of each cycle.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Path {
    /// Chooses the initial state.
    pub initial: Choice,
    /// Makes the cycles.
    pub steps: Vec<Choice>,
}

impl Path {
    /// Reads a path.
    ///
    /// # Errors
    /// A sentence that names the part that is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut all = Vec::new();
        for (number, part) in text.split('.').enumerate() {
            let wrong =
                |what: String| format!("part {number} of the path, `{}`: {what}", cut(part));
            let (choice, times) = match part.split_once('*') {
                Some((choice, times)) => {
                    let times = times.parse::<usize>().ok().filter(|n| *n > 0);
                    (
                        choice,
                        times.ok_or_else(|| wrong("`*` takes a number from 1".to_owned()))?,
                    )
                }
                None => (part, 1),
            };
            if number == 0 && times > 1 {
                return Err(wrong("the initial state is chosen once".to_owned()));
            }
            if all.len() + times > MOST_CYCLES + 1 {
                return Err(format!("the path has more than {MOST_CYCLES} cycles"));
            }
            let choice = choice_of(choice).map_err(wrong)?;
            all.extend(std::iter::repeat_n(choice, times));
        }
        let mut all = all.into_iter();
        Ok(Self {
            initial: all.next().unwrap_or_default(),
            steps: all.collect(),
        })
    }
}

/// The start of a text that may be long.
fn cut(text: &str) -> String {
    text.chars().take(40).collect()
}

fn choice_of(text: &str) -> Result<Choice, String> {
    let (listed, also) = match text.split_once('!') {
        Some((listed, also)) => (listed, also.split('!').collect()),
        None => (text, Vec::new()),
    };
    let mut values = Vec::new();
    let mut rest = listed.chars();
    while let Some(c) = rest.next() {
        let value = match c {
            '(' => {
                let (number, after) = rest
                    .as_str()
                    .split_once(')')
                    .ok_or_else(|| "`(` without `)`".to_owned())?;
                rest = after.chars();
                number
                    .parse()
                    .map_err(|_| format!("`({})` is no number", cut(number)))?
            }
            '0'..='9' | 'a'..='z' => c.to_digit(36).unwrap_or_default(),
            other => {
                return Err(format!(
                    "`{}` is no value; values are 0 to 9, a to z and (36) and so on",
                    other.escape_default()
                ));
            }
        };
        values.push(value);
        if values.len() > MOST_CHOICES {
            return Err(format!("more than {MOST_CHOICES} choices in one cycle"));
        }
    }
    let pair = |text: &str| {
        let (input, value) = text.split_once('=')?;
        Some((input.parse().ok()?, value.parse().ok()?))
    };
    let also = also.into_iter().map(|one: &str| {
        pair(one).ok_or_else(|| format!("`!{}` is not an input, `=` and a value", cut(one)))
    });
    let also: Vec<(u32, u32)> = also.collect::<Result<_, _>>()?;
    if also.len() > MOST_CHOICES {
        return Err(format!("more than {MOST_CHOICES} choices in one cycle"));
    }
    Ok(Choice::new(values, also))
}

impl Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.values.is_empty() {
            f.write_str("0")?;
        }
        for value in &self.values {
            match char::from_digit(*value, 36) {
                Some(digit) if *value < 36 => write!(f, "{digit}")?,
                _ => write!(f, "({value})")?,
            }
        }
        self.also
            .iter()
            .try_for_each(|(input, value)| write!(f, "!{input}={value}"))
    }
}

impl Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.initial)?;
        for equal in self.steps.chunk_by(|a, b| a == b) {
            if let Some(first) = equal.first() {
                write!(f, ".{first}")?;
            }
            if equal.len() > 1 {
                write!(f, "*{}", equal.len())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_written_as_short_as_they_can_be_read() {
        for (given, written) in [
            ("", "0"),
            ("0", "0"),
            ("000", "0"),
            (".", "0.0"),
            ("1.0.0.0", "1.0*3"),
            ("0.12z(36)0.0*2.00", "0.12z(36).0*3"),
            ("0.1!3=1!70=400.1", "0.1!3=1!70=400.1"),
        ] {
            let path = Path::parse(given).expect(given);
            assert_eq!(path.to_string(), written);
            assert_eq!(Path::parse(written), Ok(path));
        }
    }

    #[test]
    fn a_wrong_path_is_told_by_its_part() {
        for (given, part, what) in [
            ("0.1.-", "part 2", "is no value"),
            ("0.(12", "part 1", "without"),
            ("0.(x)", "part 1", "is no number"),
            ("0.(99999999999)", "part 1", "is no number"),
            ("0.1*0", "part 1", "from 1"),
            ("0.1*", "part 1", "from 1"),
            ("0*2", "part 0", "once"),
            ("0.1!2", "part 1", "an input"),
            ("0.1!2=x", "part 1", "an input"),
            ("0.<script>", "part 1", "is no value"),
            ("0.Ä", "part 1", "is no value"),
        ] {
            let told = Path::parse(given).expect_err(given);
            assert!(told.contains(part) && told.contains(what), "{told}");
        }
        for given in [
            format!("0.0*{}", MOST_CYCLES + 1),
            "0.0*9999999999999999".to_owned(),
        ] {
            assert!(Path::parse(&given).is_err_and(|e| e.contains("more than 10000 cycles")));
        }
    }
}
