//! Reads a program, block by block; each block is one line, in printed texts after its repair.

mod expressions;
mod relays;
mod statements;

use std::sync::Arc;

use super::ast::{Action, Name, Relay};
use super::lex::{Token, tokens};
use super::lines::Line;
use super::listing::{self, Repair};
use super::names::{Known, Meaning, Names, misprinted};
use super::{Mode, Note, Program};
use crate::fault::{Checked, Fault, Span};

/// Deeper nesting is refused, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 40;

/// More faults than these help nobody.
const MAX_FAULTS: usize = 40;

/// Codes that end a program.
pub(super) const END_CODES: [&str; 4] = ["M02", "M2", "M17", "M30"];

/// Reads a program.
///
/// # Errors
/// Everything that is wrong in it, in its order.
pub(crate) fn program(file: &str, source: &Arc<str>, mode: Mode) -> Result<Program, Vec<Fault>> {
    let mut reader = Reader {
        source,
        printed: mode == Mode::Listing,
        fragment: false,
        names: Names::default(),
        defined: Vec::new(),
        actions: Vec::new(),
        relays: Default::default(),
        name: None,
        ended: None,
        repairs: Vec::new(),
        notes: Vec::new(),
        faults: Vec::new(),
    };
    let blocks = reader.blocks();
    reader.all(blocks);
    reader.finish(file, mode)
}

/// What has been read so far.
pub(super) struct Reader<'s> {
    source: &'s Arc<str>,
    /// Whether the text is a printed one, whose damage is repaired.
    printed: bool,
    /// Whether it is a part of a program: without header and end.
    fragment: bool,
    names: Names,
    defined: Vec<Name>,
    actions: Vec<Action>,
    relays: std::collections::BTreeMap<u8, Relay>,
    name: Option<String>,
    /// Where its end code stands.
    ended: Option<Span>,
    repairs: Vec<Repair>,
    notes: Vec<Note>,
    faults: Vec<Fault>,
}

/// A block as tokens, without its number; the first line of a program stands as a text.
enum Block {
    Header(Line),
    Tokens(Vec<(Token, Span)>),
}

