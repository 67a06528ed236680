//! Cells of arrays as readers want to see them: those next to each other of which the same is told, together.

/// Cells of which the same is told.
struct Alike {
    /// The name, of an array that without the index.
    name: String,
    /// The first and the last index; none: no array.
    indices: Option<(i64, i64)>,
    text: String,
}

/// Names with what is told of each, `t[1]`, `t[2]`, ...; cells of an array that follow each other with the same text become one, `t[1..2]`.
pub fn together(cells: impl IntoIterator<Item = (String, String)>) -> Vec<(String, String)> {
    let mut all: Vec<Alike> = Vec::new();
    for (name, text) in cells {
        let (name, index) = parts(&name);
        match all.last_mut() {
            Some(last) if last.is_before(name, index) && last.text == text => {
                last.indices = last.indices.map(|(first, next)| (first, next + 1));
            }
            _ => all.push(Alike {
                name: name.to_owned(),
                indices: index.map(|k| (k, k)),
                text,
            }),
        }
    }
    all.into_iter().map(Alike::shown).collect()
}

/// A name, of an array that without the index, and the index.
fn parts(name: &str) -> (&str, Option<i64>) {
    let split = name
        .strip_suffix(']')
        .and_then(|name| name.rsplit_once('['));
    match split.and_then(|(base, index)| Some((base, index.parse().ok()?))) {
        Some((base, index)) => (base, Some(index)),
        None => (name, None),
    }
}

impl Alike {
    /// Whether a cell follows these in their array.
    fn is_before(&self, name: &str, index: Option<i64>) -> bool {
        let next = self.indices.and_then(|(_, last)| last.checked_add(1));
        self.name == name && next.is_some() && next == index
    }

    fn shown(self) -> (String, String) {
        let name = match self.indices {
            None => self.name,
            Some((a, b)) if a == b => format!("{}[{a}]", self.name),
            Some((a, b)) => format!("{}[{a}..{b}]", self.name),
        };
        (name, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_which_the_same_is_told_are_told_once() {
        let told = |cells: &[(&str, &str)]| {
            let cells = cells
                .iter()
                .map(|(n, t)| ((*n).to_owned(), (*t).to_owned()));
            let told = together(cells);
            let told = told.iter().map(|(name, text)| format!("{name} {text}"));
            told.collect::<Vec<_>>().join(", ")
        };
        let cells = [
            ("a", "1"),
            ("a", "1"),
            ("b[1]", "1"),
            ("b[2]", "1"),
            ("b[3]", "2"),
        ];
        assert_eq!(told(&cells), "a 1, a 1, b[1..2] 1, b[3] 2");
        // Neither over a gap nor from one array to another.
        let cells = [
            ("b[1]", "1"),
            ("b[3]", "1"),
            ("c[4]", "1"),
            ("d[0]", "1"),
            ("d[-1]", "1"),
        ];
        assert_eq!(told(&cells), "b[1] 1, b[3] 1, c[4] 1, d[0] 1, d[-1] 1");
        assert_eq!(
            told(&[("m[1].t[2]", "x"), ("m[1].t[3]", "x"), ("m[2].t[4]", "x")]),
            "m[1].t[2..3] x, m[2].t[4] x"
        );
    }
}
