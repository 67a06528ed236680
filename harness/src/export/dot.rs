//! The control states of each machine of a system, for Graphviz: the pictures of the reports without their limit.
//!
//! A node is a combination of values of the machine's variables that have an enum as type; an edge names the rules that lead
//! from the one to the other in some reachable cycle. Cycles that stay in a node are not drawn. A machine without such
//! variables has no graph.

use std::fmt::Write;

use stillpoint_lang::bind::Bound;
use stillpoint_model::{Error, Options};
use stillpoint_show::graph::Graph;

use crate::states::{Budget, control_states};

/// The graphs of all machines of a system as one Graphviz digraph.
///
/// # Errors
/// A system that cannot be explored.
pub fn dot(bound: &Bound, title: &str, options: &Options) -> Result<String, Error> {
    let mut out = String::new();
    let _ = writeln!(out, "// {}", title.replace('\n', " "));
    let _ = writeln!(out, "digraph {} {{", quoted(&bound.system.name));
    out.push_str("  node [shape=box, style=rounded];\n");
    match control_states(bound, Budget::UNLIMITED, options)? {
        None => out.push_str("  // A limit was reached before every reachable cycle was seen.\n"),
        Some(graphs) => {
            for (n, (_, graph)) in graphs.iter().enumerate() {
                cluster(&mut out, n, graph);
            }
        }
    }
    out.push_str("}\n");
    Ok(out)
}

fn cluster(out: &mut String, n: usize, graph: &Graph) {
    let _ = writeln!(out, "  subgraph cluster_{n} {{");
    let _ = writeln!(out, "    label={};", quoted(&graph.title));
    for (k, node) in graph.nodes.iter().enumerate() {
        let look = match (node.initial, node.reached) {
            (true, _) => ", penwidth=2.5",
            (false, true) => "",
            (false, false) => ", style=\"rounded,dashed\"",
        };
        let _ = writeln!(out, "    m{n}_{k} [label={}{look}];", quoted(&node.label));
    }
    for edge in graph.edges.iter().filter(|e| e.from != e.to) {
        let rules = quoted(&edge.labels.join("\n"));
        let _ = writeln!(
            out,
            "    m{n}_{} -> m{n}_{} [label={rules}];",
            edge.from, edge.to
        );
    }
    out.push_str("  }\n");
}

fn quoted(text: &str) -> String {
    format!(
        "\"{}\"",
        text.replace('\\', "\\\\")
            .replace('"', "\\\"")
            .replace('\n', "\\n")
    )
}
