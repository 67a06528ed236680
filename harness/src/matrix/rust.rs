//! What a Rust file of the repository says of requirements: by documented items, clauses of contracts, harnesses and test
//! functions. Ids in the comment of a module, in a string or in an ordinary comment are no evidence of anything.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::{Attribute, Expr, Item, Lit, Meta};

use super::ids::ids;

/// A place in a file that names requirements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Found {
    /// The item: `State::stage`, the clause or the function.
    pub(super) name: String,
    /// Its line in the file, from 1.
    pub(super) line: usize,
    /// The requirements, or their sentences, that it names.
    pub(super) ids: Vec<String>,
}

/// A harness of the inventory of proofs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Harness {
    /// Its name.
    pub(super) name: String,
    /// The monitor whose contract it proves, `family::stop`; none for a run.
    pub(super) contract: Option<String>,
    /// The requirements that a run names; those of a contract stand at its clauses.
    pub(super) ids: Vec<String>,
}

/// Everything in one file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Source {
    /// Documented functions, types, fields, variants and constants, test modules left out.
    pub(super) items: Vec<Found>,
    /// The clauses of a `monitor!` or `contract!`.
    pub(super) clauses: Vec<Found>,
    /// The entries of an `inventory!`.
    pub(super) harnesses: Vec<Harness>,
    /// Functions with `#[test]` and without `#[ignore]`.
    pub(super) tests: Vec<Found>,
}

/// Parses a file and collects what it names of the catalogues with these prefixes.
///
/// # Errors
/// A file that is no Rust.
pub(super) fn parse(text: &str, prefixes: &BTreeSet<String>) -> syn::Result<Source> {
    let file = syn::parse_file(text)?;
    let mut reader = Reader {
        prefixes,
        source: Source::default(),
    };
    reader.all(&file.items, "", false);
    Ok(reader.source)
}

struct Reader<'a> {
    prefixes: &'a BTreeSet<String>,
    source: Source,
}

