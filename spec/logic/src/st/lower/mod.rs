//! Runs a program once with names in place of values, and writes down what it computes as a table.

mod assign;
mod blocks;
mod calls;
mod declare;
mod emit;
mod expressions;
mod statements;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;
use std::sync::{Arc, LazyLock};

use crate::Compiled;
use crate::fault::{Checked, Fault, Span};
use crate::st::STANDARD;
use crate::st::ast::{File, Language, Pou};
use crate::st::signature::Signature;
use crate::st::term::{Term, Ty, Use};

/// Named expressions of one program; an unrolled loop of more is a mistake.
const MAX_LETS: usize = 20_000;

/// Statements that are run, with those of loops and blocks counted each time.
const MAX_WORK: usize = 200_000;

/// Branches within one another, with those of blocks and functions that are called there; more exhaust the stack.
const MAX_DEPTH: usize = 150;

/// Blocks and functions within one another.
const MAX_NESTING: usize = 30;

/// More faults than these help nobody.
const MAX_FAULTS: usize = 40;

/// Translates a program that was read.
///
/// # Errors
/// Everything that is wrong in it, in its order.
pub(crate) fn lower(
    file: &str,
    source: &Arc<str>,
    tree: &File,
    signature: &Signature,
) -> Result<Compiled, Vec<Fault>> {
    let mut lowering = Lowering {
        file,
        source,
        tree,
        signature,
        variables: Vec::new(),
        env: Env::new(),
        lets: Vec::new(),
        checks: Vec::new(),
        path: Vec::new(),
        names: signature.names(),
        numbers: HashMap::new(),
        durations: BTreeMap::new(),
        faults: Vec::new(),
        site: None,
        loops: Vec::new(),
        nesting: Vec::new(),
        work: 0,
        depth: 0,
        lines: std::iter::once(0)
            .chain(source.match_indices('\n').map(|(at, _)| at + 1))
            .collect(),
    };
    let scope = lowering.program(&tree.program);
    lowering.start_cycle();
    lowering.run_body(&tree.program, &scope);
    lowering.unassigned(&scope);
    let mut faults = std::mem::take(&mut lowering.faults);
    match faults.is_empty() {
        true => Ok(lowering.emit(&scope)),
        false => {
            // What stands in a loop or a block is met more than once.
            let mut seen = HashSet::new();
            faults.retain(|f| seen.insert((f.span.clone(), f.message.clone())));
            faults.sort_by_key(|f| f.span.start);
            Err(faults)
        }
    }
}

/// The blocks of the standard.
static STANDARD_BLOCKS: LazyLock<File> = LazyLock::new(|| blocks(STANDARD));

/// The blocks of the safe logic.
static SAFE_LOGIC_BLOCKS: LazyLock<File> = LazyLock::new(|| blocks(crate::spf::RELAY));

/// The blocks of the control that statement lists call.
static STATEMENT_LIST_BLOCKS: LazyLock<File> = LazyLock::new(|| blocks(crate::stl::BLOCKS));

/// A file of nothing but blocks.
fn blocks(text: &str) -> File {
    let text = format!("{text}PROGRAM none END_PROGRAM");
    crate::st::parse::parse(&text).unwrap_or_else(|e| panic!("{}: {text}", e.message))
}

/// What a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// An output of the program.
    Output,
    BlockInput,
    BlockOutput,
    Local,
    /// Begins with its initial value wherever its body is run.
    Temp,
    /// Counts the cycles by itself.
    Clock,
    /// A variable that keeps its range by itself: of a standard block, or of [`TypeKind::Kept`].
    ///
    /// [`TypeKind::Kept`]: crate::st::ast::TypeKind::Kept
    Standard,
}

/// A variable of the program, or of an instance of a block in it.
struct Variable {
    /// As a reader of the program names it: `t1.ET`.
    name: String,
    /// Its name in the table, as state.
    table: String,
    ty: Ty,
    bounds: Option<(Term, Term)>,
    init: Term,
    role: Role,
    span: Span,
}

/// A named expression.
struct Let {
    name: String,
    term: Term,
    span: Span,
    text: String,
}

/// An assignment whose value can leave the range of its variable: a fault where it does.
struct Check {
    /// Under which conditions it is made.
    path: Term,
    value: Term,
    variable: usize,
}

