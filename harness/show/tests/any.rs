//! Any diagram and any graph can be shown, the same way each time.

use proptest::prelude::*;
use stillpoint_show::diagram::{Curve, Diagram, Lane, Mark, Panel, Role};
use stillpoint_show::document::{Block, Document};
use stillpoint_show::graph::{Edge, Graph, Node};

fn value() -> impl Strategy<Value = Option<String>> {
    prop_oneof![
        Just(None),
        Just(Some("TRUE".to_owned())),
        Just(Some("FALSE".to_owned())),
        (-3_i64..3).prop_map(|v| Some(v.to_string())),
        "[<>&\"|` A-Z_]{0,20}".prop_map(Some),
    ]
}

fn lane(columns: usize) -> impl Strategy<Value = Lane> {
    let values = prop::collection::vec(value(), 0..columns + 2);
    ("[a-h.<&]{0,40}", any::<bool>(), values).prop_map(|(name, level, values)| Lane {
        group: name.chars().take(2).collect(),
        name,
        level,
        values,
    })
}

fn panel(columns: usize) -> impl Strategy<Value = Panel> {
    let number = prop_oneof![
        Just(None),
        (-1e4..1e4).prop_map(Some),
        any::<f64>().prop_map(Some)
    ];
    let role = prop_oneof![
        Just(Role::Actual),
        Just(Role::Wanted),
        Just(Role::Upper),
        Just(Role::Lower)
    ];
    let curve = (
        "[a-h]{0,30}",
        role,
        prop::collection::vec(number, 0..columns + 2),
    );
    let curve = curve.prop_map(|(name, role, values)| Curve { name, role, values });
    (
        "[a-h]{0,30}",
        "[a-h/]{0,6}",
        prop::collection::vec(curve, 0..6),
    )
        .prop_map(|(name, unit, curves)| Panel { name, unit, curves })
}

fn diagram() -> impl Strategy<Value = Diagram> {
    (0_usize..120).prop_flat_map(|columns| {
        let mark = (0..columns + 2, "[a-h<& ]{0,200}", any::<bool>());
        let mark = mark.prop_map(|(column, text, fault)| Mark {
            column,
            text,
            fault,
        });
        (
            "[a-h<& ]{0,30}",
            prop::option::of(1_u64..50_000),
            prop::collection::vec(panel(columns), 0..3),
            prop::collection::vec(lane(columns), 0..6),
            prop::collection::vec(mark, 0..4),
            prop::option::of(0..columns + 2),
        )
            .prop_map(
                move |(title, cycle, panels, lanes, marks, loop_start)| Diagram {
                    title,
                    columns,
                    cycle,
                    panels,
                    lanes,
                    marks,
                    loop_start,
                },
            )
    })
}

fn graph() -> impl Strategy<Value = Graph> {
    (0_usize..14).prop_flat_map(|count| {
        let node = ("[A-Z<&\n]{0,12}", any::<bool>(), any::<bool>());
        let node = node.prop_map(|(label, reached, initial)| Node {
            label,
            note: String::new(),
            reached,
            initial,
        });
        // An edge may name a node that does not exist.
        let end = 0..count + 1;
        let labels = prop::collection::vec("[a-h<& ]{0,40}", 0..5);
        let edge = (end.clone(), end, labels);
        let edge = edge.prop_map(|(from, to, labels)| Edge { from, to, labels });
        (
            prop::collection::vec(node, count),
            prop::collection::vec(edge, 0..count * 2 + 1),
        )
            .prop_map(|(nodes, edges)| Graph {
                title: "any".to_owned(),
                nodes,
                edges,
            })
    })
}

/// Whether each tag of a picture is closed in its turn, and nothing but entities follows an ampersand.
fn well_formed(svg: &str) -> Result<(), String> {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let end = rest[start..].find('>').ok_or("a tag without end")? + start;
        let tag = &rest[start + 1..end];
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name) {
                return Err(format!("</{name}> closes nothing"));
            }
        } else if !tag.ends_with('/') {
            open.push(tag.split([' ', '\n']).next().unwrap_or(tag));
        }
        rest = &rest[end + 1..];
    }
    for part in svg.split('&').skip(1) {
        let entity = part.split(';').next().unwrap_or(part);
        if !["amp", "lt", "gt", "quot", "#39"].contains(&entity) {
            return Err(format!("&{entity}"));
        }
    }
    if open.is_empty() {
        Ok(())
    } else {
        Err(format!("{open:?} stay open"))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn diagrams(diagram in diagram()) {
        let svg = diagram.svg();
        prop_assert_eq!(well_formed(&svg), Ok(()));
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", svg);
        prop_assert_eq!(svg, diagram.clone().svg());
        prop_assert_eq!(diagram.text(), diagram.clone().text());
        // Every remark at a column is told, in the text and in the picture.
        for mark in diagram.marks.iter().filter(|m| m.column < diagram.columns) {
            prop_assert!(diagram.text().contains(mark.text.trim_end()));
            let told = format!("cycle {}", mark.column);
            prop_assert!(diagram.svg().contains(&told));
        }
    }

    #[test]
    fn graphs(graph in graph()) {
        let svg = graph.svg();
        prop_assert_eq!(well_formed(&svg), Ok(()));
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", svg);
        prop_assert_eq!(svg.matches("class=\"node").count(), graph.nodes.len());
        prop_assert_eq!(svg, graph.clone().svg());
        let document = Document {
            title: "any".to_owned(),
            subtitle: String::new(),
            blocks: vec![Block::Graph(Box::new(graph))],
        };
        prop_assert_eq!(document.html(), document.clone().html());
        prop_assert_eq!(document.markdown(), document.clone().markdown());
    }
}