impl Reader<'_> {
    /// `inside` is the path of the modules and types around, `test` whether they are compiled for tests only.
    fn all(&mut self, items: &[Item], inside: &str, test: bool) {
        for item in items {
            self.item(item, inside, test);
        }
    }

    fn item(&mut self, item: &Item, inside: &str, test: bool) {
        match item {
            Item::Fn(i) => self.function(&i.attrs, &i.sig, inside, test),
            Item::Const(i) => self.documented(&i.attrs, &i.ident, inside, test),
            Item::Static(i) => self.documented(&i.attrs, &i.ident, inside, test),
            Item::Type(i) => self.documented(&i.attrs, &i.ident, inside, test),
            Item::Struct(i) => {
                self.documented(&i.attrs, &i.ident, inside, test);
                self.fields(&i.fields, &path(inside, &i.ident), test);
            }
            Item::Enum(i) => {
                self.documented(&i.attrs, &i.ident, inside, test);
                let name = path(inside, &i.ident);
                for variant in &i.variants {
                    self.documented(&variant.attrs, &variant.ident, &name, test);
                    self.fields(&variant.fields, &path(&name, &variant.ident), test);
                }
            }
            Item::Trait(i) => {
                self.documented(&i.attrs, &i.ident, inside, test);
                for member in &i.items {
                    if let syn::TraitItem::Fn(f) = member {
                        self.function(&f.attrs, &f.sig, &path(inside, &i.ident), test);
                    }
                }
            }
            Item::Impl(i) => {
                let name = match &*i.self_ty {
                    syn::Type::Path(p) => p.path.segments.last().map(|s| path(inside, &s.ident)),
                    _ => None,
                };
                let name = name.unwrap_or_else(|| inside.to_owned());
                for member in &i.items {
                    match member {
                        syn::ImplItem::Fn(f) => self.function(&f.attrs, &f.sig, &name, test),
                        syn::ImplItem::Const(c) => {
                            self.documented(&c.attrs, &c.ident, &name, test);
                        }
                        _ => {}
                    }
                }
            }
            // The comment of a module says what the module is about, not where a requirement is met.
            Item::Mod(i) => {
                if let Some((_, items)) = &i.content {
                    let test = test || only_for_tests(&i.attrs);
                    self.all(items, &path(inside, &i.ident), test);
                }
            }
            Item::Macro(i) => self.invocation(&i.mac, inside, test),
            _ => {}
        }
    }

    fn fields(&mut self, fields: &syn::Fields, inside: &str, test: bool) {
        for field in fields {
            if let Some(name) = &field.ident {
                self.documented(&field.attrs, name, inside, test);
            }
        }
    }

    fn function(&mut self, attrs: &[Attribute], sig: &syn::Signature, inside: &str, test: bool) {
        if !attrs.iter().any(|a| a.path().is_ident("test")) {
            self.documented(attrs, &sig.ident, inside, test);
        } else if !attrs.iter().any(|a| a.path().is_ident("ignore")) {
            let found = self.found(attrs, &sig.ident, inside);
            self.source.tests.extend(found);
        }
    }

    fn documented(&mut self, attrs: &[Attribute], name: &syn::Ident, inside: &str, test: bool) {
        if !test && !only_for_tests(attrs) {
            let found = self.found(attrs, name, inside);
            self.source.items.extend(found);
        }
    }

    fn found(&self, attrs: &[Attribute], name: &syn::Ident, inside: &str) -> Option<Found> {
        let text: Vec<String> = attrs.iter().filter_map(doc).collect();
        let ids = ids(&text.join("\n"), self.prefixes);
        (!ids.is_empty()).then(|| Found {
            name: path(inside, name),
            line: name.span().start().line,
            ids,
        })
    }

    fn invocation(&mut self, mac: &syn::Macro, inside: &str, test: bool) {
        let name = mac.path.segments.last().map(|s| s.ident.to_string());
        match name.as_deref() {
            Some("contract" | "monitor") if !test => self.contract(mac.tokens.clone()),
            Some("fields" | "config") => match declared(mac.tokens.clone()) {
                Some(item) => self.item(&item, inside, test),
                None => self.described(mac.tokens.clone(), inside, test),
            },
            Some("inventory") => self.inventory(mac.tokens.clone()),
            Some("macro_rules") => {}
            _ => self.described(mac.tokens.clone(), inside, test),
        }
    }

    /// `/// text` `name ["ID", ...]: when ... => ...;`, any number of times, perhaps after the name of the monitor.
    fn contract(&mut self, tokens: TokenStream) {
        let mut tokens = tokens.into_iter().peekable();
        while let Some(token) = tokens.next() {
            let (TokenTree::Ident(name), Some(TokenTree::Group(list))) = (&token, tokens.peek())
            else {
                continue;
            };
            if list.delimiter() != Delimiter::Bracket {
                continue;
            }
            let ids = ids(&literals(list.stream()).join(" "), self.prefixes);
            if !ids.is_empty() {
                self.source.clauses.push(Found {
                    name: name.to_string(),
                    line: name.span().start().line,
                    ids,
                });
            }
            // The rest of the clause may index arrays.
            for rest in tokens.by_ref() {
                if matches!(&rest, TokenTree::Punct(p) if p.as_char() == ';') {
                    break;
                }
            }
        }
    }

    /// `[contract NAME on FAMILY::MODULE { ... }]` and `[run(n) NAME on ... { ... requirements: [...] ... }]`.
    fn inventory(&mut self, tokens: TokenStream) {
        for entry in tokens {
            let TokenTree::Group(entry) = entry else {
                continue;
            };
            let parts: Vec<TokenTree> = entry.stream().into_iter().collect();
            let words: Vec<String> = parts
                .iter()
                .filter_map(|t| match t {
                    TokenTree::Ident(word) => Some(word.to_string()),
                    _ => None,
                })
                .collect();
            match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
                ["contract", name, "on", family, module] => self.source.harnesses.push(Harness {
                    name: name.to_owned(),
                    contract: Some(format!("{family}::{module}")),
                    ids: Vec::new(),
                }),
                ["run", name, "on", ..] => {
                    let ids = ids(&named_list(&parts, "requirements"), self.prefixes);
                    self.source.harnesses.push(Harness {
                        name: name.to_owned(),
                        contract: None,
                        ids,
                    });
                }
                _ => {}
            }
        }
    }

    /// The documented members of any other macro: `/// text` before a name, as in the lists that make a type. A function
    /// with `#[test]` in it (`proptest!`) is a test.
    fn described(&mut self, tokens: TokenStream, inside: &str, test: bool) {
        let (mut text, mut tested, mut ignored) = (String::new(), false, false);
        let mut tokens = tokens.into_iter().peekable();
        while let Some(token) = tokens.next() {
            match (token, tokens.peek()) {
                (TokenTree::Punct(p), Some(TokenTree::Group(g))) if p.as_char() == '#' => {
                    let inner: Vec<TokenTree> = g.stream().into_iter().collect();
                    match inner.first().map(ToString::to_string).as_deref() {
                        Some("doc") => text.push_str(&literals(g.stream()).join(" ")),
                        Some("test") => tested = true,
                        Some("ignore") => ignored = true,
                        _ => {}
                    }
                    tokens.next();
                }
                (TokenTree::Ident(name), _) => {
                    let word = name.to_string();
                    if [
                        "pub", "fn", "struct", "enum", "const", "static", "unsafe", "extern",
                    ]
                    .contains(&word.as_str())
                    {
                        continue;
                    }
                    let ids = ids(&std::mem::take(&mut text), self.prefixes);
                    let found = Found {
                        name: path(inside, &name),
                        line: name.span().start().line,
                        ids,
                    };
                    let (is_test, skipped) =
                        (std::mem::take(&mut tested), std::mem::take(&mut ignored));
                    if found.ids.is_empty() || skipped {
                    } else if is_test {
                        self.source.tests.push(found);
                    } else if !test {
                        self.source.items.push(found);
                    }
                }
                (TokenTree::Group(g), _) => self.described(g.stream(), inside, test),
                _ => {}
            }
        }
    }
}