impl Reader<'_> {
    fn fault(&mut self, fault: Fault) {
        if self.faults.len() < MAX_FAULTS {
            self.faults.push(fault);
        }
    }

    fn note(&mut self, at: usize, rule: &'static str, text: String) {
        self.notes.push(Note::new(self.source, at, rule, text));
    }

    fn line(&self, at: usize) -> usize {
        super::line_of(self.source, at)
    }

    fn blocks(&mut self) -> Vec<Block> {
        let lines = match self.printed {
            true => listing::blocks(self.source, &mut self.repairs, &mut self.faults),
            false => Line::all(self.source),
        };
        let mut blocks = Vec::new();
        for line in lines {
            let at = line.indent();
            if line.is_blank() || line.char(at) == Some(';') {
                continue;
            }
            if line.char(at) == Some('%') {
                blocks.push(Block::Header(line.trimmed()));
                continue;
            }
            let number = listing::block_number(&line, at);
            match tokens(&line.part(at + number..line.len()), self.printed) {
                Ok(tokens) if tokens.len() > 1 => blocks.push(Block::Tokens(tokens)),
                Ok(_) => {}
                Err(fault) => self.fault(fault),
            }
        }
        blocks
    }

    fn all(&mut self, mut blocks: Vec<Block>) {
        let first = |block: &Block, words: &[&str]| match block {
            Block::Tokens(tokens) => {
                matches!(&tokens[0].0, Token::Word(w) if words.iter().any(|x| x.eq_ignore_ascii_case(w)))
            }
            Block::Header(_) => false,
        };
        let header = blocks.iter().any(|block| matches!(block, Block::Header(_)));
        let end = blocks.iter().any(|block| first(block, &END_CODES));
        self.fragment = self.printed && !header && !end;
        if self.printed {
            for block in &mut blocks {
                if let Block::Tokens(tokens) = block {
                    misprinted(tokens, &mut self.repairs);
                }
            }
        }
        // Definitions first: a repair of a name needs to know them all.
        for block in &blocks {
            if let (Block::Tokens(tokens), true) = (block, first(block, &["DEFINE", "DEF"])) {
                let read = Block::reader(self, tokens).definition();
                if let Err(fault) = read {
                    self.fault(fault);
                }
            }
        }
        if self.printed {
            self.repair(&mut blocks);
        }
        for (k, block) in blocks.iter().enumerate() {
            let read = match block {
                Block::Header(line) => self.header(line, k == 0),
                Block::Tokens(tokens) => Block::reader(self, tokens).statement(),
            };
            if let Err(fault) = read {
                self.fault(fault);
            }
        }
    }

    /// Repairs names in everything but definitions and messages.
    fn repair(&mut self, blocks: &mut [Block]) {
        let plain = |tokens: &[(Token, Span)]| {
            !matches!(&tokens[0].0, Token::Word(w)
                if ["DEFINE", "DEF", "MSG", "PROC"].iter().any(|x| x.eq_ignore_ascii_case(w)))
        };
        if self.fragment {
            let known: Vec<(String, Span)> = blocks
                .iter()
                .flat_map(|block| match block {
                    Block::Tokens(tokens) if plain(tokens) => of_fragment(tokens),
                    _ => Vec::new(),
                })
                .collect();
            for (name, span) in known {
                self.names.undefined(&name, &span);
            }
        }
        for block in blocks {
            if let Block::Tokens(tokens) = block {
                if plain(tokens) {
                    self.names.repair(self.source, tokens, &mut self.repairs);
                }
            }
        }
    }

    /// `%_N_SAFE_SPF`
    fn header(&mut self, line: &Line, first: bool) -> Checked<()> {
        let text = line.code();
        let mut name = text.trim_start_matches('%').trim().to_owned();
        let span = line.span(0..line.len());
        if self.printed && (name.contains(' ') || name.contains('\\')) {
            name = name.replace('\\', "");
            let words: Vec<&str> = name.split_whitespace().collect();
            name = words.join("_");
            if !name.starts_with('_') {
                name.insert(0, '_');
            }
            let text = format!("`%{name}` for `{}`", text.trim());
            self.repairs.push(Repair::new(span.start, "R2", text));
        }
        let inner = name
            .strip_prefix("_N_")
            .filter(|rest| super::variable::is_name(rest));
        let Some(inner) = inner else {
            return Err(Fault::new(
                &span,
                format!("`{}` is no name of a program", text.trim()),
                "write `%_N_SAFE_SPF`, or leave the line out",
            ));
        };
        if !first {
            return Err(Fault::new(
                &span,
                "the name of the program stands after other blocks",
                "it is the first line; one file holds one program",
            ));
        }
        if name != "_N_SAFE_SPF" {
            let text = format!(
                "the control starts `_N_SAFE_SPF`, in upper case, not `{name}`: alarm 27097"
            );
            self.note(span.start, "27097", text);
        }
        let short = inner.strip_suffix("_SPF").unwrap_or(inner);
        self.name = Some(short.to_owned());
        Ok(())
    }

    fn finish(mut self, file: &str, mode: Mode) -> Result<Program, Vec<Fault>> {
        if self.ended.is_none() && !self.fragment {
            let text = self.source.trim_end();
            let last = text.chars().next_back().map_or(0, char::len_utf8);
            let fault = Fault::new(
                &(text.len() - last..text.len()),
                "the program has no end code",
                "end it with a block `M17`, also M30, M02 or M2: without it the control never takes the program as started",
            );
            self.fault(fault.label("after this"));
        }
        if self.fragment && self.actions.is_empty() && self.names.iter().next().is_none() {
            let fault = Fault::new(
                &(0..self.source.chars().next().map_or(0, char::len_utf8)),
                "there is no block of the safe logic in this text",
                "a block begins with IDS, DEFINE, ..., or with a block number such as N10",
            );
            self.fault(fault);
        }
        self.repeated(mode);
        self.actions.sort_by_key(|action| action.id);
        let repairs = std::mem::take(&mut self.repairs);
        let noted = repairs.into_iter().map(|repair| repair.noted(self.source));
        self.notes.extend(noted);
        self.notes.extend(super::check::notes(
            self.source,
            &self.actions,
            &self.relays,
        ));
        self.notes.sort_by_key(|note| note.line);
        let mut seen = std::collections::HashSet::new();
        self.notes.retain(|note| seen.insert(note.clone()));
        if !self.faults.is_empty() {
            self.faults.sort_by_key(|fault| fault.span.start);
            return Err(self.faults);
        }
        Ok(Program {
            file: file.to_owned(),
            source: self.source.clone(),
            name: self.name.unwrap_or_else(|| "SAFE".to_owned()),
            names: self.defined,
            actions: self.actions,
            relays: self.relays,
            notes: self.notes,
            fragment: self.fragment,
        })
    }

    /// DUP_REJECT for programs, DUP_REPLACE for printed ones: S840D-LANG-711.
    fn repeated(&mut self, mode: Mode) {
        let mut at = 0;
        while at < self.actions.len() {
            let Action { id, id_span, .. } = &self.actions[at];
            let later = self.actions[at + 1..].iter().find(|other| other.id == *id);
            let Some(later) = later else {
                at += 1;
                continue;
            };
            let (id, first, second) = (*id, id_span.clone(), later.id_span.clone());
            match mode {
                Mode::Strict => {
                    let line = self.line(first.start);
                    let fault = Fault::new(
                        &second,
                        format!("the id {id} stands at line {line} already"),
                        "give each action an id of its own, 1..255",
                    );
                    self.fault(fault.label("the same id"));
                    at += 1;
                }
                Mode::Listing => {
                    let text = format!(
                        "the id {id} stands at line {} already: this action replaces that one, which is left out",
                        self.line(first.start)
                    );
                    self.note(second.start, "DUP_REPLACE", text);
                    self.actions.remove(at);
                }
            }
        }
    }
}

