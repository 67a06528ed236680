//! Programs, functions, function blocks, and their variables.

use super::Parser;
use crate::fault::{Checked, Fault};
use crate::st::ast::{
    Bounds, File, Init, Language, Pou, Section, SectionKind, TypeKind, TypeRef, VarDecl,
};
use crate::st::lex::Token;

/// The integer types of the standard. Which one it is says nothing here: the range decides.
const INTEGERS: [&str; 8] = [
    "INT", "UINT", "SINT", "USINT", "DINT", "UDINT", "LINT", "ULINT",
];

/// Types of the standard that are not taken, with the reason.
const REFUSED: &[(&[&str], &str)] = &[
    (
        &["REAL", "LREAL"],
        "numbers with a decimal point have too many values to explore: count in whole units",
    ),
    (
        &["STRING", "WSTRING", "CHAR", "WCHAR"],
        "texts take no part in a safety decision: use an enum or BOOL",
    ),
    (
        &["BYTE", "WORD", "DWORD", "LWORD"],
        "bit strings are not taken: use one BOOL for each bit, or INT (0..255)",
    ),
    (
        &["DATE", "TOD", "DT", "TIME_OF_DAY", "DATE_AND_TIME", "LDATE"],
        "a safety program knows durations only: use TIME",
    ),
];

impl Parser {
    pub(super) fn file(&mut self) -> Checked<File> {
        let (mut program, mut blocks, mut functions): (Option<Pou>, _, _) =
            (None, Vec::new(), Vec::new());
        loop {
            let start = self.span();
            match self.upper().as_str() {
                "PROGRAM" => {
                    let read = self.pou("PROGRAM", "END_PROGRAM")?;
                    if program.is_some() {
                        return Err(Fault::new(
                            &read.name.span,
                            format!("`{}` is a second program", read.name.text),
                            "a safe PLC runs one program: make it a FUNCTION_BLOCK and call it",
                        ));
                    }
                    program = Some(read);
                }
                "FUNCTION_BLOCK" => blocks.push(self.pou("FUNCTION_BLOCK", "END_FUNCTION_BLOCK")?),
                "FUNCTION" => functions.push(self.pou("FUNCTION", "END_FUNCTION")?),
                "TYPE" => {
                    return Err(Fault::new(
                        &start,
                        "types of your own are not taken",
                        "use the enums of the family, INT with a range such as INT (0..3), or CONSTANTs with names",
                    ));
                }
                "VAR_GLOBAL" | "CONFIGURATION" => {
                    return Err(Fault::new(
                        &start,
                        "configurations and global variables are not taken",
                        "declare the variables in the program; its inputs and outputs are those of the family",
                    ));
                }
                _ if *self.peek() == Token::End => break,
                _ => return self.wanted("PROGRAM, FUNCTION or FUNCTION_BLOCK"),
            }
        }
        match program {
            Some(program) => Ok(File {
                language: Language::StructuredText,
                program,
                blocks,
                functions,
            }),
            None => self.wanted("PROGRAM name ... END_PROGRAM"),
        }
    }

    fn pou(&mut self, opener: &str, end: &str) -> Checked<Pou> {
        let opened = self.span();
        self.at += 1;
        let name = self.name()?;
        let result = match opener == "FUNCTION" {
            true => {
                self.expect(":")?;
                Some(self.type_ref()?)
            }
            false => None,
        };
        let mut sections = Vec::new();
        while self.upper().starts_with("VAR") {
            sections.push(self.section()?);
        }
        let body = self.statements(&[end])?;
        self.close(end, opener, &opened)?;
        Ok(Pou {
            name,
            result,
            sections,
            body,
        })
    }

