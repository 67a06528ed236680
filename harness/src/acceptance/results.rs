//! The results on the simulated axis, as a part of the protocol.

use stillpoint_machine::acceptance::Test;
use stillpoint_show::document::{Block, Inline, Tone};

use super::document::anchor;
use super::{Ran, on_the_machine};

/// What the tests gave on the simulated axis: the result, and the section with the details.
pub(super) fn results(ran: &[Ran], tests: &[&Test]) -> (Block, Block) {
    let bad = ran.iter().filter(|r| !r.holds).count();
    let (tone, head) = match bad {
        0 if ran.is_empty() => (Tone::Open, "No test was simulated".to_owned()),
        0 => (
            Tone::Good,
            "Every simulated test gives what is expected".to_owned(),
        ),
        1 => (
            Tone::Bad,
            "1 simulated test does not give what is expected".to_owned(),
        ),
        n => (
            Tone::Bad,
            format!("{n} simulated tests do not give what is expected"),
        ),
    };
    let not = on_the_machine(tests);
    let about = format!(
        "{} of {} tests were run on the production monitors of both channels with a simple axis; {} were not, each for its reason. This shows that configuration and monitors fit the test; it is no test of the machine. ",
        ran.len(),
        tests.len(),
        not.len()
    );
    let link = |id: &str| Inline::Link {
        text: id.to_owned(),
        to: format!("#{}", anchor(id)),
    };
    let rows = ran.iter().map(|r| {
        let (tone, word) = word(r.holds);
        let title = tests.iter().find(|test| test.id == r.id);
        let good = r.judged.iter().filter(|(_, holds, _)| *holds).count();
        vec![
            vec![link(&r.id)],
            vec![Inline::text(title.map_or("", |test| &test.title))],
            vec![Inline::Badge(tone, word.to_owned())],
            vec![Inline::Text(format!("{good} of {}", r.judged.len()))],
        ]
    });
    let heads = ["Test", "What is tested", "Result", "Expectations that hold"];
    let mut blocks = vec![Block::table(&heads, rows)];
    blocks.extend(ran.iter().map(details));
    if !not.is_empty() {
        let rows = not.into_iter();
        let rows = rows.map(|(id, reason)| vec![vec![link(id)], vec![Inline::text(reason)]]);
        let heads = ["Test", "Not simulated, because"];
        blocks.push(Block::table(&heads, rows));
    }
    let verdict = Block::Verdict {
        tone,
        head,
        text: vec![
            Inline::Text(about),
            Inline::Link {
                text: "Results".to_owned(),
                to: "#simulated".to_owned(),
            },
        ],
    };
    let section = Block::Section {
        title: "On the simulated axis".to_owned(),
        anchor: "simulated".to_owned(),
        blocks,
    };
    (verdict, section)
}

fn word(holds: bool) -> (Tone, &'static str) {
    match holds {
        true => (Tone::Good, "as expected"),
        false => (Tone::Bad, "not as expected"),
    }
}

/// Each expectation of a test with its cycle, the stops, and where something is not as expected the run: the diagrams of all
/// tests would bury the protocol.
fn details(r: &Ran) -> Block {
    let rows = r.judged.iter().map(|(expected, holds, cycle)| {
        let (tone, word) = word(*holds);
        let cycle = cycle.map_or(String::new(), |cycle| cycle.to_string());
        vec![
            vec![Inline::text(expected)],
            vec![Inline::Text(cycle)],
            vec![Inline::Badge(tone, word.to_owned())],
        ]
    });
    let heads = ["Expected", "In cycle", ""];
    let mut blocks = vec![Block::table(&heads, rows)];
    if !r.stops.is_empty() {
        let stops = r.stops.iter().map(|stop| vec![Inline::text(stop)]);
        blocks.push(Block::List(stops.collect()));
    }
    if r.holds {
        return Block::Details {
            summary: vec![Inline::text(&r.id)],
            blocks,
        };
    }
    blocks.push(Block::Timing(Box::new(r.diagram.clone())));
    Block::Section {
        title: r.id.clone(),
        anchor: format!("simulated-{}", anchor(&r.id)),
        blocks,
    }
}