/// The values of variables that were assigned in this cycle, and whether RETURN or EXIT was met.
type Env = BTreeMap<Slot, Rc<Term>>;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Slot {
    Variable(usize),
    Return,
    Exit,
}

/// What a name of a program or block stands for; names have no case.
#[derive(Clone)]
enum Entry<'a> {
    Input(Term),
    Constant(Term),
    Variable(usize),
    Block(Rc<Instance<'a>>),
    /// Its declaration is wrong, which has been told.
    Failed,
}

type Names<'a> = BTreeMap<String, Entry<'a>>;

/// The names that a body sees.
#[derive(Clone, Default)]
struct Scope<'a> {
    names: Names<'a>,
    /// Before the names of its variables: `t1.`.
    prefix: String,
    standard: bool,
}

/// An instance of a function block.
struct Instance<'a> {
    name: String,
    pou: &'a Pou,
    scope: Scope<'a>,
}

struct Lowering<'a> {
    file: &'a str,
    source: &'a Arc<str>,
    tree: &'a File,
    signature: &'a Signature,
    variables: Vec<Variable>,
    env: Env,
    lets: Vec<Let>,
    checks: Vec<Check>,
    path: Vec<Term>,
    /// Names of the table that are taken.
    names: HashSet<String>,
    /// How often a name was wanted.
    numbers: HashMap<String, usize>,
    durations: BTreeMap<u64, String>,
    faults: Vec<Fault>,
    /// Where a standard block is called: its own text is none of the program's.
    site: Option<Span>,
    /// Variables of the loops around.
    loops: Vec<usize>,
    /// Blocks and functions around.
    nesting: Vec<String>,
    work: usize,
    /// Branches around.
    depth: usize,
    /// Where each line begins.
    lines: Vec<usize>,
}