/// The names of a fragment: words with a `_`, and what is assigned.
fn of_fragment(tokens: &[(Token, Span)]) -> Vec<(String, Span)> {
    let mut found = Vec::new();
    let mut target: Option<Vec<&str>> = None;
    for (token, span) in tokens {
        match token {
            Token::Word(word) if word.eq_ignore_ascii_case("DO") => target = Some(Vec::new()),
            Token::Word(word) => {
                if word.contains('_') && !word.starts_with(|c: char| c.is_ascii_digit()) {
                    found.push((word.clone(), span.clone()));
                }
                target.iter_mut().for_each(|words| words.push(word));
            }
            Token::Sym("=") => {
                if let Some(words) = target.take().filter(|words| !words.is_empty()) {
                    found.push((words.join("_"), span.clone()));
                }
            }
            _ => target = None,
        }
    }
    found
}

impl Block {
    fn reader<'r, 's>(reader: &'r mut Reader<'s>, tokens: &'r [(Token, Span)]) -> Parser<'r, 's> {
        Parser {
            reader,
            tokens,
            at: 0,
            depth: 0,
        }
    }
}

/// Reads one block.
struct Parser<'r, 's> {
    reader: &'r mut Reader<'s>,
    tokens: &'r [(Token, Span)],
    at: usize,
    depth: usize,
}

impl Parser<'_, '_> {
    fn token(&self, ahead: usize) -> &(Token, Span) {
        // The list ends with `End`, which is never left.
        &self.tokens[(self.at + ahead).min(self.tokens.len() - 1)]
    }

    fn peek(&self) -> &Token {
        &self.token(0).0
    }

    fn span(&self) -> Span {
        self.token(0).1.clone()
    }

    fn since(&self, start: usize) -> Span {
        let last = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        let end = last.map_or(start, |(_, span)| span.end);
        start..end.max(start)
    }

    fn is_sym(&self, symbol: &str) -> bool {
        matches!(self.peek(), Token::Sym(s) if *s == symbol)
    }

    fn sym(&mut self, symbol: &str) -> bool {
        let hit = self.is_sym(symbol);
        self.at += usize::from(hit);
        hit
    }

    fn is_word(&self, word: &str) -> bool {
        matches!(self.peek(), Token::Word(w) if w.eq_ignore_ascii_case(word))
    }

    fn word(&mut self, word: &str) -> bool {
        let hit = self.is_word(word);
        self.at += usize::from(hit);
        hit
    }

    /// The next word in upper case; empty where there is none.
    fn upper(&self) -> String {
        match self.peek() {
            Token::Word(word) => word.to_ascii_uppercase(),
            _ => String::new(),
        }
    }

    fn wanted<T>(&self, what: &str, help: &str) -> Checked<T> {
        Err(Fault::new(
            &self.span(),
            format!("{what} is missing before {}", self.peek().describe()),
            help,
        ))
    }

    fn expect(&mut self, symbol: &str, help: &str) -> Checked<()> {
        match self.sym(symbol) {
            true => Ok(()),
            false => self.wanted(&format!("`{symbol}`"), help),
        }
    }

    /// What a name stands for, or that nothing does.
    fn known(&mut self, name: &str, span: &Span) -> Checked<Known> {
        if let Some(known) = self.reader.names.get(name) {
            if known.span.start > span.start && known.meaning != Meaning::Undefined {
                let line = self.reader.line(known.span.start);
                return Err(Fault::new(
                    span,
                    format!("'{name}' is defined below, at line {line}"),
                    "definitions stand at the beginning of the program",
                ));
            }
            return Ok(known.clone());
        }
        if self.reader.fragment {
            self.reader.names.undefined(name, span);
            return self.known(name, span);
        }
        let names = self.reader.names.iter().map(|known| known.name.as_str());
        let help = match stillpoint_lang::diag::nearest(name, names) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("define it at the beginning: `DEFINE {name} AS $A_MARKERSI[1]`"),
        };
        Err(Fault::new(span, format!("'{name}' is not defined"), help).label("not known"))
    }
}
