//! A reader and simulator of BTOR2, as far as exported systems use the format: one bit-vector sort for each width, no
//! arrays, widths of at most 64 bits.

use std::collections::HashMap;

/// A model: its nodes in the order of the file.
#[derive(Debug, Default)]
pub struct Model {
    nodes: Vec<Node>,
    /// Symbols of the inputs, with their node and width.
    pub inputs: Vec<Variable>,
    /// Symbols of the state variables, with their node and width.
    pub states: Vec<Variable>,
    /// Bad signals by symbol.
    pub bad: Vec<(String, usize)>,
    /// Outputs by symbol.
    pub outputs: Vec<(String, usize)>,
    constraints: Vec<usize>,
}

/// An input or state variable.
#[derive(Debug, Clone)]
pub struct Variable {
    /// Its symbol.
    pub symbol: String,
    /// Its width in bits.
    pub width: u32,
    node: usize,
    init: Option<usize>,
    next: Option<usize>,
}

#[derive(Debug)]
struct Node {
    width: u32,
    op: Op,
}

#[derive(Debug)]
enum Op {
    Variable,
    Constant(u64),
    /// What it does, operands, their width (of the last, where the first is a condition).
    Operator(Apply, Vec<usize>, u32),
    Extend(bool, usize),
    Slice(usize, u32),
}

/// The values of all nodes in one step.
#[derive(Debug, Default)]
pub struct Values(Vec<u64>);

/// Bits below `width`.
fn mask(width: u32) -> u64 {
    u64::MAX >> (64 - width)
}

/// A number as a bit-vector.
pub fn bits(value: i64, width: u32) -> u64 {
    value as u64 & mask(width)
}

fn signed(value: u64, width: u32) -> i64 {
    let shift = 64 - width;
    ((value << shift) as i64) >> shift
}

/// An operator: of its operands and their width.
type Apply = fn(&[u64], u32) -> u64;

/// An operator of the format.
struct Operator {
    word: &'static str,
    operands: usize,
    /// Whether the result has one bit; else it has the width of the operands.
    to_bit: bool,
    apply: Apply,
}

const fn plain(word: &'static str, operands: usize, apply: Apply) -> Operator {
    Operator {
        word,
        operands,
        to_bit: false,
        apply,
    }
}

const fn compares(word: &'static str, apply: Apply) -> Operator {
    Operator {
        word,
        operands: 2,
        to_bit: true,
        apply,
    }
}

const OPERATORS: [Operator; 22] = [
    plain("not", 1, |v, _| !v[0]),
    plain("neg", 1, |v, _| v[0].wrapping_neg()),
    plain("and", 2, |v, _| v[0] & v[1]),
    plain("or", 2, |v, _| v[0] | v[1]),
    plain("add", 2, |v, _| v[0].wrapping_add(v[1])),
    plain("sub", 2, |v, _| v[0].wrapping_sub(v[1])),
    plain("mul", 2, |v, _| v[0].wrapping_mul(v[1])),
    // A quotient by zero is all ones (1 for a negative signed dividend), the remainder then the dividend.
    plain("udiv", 2, |v, _| v[0].checked_div(v[1]).unwrap_or(u64::MAX)),
    plain("urem", 2, |v, _| v[0].checked_rem(v[1]).unwrap_or(v[0])),
    plain("sdiv", 2, |v, w| {
        let (a, b) = (signed(v[0], w), signed(v[1], w));
        match b {
            0 if a < 0 => 1,
            0 => u64::MAX,
            _ => a.wrapping_div(b) as u64,
        }
    }),
    plain("srem", 2, |v, w| {
        let (a, b) = (signed(v[0], w), signed(v[1], w));
        if b == 0 {
            v[0]
        } else {
            a.wrapping_rem(b) as u64
        }
    }),
    plain("ite", 3, |v, _| if v[0] == 1 { v[1] } else { v[2] }),
    compares("eq", |v, _| u64::from(v[0] == v[1])),
    compares("neq", |v, _| u64::from(v[0] != v[1])),
    compares("ult", |v, _| u64::from(v[0] < v[1])),
    compares("ulte", |v, _| u64::from(v[0] <= v[1])),
    compares("ugt", |v, _| u64::from(v[0] > v[1])),
    compares("ugte", |v, _| u64::from(v[0] >= v[1])),
    compares("slt", |v, w| u64::from(signed(v[0], w) < signed(v[1], w))),
    compares("slte", |v, w| u64::from(signed(v[0], w) <= signed(v[1], w))),
    compares("sgt", |v, w| u64::from(signed(v[0], w) > signed(v[1], w))),
    compares("sgte", |v, w| u64::from(signed(v[0], w) >= signed(v[1], w))),
];

