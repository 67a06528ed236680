//! The control-state graph of each machine of a system, for Graphviz.
//!
//! A node is a combination of values of the machine's enum-typed state variables that occurs in a reachable state; an edge
//! is labelled with the number of transitions (input combinations over all reachable states) that lead from the one to the
//! other. Transitions that stay in a node are not drawn. A machine without such variables has no graph.

use std::fmt::Write;

use stillpoint_model::table::{Generated, Interpreted};
use stillpoint_model::{ControlGraph, Error, Options, control_graph};
use stillpoint_spec::bind::Bound;
use stillpoint_spec::ir::{Instance, Ty};

use crate::report::grouped;

/// The graphs of all machines of a system as one Graphviz digraph.
///
/// # Errors
/// A system that cannot be explored.
pub fn dot(bound: &Bound, title: &str, options: &Options) -> Result<String, Error> {
    let system = &bound.system;
    let mut out = String::new();
    let _ = writeln!(out, "// {}", title.replace('\n', " "));
    let _ = writeln!(
        out,
        "// Edges are labelled with numbers of transitions; those that stay in a node are not drawn."
    );
    let _ = writeln!(out, "digraph {} {{", quoted(&system.name));
    out.push_str("  node [shape=box, style=rounded];\n");
    for (n, instance) in system.instances.iter().enumerate() {
        let cells: Vec<usize> = (instance.states.start as usize..instance.states.end as usize)
            .filter(|k| matches!(system.states[*k].var.ty, Ty::Enum(_)))
            .collect();
        if cells.is_empty() {
            let _ = writeln!(out, "  // {} has no enum-typed state.", instance.name);
            continue;
        }
        let project = |state: &[i32]| -> Vec<i32> { cells.iter().map(|k| state[*k]).collect() };
        let graph = match Generated::find(bound) {
            Some(generated) => control_graph(&generated, options, project)?,
            None => control_graph(&Interpreted::new(bound), options, project)?,
        };
        cluster(&mut out, bound, n, instance, &cells, &graph);
    }
    out.push_str("}\n");
    Ok(out)
}

fn cluster(
    out: &mut String,
    bound: &Bound,
    n: usize,
    instance: &Instance,
    cells: &[usize],
    graph: &ControlGraph<Vec<i32>>,
) {
    let system = &bound.system;
    let names: Vec<&str> = cells
        .iter()
        .map(|k| system.states[*k].var.name.as_str())
        .collect();
    let limits = if graph.complete {
        ""
    } else {
        " (INCOMPLETE: a limit was reached)"
    };
    let _ = writeln!(out, "  subgraph cluster_{n} {{");
    let label = format!("{}: {}{limits}", instance.name, names.join(", "));
    let _ = writeln!(out, "    label={};", quoted(&label));
    for node in graph.graph.node_indices() {
        let values: Vec<String> = cells
            .iter()
            .zip(&graph.graph[node])
            .map(|(k, v)| system.show(system.states[*k].var.ty, i64::from(*v)))
            .collect();
        let start = if graph.initial.contains(&node) {
            ", penwidth=2.5"
        } else {
            ""
        };
        let _ = writeln!(
            out,
            "    m{n}_{} [label={}{start}];",
            node.index(),
            quoted(&values.join("\n"))
        );
    }
    for edge in graph.graph.edge_indices() {
        let Some((from, to)) = graph.graph.edge_endpoints(edge) else {
            continue;
        };
        if from != to {
            let count = quoted(&grouped(graph.graph[edge]));
            let _ = writeln!(
                out,
                "    m{n}_{} -> m{n}_{} [label={count}];",
                from.index(),
                to.index()
            );
        }
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