/// The type that `fields!` or `config!` declares, up to its closing brace; none for one in a form of theirs alone.
fn declared(tokens: TokenStream) -> Option<Item> {
    let mut item: Vec<TokenTree> = Vec::new();
    for token in tokens {
        let last = matches!(&token, TokenTree::Group(g) if g.delimiter() == Delimiter::Brace);
        item.push(token);
        if last {
            break;
        }
    }
    syn::parse2(item.into_iter().collect()).ok()
}

fn path(inside: &str, name: &syn::Ident) -> String {
    if inside.is_empty() {
        name.to_string()
    } else {
        format!("{inside}::{name}")
    }
}

fn doc(attribute: &Attribute) -> Option<String> {
    match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(expr) => match &expr.lit {
                Lit::Str(text) => Some(text.value()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}

/// `#[cfg(test)]` or `#[test]`.
fn only_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| match &a.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    })
}

/// The texts of the string literals of a stream, not of groups in it.
fn literals(tokens: TokenStream) -> Vec<String> {
    tokens
        .into_iter()
        .filter_map(|token| match token {
            TokenTree::Literal(literal) => Some(Lit::new(literal)),
            _ => None,
        })
        .filter_map(|literal| match literal {
            Lit::Str(text) => Some(text.value()),
            _ => None,
        })
        .collect()
}