struct Reader {
    model: Model,
    sorts: HashMap<usize, u32>,
    /// Node by line number.
    lines: HashMap<usize, usize>,
    last: usize,
}

impl Model {
    /// Reads a model.
    ///
    /// # Errors
    /// The first line that is not as the format or this reader wants it.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader {
            model: Model::default(),
            sorts: HashMap::new(),
            lines: HashMap::new(),
            last: 0,
        };
        for line in text.lines() {
            if !line.starts_with(';') {
                reader.line(line).map_err(|e| format!("`{line}`: {e}"))?;
            }
        }
        Ok(reader.model)
    }

    /// The start value of a state variable, if the model fixes it.
    pub fn initial(&self, variable: &Variable) -> Option<u64> {
        variable.init.map(|node| match self.nodes[node].op {
            Op::Constant(v) => v,
            _ => 0,
        })
    }

    /// Evaluates a step with these values of the state variables and inputs, in the order of `states` and `inputs`.
    pub fn evaluate(&self, values: &mut Values, states: &[u64], inputs: &[u64]) {
        values.0.clear();
        values.0.resize(self.nodes.len(), 0);
        let variables = self.states.iter().zip(states);
        for (variable, value) in variables.chain(self.inputs.iter().zip(inputs)) {
            values.0[variable.node] = value & mask(variable.width);
        }
        for (k, node) in self.nodes.iter().enumerate() {
            let value = match &node.op {
                Op::Variable => continue,
                Op::Constant(v) => *v,
                Op::Extend(true, a) => signed(values.0[*a], self.nodes[*a].width) as u64,
                Op::Extend(false, a) => values.0[*a],
                Op::Slice(a, low) => values.0[*a] >> low,
                Op::Operator(apply, list, width) => {
                    let mut operands = [0; 3];
                    for (operand, n) in operands.iter_mut().zip(list) {
                        *operand = values.0[*n];
                    }
                    apply(&operands, *width)
                }
            };
            values.0[k] = value & mask(node.width);
        }
    }

    /// Whether the step keeps the constraints.
    pub fn allowed(&self, values: &Values) -> bool {
        self.constraints.iter().all(|n| values.0[*n] == 1)
    }

    /// The value of a signal.
    pub fn signal(&self, values: &Values, node: usize) -> bool {
        values.0[node] == 1
    }

    /// The value of a state variable after the step; none if the model does not say.
    pub fn next(&self, values: &Values, variable: &Variable) -> Option<u64> {
        variable.next.map(|n| values.0[n])
    }
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let words: Vec<&str> = line.split(' ').collect();
        let number = |k: usize| -> Result<usize, String> {
            let word = words.get(k).ok_or("too short")?;
            word.parse().map_err(|_| format!("`{word}` is no number"))
        };
        let id = number(0)?;
        if id <= self.last {
            return Err("line numbers must rise".to_owned());
        }
        self.last = id;
        let word = *words.get(1).ok_or("too short")?;
        let symbol = |k: usize| words.get(k).map_or(String::new(), |w| (*w).to_owned());
        match word {
            "sort" => {
                let width = number(3)?;
                if words.get(2) != Some(&"bitvec") || !(1..=64).contains(&width) {
                    return Err("this reader knows bit-vectors of 1 to 64 bits".to_owned());
                }
                self.sorts.insert(id, width as u32);
            }
            "bad" => self.model.bad.push((symbol(3), self.bit(number(2)?)?)),
            "output" => self.model.outputs.push((symbol(3), self.bit(number(2)?)?)),
            "constraint" => {
                let node = self.bit(number(2)?)?;
                self.model.constraints.push(node);
            }
            "init" | "next" => self.variable(word == "init", number(2)?, number(3)?, number(4)?)?,
            _ => self.node(id, word, &words)?,
        }
        Ok(())
    }

    fn operand(&self, line: usize) -> Result<usize, String> {
        let node = self.lines.get(&line).copied();
        node.ok_or(format!("line {line} has no value before this line"))
    }

    fn bit(&self, line: usize) -> Result<usize, String> {
        let node = self.operand(line)?;
        if self.model.nodes[node].width == 1 {
            Ok(node)
        } else {
            Err("one bit is needed".to_owned())
        }
    }

    fn variable(
        &mut self,
        init: bool,
        sort: usize,
        state: usize,
        value: usize,
    ) -> Result<(), String> {
        let (node, value_node) = (self.operand(state)?, self.operand(value)?);
        if init && value > state {
            return Err("a start value must stand before its state".to_owned());
        }
        if init && !matches!(self.model.nodes[value_node].op, Op::Constant(_)) {
            return Err("this reader knows constant start values".to_owned());
        }
        let width = *self.sorts.get(&sort).ok_or("no such sort")?;
        if self.model.nodes[value_node].width != width {
            return Err("the value has another sort".to_owned());
        }
        let mut states = self.model.states.iter_mut();
        let variable = states.find(|v| v.node == node).ok_or("no such state")?;
        let slot = if init {
            &mut variable.init
        } else {
            &mut variable.next
        };
        if variable.width != width || slot.replace(value_node).is_some() {
            return Err("given twice, or of another sort".to_owned());
        }
        Ok(())
    }

    fn node(&mut self, id: usize, word: &str, words: &[&str]) -> Result<(), String> {
        let number = |k: usize| -> Result<usize, String> {
            let word = words.get(k).ok_or("too short")?;
            word.parse().map_err(|_| format!("`{word}` is no number"))
        };
        let width = *self.sorts.get(&number(2)?).ok_or("no such sort")?;
        let node = self.model.nodes.len();
        let op = match word {
            "state" | "input" => {
                let variable = Variable {
                    symbol: words.get(3).map_or(String::new(), |w| (*w).to_owned()),
                    width,
                    node,
                    init: None,
                    next: None,
                };
                if word == "state" {
                    self.model.states.push(variable);
                } else {
                    self.model.inputs.push(variable);
                }
                Op::Variable
            }
            "constd" => {
                let value: i64 = (words.get(3).and_then(|w| w.parse().ok())).ok_or("no number")?;
                let fits = if value < 0 {
                    signed(bits(value, width), width) == value
                } else {
                    bits(value, width) == value as u64
                };
                if !fits {
                    return Err("the constant does not fit its sort".to_owned());
                }
                Op::Constant(bits(value, width))
            }
            "uext" | "sext" => {
                let a = self.operand(number(3)?)?;
                if self.model.nodes[a].width + number(4)? as u32 != width {
                    return Err("the widths do not add up".to_owned());
                }
                Op::Extend(word == "sext", a)
            }
            "slice" => {
                let a = self.operand(number(3)?)?;
                let (high, low) = (number(4)? as u32, number(5)? as u32);
                if high < low || high - low + 1 != width || high >= self.model.nodes[a].width {
                    return Err("the widths do not add up".to_owned());
                }
                Op::Slice(a, low)
            }
            _ => self.operator(word, width, &number)?,
        };
        self.model.nodes.push(Node { width, op });
        self.lines.insert(id, node);
        Ok(())
    }

    fn operator(
        &self,
        word: &str,
        width: u32,
        number: &impl Fn(usize) -> Result<usize, String>,
    ) -> Result<Op, String> {
        let operator = (OPERATORS.iter().find(|o| o.word == word))
            .ok_or(format!("this reader does not know `{word}`"))?;
        let list: Vec<usize> = (0..operator.operands)
            .map(|k| self.operand(number(3 + k)?))
            .collect::<Result<_, String>>()?;
        let mut widths: Vec<u32> = list.iter().map(|n| self.model.nodes[*n].width).collect();
        // The first operand of a choice is its condition.
        if word == "ite" && widths.remove(0) != 1 {
            return Err("the condition must be one bit".to_owned());
        }
        let common = widths[0];
        let result = if operator.to_bit { 1 } else { common };
        if width != result || widths.iter().any(|w| *w != common) {
            return Err("the sorts do not fit the operator".to_owned());
        }
        Ok(Op::Operator(operator.apply, list, common))
    }
}
