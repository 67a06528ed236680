//! Netlists in the AIGER format (version 1.9), with the table of symbols.

use std::fmt::Write as _;

use super::graph::{Graph, Lit, Node};
use super::netlist::Netlist;

/// What is written beside the netlist.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// What must not happen, with its name.
    pub bad: Vec<(String, Lit)>,
    /// What is to be seen, with its name.
    pub outputs: Vec<(String, Lit)>,
    /// Lines of comment.
    pub comment: Vec<String>,
}

/// The netlist as ASCII text (`aag`), or in the binary form (`aig`).
///
/// Conditions on the inputs become constraints. So do those on the start and the invariants of latches without a start value: they
/// hold in every cycle where a latch tells the first one, which is there for the start alone and only if it is needed.
pub fn aiger(netlist: &Netlist, marks: &Marks, binary: bool) -> Vec<u8> {
    let mut file = File::new(netlist);
    let constraints: Vec<Lit> = (netlist.assumed.iter())
        .chain(&netlist.invariants)
        .copied()
        .chain(file.begin.clone())
        .filter(|lit| *lit != Lit::TRUE)
        .collect();
    let roots = marks.bad.iter().chain(&marks.outputs).map(|(_, lit)| *lit);
    let next = file.latches.iter().map(|(_, _, _, next)| *next);
    let needed = file.graph.below(
        roots
            .chain(next)
            .chain(constraints.iter().copied())
            .collect::<Vec<_>>(),
    );
    file.number(&needed);
    file.write(marks, &constraints, binary)
}

struct File<'a> {
    netlist: &'a Netlist,
    graph: Graph,
    /// Name, variable, start value, next value.
    latches: Vec<(String, Lit, Option<bool>, Lit)>,
    /// The conditions on the start, tied to the first cycle.
    begin: Vec<Lit>,
    /// The code of each node; those of conjunctions rise.
    codes: Vec<u32>,
    /// The conjunctions, in the order of their codes.
    ands: Vec<usize>,
}

impl<'a> File<'a> {
    fn new(netlist: &'a Netlist) -> Self {
        let mut graph = netlist.graph.clone();
        let mut latches: Vec<_> = (netlist.latches.iter())
            .map(|l| (l.name.clone(), l.lit, l.init, l.next))
            .collect();
        let mut begin = Vec::new();
        // What holds in every cycle need not be said of the first.
        let first = |lit: &&Lit| **lit != Lit::TRUE && !netlist.invariants.contains(lit);
        let first: Vec<Lit> = netlist.start.iter().filter(first).copied().collect();
        if !first.is_empty() {
            // FALSE in the first cycle, TRUE in all others.
            let later = graph.leaf();
            latches.push(("later".to_owned(), later, Some(false), Lit::TRUE));
            for lit in first {
                begin.push(graph.or(later, lit));
            }
        }
        File {
            netlist,
            graph,
            latches,
            begin,
            codes: Vec::new(),
            ands: Vec::new(),
        }
    }

    fn number(&mut self, needed: &[bool]) {
        self.codes = vec![0; self.graph.size()];
        let inputs = self.netlist.inputs.iter().map(|i| i.lit);
        let mut last = 0;
        for lit in inputs.chain(self.latches.iter().map(|l| l.1)) {
            last += 1;
            self.codes[lit.node()] = last << 1;
        }
        for (node, needed) in needed.iter().enumerate() {
            if *needed && matches!(self.graph.node(node), Node::And(..)) {
                last += 1;
                self.codes[node] = last << 1;
                self.ands.push(node);
            }
        }
    }

    fn code(&self, lit: Lit) -> u32 {
        self.codes[lit.node()] | (lit.code() & 1)
    }

    fn write(&self, marks: &Marks, constraints: &[Lit], binary: bool) -> Vec<u8> {
        let inputs = &self.netlist.inputs;
        let variables = inputs.len() + self.latches.len() + self.ands.len();
        let mut text = format!(
            "{} {variables} {} {} {} {} {} {}\n",
            if binary { "aig" } else { "aag" },
            inputs.len(),
            self.latches.len(),
            marks.outputs.len(),
            self.ands.len(),
            marks.bad.len(),
            constraints.len(),
        );
        let mut line = |line: String| {
            text.push_str(&line);
            text.push('\n');
        };
        if !binary {
            for input in inputs {
                line(self.code(input.lit).to_string());
            }
        }
        for (_, lit, init, next) in &self.latches {
            let (own, next) = (self.code(*lit), self.code(*next));
            let init = match init {
                Some(false) => String::new(),
                Some(true) => " 1".to_owned(),
                None => format!(" {own}"),
            };
            line(match binary {
                true => format!("{next}{init}"),
                false => format!("{own} {next}{init}"),
            });
        }
        for lit in marks.outputs.iter().map(|(_, lit)| lit) {
            line(self.code(*lit).to_string());
        }
        for lit in marks.bad.iter().map(|(_, lit)| lit).chain(constraints) {
            line(self.code(*lit).to_string());
        }
        let mut out = text.into_bytes();
        for node in &self.ands {
            let Node::And(a, b) = self.graph.node(*node) else {
                continue;
            };
            let own = self.codes[*node];
            let (a, b) = (self.code(a), self.code(b));
            let (most, least) = (a.max(b), a.min(b));
            if binary {
                difference(own - most, &mut out);
                difference(most - least, &mut out);
            } else {
                out.extend(format!("{own} {most} {least}\n").bytes());
            }
        }
        out.extend(self.symbols(marks).bytes());
        out
    }

    fn symbols(&self, marks: &Marks) -> String {
        let mut text = String::new();
        let names = self.netlist.inputs.iter().map(|i| &i.name);
        symbols(&mut text, 'i', names);
        symbols(&mut text, 'l', self.latches.iter().map(|l| &l.0));
        symbols(&mut text, 'o', marks.outputs.iter().map(|(name, _)| name));
        symbols(&mut text, 'b', marks.bad.iter().map(|(name, _)| name));
        if !marks.comment.is_empty() {
            text.push_str("c\n");
            for line in &marks.comment {
                text.push_str(line);
                text.push('\n');
            }
        }
        text
    }
}

fn symbols<'a>(text: &mut String, kind: char, names: impl Iterator<Item = &'a String>) {
    for (k, name) in names.enumerate() {
        let _ = writeln!(text, "{kind}{k} {name}");
    }
}

/// A difference of codes in the binary form: seven bits a byte, the least first.
fn difference(value: u32, out: &mut Vec<u8>) {
    let mut rest = value;
    while rest > 0x7f {
        out.push((rest & 0x7f) as u8 | 0x80);
        rest >>= 7;
    }
    out.push(rest as u8);
}
