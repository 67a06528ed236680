//! What a test expects, as a timing diagram.

use stillpoint_machine::acceptance::Test;
use stillpoint_show::diagram::{Diagram, Lane, Mark};

use super::latest;

/// Cycles shown before the event and after the last change.
const MARGIN: usize = 2;

/// The signals of a test, each changing at the latest cycle at which it may; none if the test names no signal with a time.
pub fn expected(test: &Test, cycle: i64) -> Option<Diagram> {
    let mut points: Vec<(usize, &str, &str)> = Vec::new();
    for expect in &test.expect {
        if let (Some((signal, value)), Some((_, cycles))) = (&expect.signal, latest(expect, cycle))
        {
            let at = usize::try_from(cycles).ok()? + MARGIN;
            points.push((at, signal, value));
        }
    }
    let last = points.iter().map(|p| p.0).max()?;
    let columns = last + MARGIN + 1;
    let mut lanes: Vec<Lane> = Vec::new();
    points.sort_by_key(|p| p.0);
    for (at, signal, value) in &points {
        let k = lanes.iter().position(|l| l.name == *signal);
        let k = k.unwrap_or_else(|| {
            lanes.push(Lane {
                group: "expected".to_owned(),
                name: (*signal).to_owned(),
                level: false,
                values: vec![Some(String::new()); columns],
            });
            lanes.len() - 1
        });
        for cell in lanes[k].values.iter_mut().skip(*at) {
            *cell = Some((*value).to_owned());
        }
    }
    let mut diagram = Diagram {
        columns,
        cycle: u64::try_from(cycle).ok(),
        ..Diagram::default()
    };
    for lane in &mut lanes {
        let known = lane.values.iter().flatten();
        lane.level = known
            .filter(|v| !v.is_empty())
            .all(|v| v == "TRUE" || v == "FALSE");
        for cell in &mut lane.values {
            let before = match (lane.level, cell.as_deref()) {
                (true, Some("")) => Some(opposite(&points, &lane.name)),
                (false, Some("")) => Some("none"),
                _ => None,
            };
            if let Some(before) = before {
                *cell = Some(before.to_owned());
            }
        }
    }
    diagram.lanes = lanes;
    diagram.marks.push(Mark {
        column: MARGIN,
        text: "the event".to_owned(),
        fault: false,
    });
    Some(diagram)
}

/// What a level is before its first change.
fn opposite<'a>(points: &[(usize, &'a str, &'a str)], signal: &str) -> &'a str {
    let first = points.iter().find(|p| p.1 == signal).map(|p| p.2);
    if first == Some("FALSE") {
        "TRUE"
    } else {
        "FALSE"
    }
}