    fn section(&mut self) -> Checked<Section> {
        let opened = self.span();
        let word = self.upper();
        let mut kind = match word.as_str() {
            "VAR_INPUT" => SectionKind::Input,
            "VAR_OUTPUT" => SectionKind::Output,
            "VAR" => SectionKind::Local,
            "VAR_TEMP" => SectionKind::Temp,
            _ => {
                return Err(Fault::new(
                    &opened,
                    format!("{word} is not taken"),
                    "the sections are VAR_INPUT, VAR_OUTPUT, VAR, VAR CONSTANT and VAR_TEMP; \
                     give a block its values as inputs, and take its outputs",
                ));
            }
        };
        self.at += 1;
        if self.word("CONSTANT") {
            kind = SectionKind::Constant;
        }
        if ["RETAIN", "PERSISTENT"].contains(&self.upper().as_str()) {
            return Err(Fault::new(
                &self.span(),
                format!(
                    "{} is not taken: what a variable keeps over power-off is not explored",
                    self.upper()
                ),
                "each run begins with the initial values: leave it out",
            ));
        }
        self.word("NON_RETAIN");
        let mut variables = Vec::new();
        while !self.is_word("END_VAR") {
            if !matches!(self.peek(), Token::Word(w) if !super::is_keyword(w)) {
                self.close("END_VAR", &word, &opened)?;
            }
            // A statement here means that the section was not closed.
            if matches!(self.token(1).0, Token::Sym(":=" | "(" | ".")) {
                self.close("END_VAR", &word, &opened)?;
            }
            self.declaration(&mut variables)?;
        }
        self.close("END_VAR", &word, &opened)?;
        Ok(Section { kind, variables })
    }

    fn declaration(&mut self, variables: &mut Vec<VarDecl>) -> Checked<()> {
        let mut names = vec![self.name()?];
        while self.sym(",") {
            names.push(self.name()?);
        }
        if self.is_word("AT") {
            return Err(Fault::new(
                &self.span(),
                "addresses are not taken",
                "leave `AT ...` out: how inputs and outputs are wired stands in the machine file",
            ));
        }
        self.expect(":")?;
        let ty = self.type_ref()?;
        let init = match self.sym(":=") {
            false => None,
            true if self.is_sym("(") && matches!(self.token(2).0, Token::Sym(":=")) => {
                Some(self.fields()?)
            }
            true => Some(Init::Value(self.expr()?)),
        };
        self.semicolon()?;
        variables.extend(names.into_iter().map(|name| VarDecl {
            name,
            ty: ty.clone(),
            init: init.clone(),
            title: None,
        }));
        Ok(())
    }

    /// `(PT := T#1s, ...)`
    fn fields(&mut self) -> Checked<Init> {
        self.expect("(")?;
        let mut fields = Vec::new();
        loop {
            let name = self.name()?;
            self.expect(":=")?;
            fields.push((name, self.expr()?));
            if self.sym(")") {
                return Ok(Init::Fields(fields));
            }
            self.expect(",")?;
        }
    }

    fn type_ref(&mut self) -> Checked<TypeRef> {
        let start = self.span();
        let name = self.upper();
        if let Some((_, why)) = REFUSED
            .iter()
            .find(|(names, _)| names.contains(&name.as_str()))
        {
            return Err(Fault::new(
                &start,
                format!("the type {name} is not taken"),
                *why,
            ));
        }
        let kind = match name.as_str() {
            "BOOL" => {
                self.at += 1;
                TypeKind::Bool
            }
            "TIME" | "LTIME" => {
                self.at += 1;
                TypeKind::Time(self.bounds()?)
            }
            "CLOCK" => {
                self.at += 1;
                TypeKind::Clock(self.bounds()?)
            }
            "ARRAY" | "STRUCT" => {
                return Err(Fault::new(
                    &start,
                    format!("{name} is not taken"),
                    "declare one variable for each element",
                ));
            }
            _ if INTEGERS.contains(&name.as_str()) => {
                self.at += 1;
                TypeKind::Int(name, self.bounds()?)
            }
            _ => TypeKind::Named(self.name()?.text),
        };
        Ok(TypeRef {
            kind,
            span: self.since(start.start),
        })
    }

    /// `(0..7)`
    fn bounds(&mut self) -> Checked<Bounds> {
        if !self.sym("(") {
            return Ok(None);
        }
        let low = self.expr()?;
        self.expect("..")?;
        let high = self.expr()?;
        self.expect(")")?;
        Ok(Some(Box::new((low, high))))
    }
}