impl<'a> Lowering<'a> {
    /// The blocks that a program has without writing them.
    fn standard(&self) -> &'static [Pou] {
        match self.tree.language {
            Language::StructuredText => &STANDARD_BLOCKS.blocks,
            Language::SafeLogic => &SAFE_LOGIC_BLOCKS.blocks,
            Language::StatementList => &STATEMENT_LIST_BLOCKS.blocks,
        }
    }

    /// Where a place of the text is told: in a standard block, where that is called.
    fn at(&self, span: &Span) -> Span {
        self.site.clone().unwrap_or_else(|| span.clone())
    }

    fn fault(&mut self, fault: Fault) {
        // What follows from another fault has no words.
        if !fault.message.is_empty() && self.faults.len() < MAX_FAULTS {
            self.faults.push(Fault {
                span: self.at(&fault.span),
                ..fault
            });
        }
    }

    /// The value of a result; its fault is told.
    fn note<T>(&mut self, result: Checked<T>) -> Option<T> {
        result.map_err(|fault| self.fault(fault)).ok()
    }

    fn line(&self, span: &Span) -> usize {
        self.lines.partition_point(|start| *start <= span.start)
    }

    /// The first line of a piece of the program, shortened.
    fn quoted(&self, span: &Span) -> String {
        let text = self.source.get(self.at(span)).unwrap_or_default();
        let line = match self.tree.language {
            Language::StatementList => crate::stl::on_one_line(text),
            _ => text.lines().next().unwrap_or_default().trim().to_owned(),
        };
        match line.char_indices().nth(100) {
            Some((cut, _)) => format!("{} ...", &line[..cut]),
            None => line,
        }
    }

    /// A name for the table that none has yet.
    fn fresh(&mut self, base: &str) -> String {
        let mut clean: String = base
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        if !clean.starts_with(|c: char| c.is_ascii_alphabetic()) {
            clean.insert(0, 'v');
        }
        let mut name = clean.clone();
        while crate::st::parse::is_keyword(&name)
            || TABLE_WORDS.contains(&name.as_str())
            || !self.names.insert(name.clone())
        {
            let number = self.numbers.entry(clean.clone()).or_insert(1);
            *number += 1;
            name = format!("{clean}_{number}");
        }
        name
    }

    /// The value under a name of its own, which carries its line; what is a name or literal already stays.
    fn named(
        &mut self,
        base: &str,
        span: &Span,
        term: Term,
        text: Option<String>,
    ) -> Checked<Term> {
        let span = self.at(span);
        let term = term.held(&span)?;
        if term.is_atom() {
            return Ok(term);
        }
        if self.lets.len() >= MAX_LETS {
            return Err(Fault::new(
                &span,
                format!("the program computes more than {MAX_LETS} values in a cycle"),
                "make its loops shorter",
            ));
        }
        let line = self.line(&span);
        let name = self.fresh(&format!("{base}_line_{line}"));
        let text = text.unwrap_or_else(|| self.quoted(&span));
        let mut leaf = Term::leaf(name.clone(), term.ty, term.low, term.high)
            .reading(Use::Let(self.lets.len()));
        leaf.fixed = term.fixed;
        self.lets.push(Let {
            name,
            term,
            text: format!("line {line}: {text}"),
            span,
        });
        Ok(leaf)
    }

    /// Counts a piece of work, unless the program is too large.
    fn works(&mut self, span: &Span) -> Checked<()> {
        self.work += 1;
        match self.work.cmp(&(MAX_WORK + 1)) {
            std::cmp::Ordering::Less => Ok(()),
            std::cmp::Ordering::Equal => Err(Fault::new(
                span,
                format!("a cycle of the program has more than {MAX_WORK} statements"),
                "make its loops shorter",
            )),
            std::cmp::Ordering::Greater => Err(blocks::silent(span)),
        }
    }

    /// A value under a name that stands for no line of the program, but for what becomes of a variable there.
    fn unquoted(&mut self, name: &str, span: &Span, term: Term, what: &str) -> Checked<Term> {
        let known = self.lets.len();
        let named = self.named(name, span, term, None)?;
        let line = self.line(&self.at(span));
        if let Some(made) = self.lets.get_mut(known) {
            made.text = format!("{name} {what} {line}");
        }
        Ok(named)
    }

    /// The value of a variable as it is now.
    fn value(&self, slot: Slot) -> Rc<Term> {
        if let Some(term) = self.env.get(&slot) {
            return term.clone();
        }
        Rc::new(match slot {
            Slot::Variable(id) => self.before(id),
            Slot::Return | Slot::Exit => Term::bool(false),
        })
    }

    /// The value that a variable has from the cycle before.
    fn before(&self, id: usize) -> Term {
        let variable = &self.variables[id];
        let (low, high) = self.range(variable);
        Term::leaf(variable.table.clone(), variable.ty, low, high).reading(Use::State(id))
    }

    /// The values that a variable can have at all.
    fn range(&self, variable: &Variable) -> (i64, i64) {
        match (&variable.bounds, variable.ty) {
            (Some((low, high)), _) => (low.low, high.high),
            (None, Ty::Enum(of)) => (0, self.signature.enums[of].values.len() as i64 - 1),
            (None, Ty::Bool) => (0, 1),
            (None, Ty::Int | Ty::Time) => (i64::from(-i32::MAX), i64::from(i32::MAX)),
        }
    }

    fn set(&mut self, id: usize, term: Term) {
        self.env.insert(Slot::Variable(id), Rc::new(term));
    }

    /// Every clock is a cycle further.
    fn start_cycle(&mut self) {
        for id in 0..self.variables.len() {
            if self.variables[id].role != Role::Clock {
                continue;
            }
            let (_, high) = self.variables[id]
                .bounds
                .clone()
                .unwrap_or_else(|| (Term::bool(false), Term::bool(false)));
            let old = self.before(id);
            let next = old.infix(
                "+",
                5,
                &Term::number(1, Ty::Time),
                Ty::Time,
                (old.low + 1, old.high + 1),
            );
            let range = (next.low.min(high.low), next.high.min(high.high));
            let next = Term::call("MIN", &[&next, &high], Ty::Time, range);
            let (name, span) = (
                self.variables[id].name.clone(),
                self.variables[id].span.clone(),
            );
            if let Ok(next) = self.unquoted(&name, &span, next, "counts the cycle, line") {
                self.set(id, next);
            }
        }
    }
}

/// Words that the tables keep for themselves, beside those of programs.
const TABLE_WORDS: [&str; 6] = ["INT", "BOOL", "TIME", "FORALL", "EXISTS", "MAXIMUM"];