/// The literals of `KEY: [ ... ]` in the braces of an entry.
fn named_list(entry: &[TokenTree], key: &str) -> String {
    let body = entry.iter().find_map(|t| match t {
        TokenTree::Group(g) if g.delimiter() == Delimiter::Brace => Some(g.stream()),
        _ => None,
    });
    let mut tokens = body.into_iter().flatten();
    if tokens.any(|t| matches!(&t, TokenTree::Ident(word) if word == key)) {
        if let Some(TokenTree::Group(list)) = tokens.nth(1) {
            return literals(list.stream()).join(" ");
        }
    }
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Source {
        parse(text, &BTreeSet::from(["F".to_owned()])).expect("Rust")
    }

    fn names(found: &[Found]) -> Vec<String> {
        found
            .iter()
            .map(|f| format!("{}:{} {}", f.line, f.name, f.ids.join(" ")))
            .collect()
    }

    /// What counted as long as words were counted, and shows nothing.
    #[test]
    fn modules_messages_and_comments_are_no_evidence() {
        let source = read(
            r#"//! About F-A-001.
            // F-A-002
            /// What F-A-003 is about.
            pub mod inner {
                //! F-A-004
                /// Says "F".
                pub fn refused() -> &'static str { "F-A-005" }
            }
            #[test]
            fn asks() { assert!("F-A-006".len() > 1); /* F-A-007 */ }
            #[cfg(test)]
            mod tests {
                /// F-A-008
                fn helper() {}
                /// F-A-009
                #[test]
                #[ignore]
                fn skipped() {}
            }
            macro_rules! m { () => { #[doc = "F-A-010"] fn f() {} } }
            "#,
        );
        assert_eq!(source, Source::default());
    }

    #[test]
    fn documented_items_are_named_with_their_line() {
        let source = read(
            "/// F-A-001\npub struct S {\n    /// F-A-002/b\n    pub f: u8,\n}\nimpl S {\n    /// F-A-003\n    \
             pub const C: u8 = 1;\n    /// (F-A-004,\n    /// F-A-005).\n    pub fn g(&self) {}\n}\n\
             pub enum E {\n    /// F-A-006\n    V,\n}\nlist! {\n    /// F-A-007\n    pub name: 1,\n}\n",
        );
        assert_eq!(
            names(&source.items),
            [
                "2:S F-A-001",
                "4:S::f F-A-002/b",
                "8:S::C F-A-003",
                "11:S::g F-A-004 F-A-005",
                "15:E::V F-A-006",
                "19:name F-A-007"
            ]
        );
        assert!(source.tests.is_empty() && source.clauses.is_empty());
    }

    #[test]
    fn clauses_harnesses_and_tests_are_read() {
        let source = read(
            r#"
            contract! {
                /// Not by the text, F-A-009.
                first ["F-P-01", "F-A-001"]: when |s| s.list[0] => s.after[1] == F["F-A-008"];
                /// Second.
                second ["F-A-002/a"]: when |s| true => true;
            }
            inventory! {
                [contract stop_contract on fam::stop { property: "F-A-003", domain: D, domain_text: "", caveat: "" }]
                [run(3) whole on fam::"axis" by axis::whole {
                    property: "p", requirements: ["F-A-004", "F-A-005/b"], covers: ["F-A-006"], domain: D
                }]
            }
            #[cfg(test)]
            mod tests {
                /// F-A-007: it holds.
                #[test]
                fn holds() {}
                proptest! {
                    /// F-A-011
                    #[test]
                    fn drawn(x in 0..3) { let y = x; }
                }
            }
            "#,
        );
        assert_eq!(
            names(&source.clauses),
            ["4:first F-A-001", "6:second F-A-002/a"]
        );
        let run = Harness {
            name: "whole".to_owned(),
            contract: None,
            ids: vec!["F-A-004".to_owned(), "F-A-005/b".to_owned()],
        };
        let contract = Harness {
            name: "stop_contract".to_owned(),
            contract: Some("fam::stop".to_owned()),
            ids: Vec::new(),
        };
        assert_eq!(source.harnesses, [contract, run]);
        assert_eq!(
            names(&source.tests),
            ["18:tests::holds F-A-007", "22:tests::drawn F-A-011"]
        );
        assert!(source.items.is_empty(), "{:?}", source.items);
    }
}
