//! Resolves properties: which form, which atoms, one copy per index.

use crate::assemble::Builder;
use crate::diag::Diagnostic;
use crate::ir::{Form, Node, Property, Space, Stated, Topic, Ty};
use crate::schema::{self, Scalar, Text};
use crate::syntax::ast::{Expr, Kind};
use toml::Spanned;

type One<T> = std::result::Result<T, Diagnostic>;

/// The values of the index variable `i`: one copy each, or one without index.
pub(crate) fn copies(b: &Builder, def: &schema::Property) -> Vec<Option<i64>> {
    let mut array = None;
    for (_, text) in texts(def) {
        if let Ok(e) = b.spec.expr(b.file, text) {
            find_index(&e, &mut array);
        }
    }
    match array.and_then(|name| b.arrays.get(&name)) {
        Some(count) => (1..=*count).map(Some).collect(),
        None => vec![None],
    }
}

fn find_index(e: &Expr, found: &mut Option<String>) {
    match &e.kind {
        Kind::Index(base, index) => {
            if let (Kind::Name(array), Kind::Name(i)) = (&base.kind, &index.kind) {
                if i == "i" && found.is_none() {
                    *found = Some(array.clone());
                }
            }
            find_index(base, found);
            find_index(index, found);
        }
        Kind::Member(a, _) | Kind::Unary(_, a) | Kind::Quantified(_, _, _, a) => {
            find_index(a, found)
        }
        Kind::Binary(_, a, b) => {
            find_index(a, found);
            find_index(b, found);
        }
        Kind::Call(_, args) => args.iter().for_each(|a| find_index(a, found)),
        _ => {}
    }
}

pub(crate) fn texts(def: &schema::Property) -> Vec<(&'static str, &Text)> {
    let single = [
        ("always", &def.always),
        ("never", &def.never),
        ("when", &def.when),
        ("then", &def.then),
        ("leads_to", &def.leads_to),
        ("assuming", &def.assuming),
        ("holds", &def.holds),
        ("unless", &def.unless),
        ("can_always_reach", &def.can_always_reach),
        ("using", &def.using),
        ("reachable", &def.reachable),
        ("while", &def.while_),
    ];
    let mut out: Vec<_> = single
        .into_iter()
        .filter_map(|(k, t)| t.as_ref().map(|t| (k, t)))
        .collect();
    out.extend(def.fair.iter().map(|t| ("fair", t)));
    out.extend(def.observe.iter().map(|t| ("observe", t)));
    out.extend(def.of.iter().map(|t| ("of", t)));
    out
}

fn atom(b: &mut Builder, text: &Text, index: Option<i64>) -> One<usize> {
    let e = b.spec.expr(b.file, text)?;
    let node = b.system_scope(text, index).expect(&e, Ty::Bool)?;
    Ok(b.add_atom(node))
}

fn maybe(b: &mut Builder, text: Option<&Text>, index: Option<i64>) -> One<Option<usize>> {
    text.map(|t| atom(b, t, index)).transpose()
}

pub(crate) fn resolve(
    b: &mut Builder,
    def: &schema::Property,
    index: Option<i64>,
) -> One<Property> {
    let written = texts(def);
    let keys: Vec<&str> = written.iter().map(|(k, _)| *k).collect();
    let only = |allowed: &[&str]| keys.iter().all(|k| allowed.contains(k));
    let form = if let (Some(then), true) = (&def.always, only(&["always"])) {
        Form::Always {
            when: None,
            then: atom(b, then, index)?,
        }
    } else if let (Some(never), true) = (&def.never, only(&["never"])) {
        let e = b.spec.expr(b.file, never)?;
        let node = b.system_scope(never, index).expect(&e, Ty::Bool)?;
        Form::Always {
            when: None,
            then: b.add_atom(Node::Not(Box::new(node))),
        }
    } else if let (Some(when), Some(then), true) = (&def.when, &def.then, only(&["when", "then"])) {
        Form::Always {
            when: Some(atom(b, when, index)?),
            then: atom(b, then, index)?,
        }
    } else if let (Some(when), Some(goal), true) = (
        &def.when,
        &def.leads_to,
        only(&["when", "leads_to", "fair", "assuming"]),
    ) {
        if def.within.is_some() && keys.iter().any(|k| *k == "fair" || *k == "assuming") {
            return Err(b
                .spec
                .error(
                    b.file,
                    def.id.span(),
                    "a bounded response takes no fairness",
                )
                .help("leave out `within`, or `fair` and `assuming`"));
        }
        Form::LeadsTo {
            when: atom(b, when, index)?,
            goal: atom(b, goal, index)?,
            within: cycles(b, def.within.as_ref(), index)?,
            fair: def
                .fair
                .iter()
                .map(|t| atom(b, t, index))
                .collect::<One<_>>()?,
            assuming: maybe(b, def.assuming.as_ref(), index)?,
        }
    } else if let (Some(when), Some(holds), Some(unless), true) = (
        &def.when,
        &def.holds,
        &def.unless,
        only(&["when", "holds", "unless"]),
    ) {
        Form::Unless {
            when: atom(b, when, index)?,
            holds: atom(b, holds, index)?,
            unless: atom(b, unless, index)?,
        }
    } else if let (Some(goal), true) = (&def.can_always_reach, only(&["can_always_reach", "using"]))
    {
        Form::CanAlwaysReach {
            goal: atom(b, goal, index)?,
            using: maybe(b, def.using.as_ref(), index)?,
        }
    } else if let (Some(goal), true) = (&def.reachable, only(&["reachable"])) {
        Form::Reachable {
            goal: atom(b, goal, index)?,
        }
    } else if !def.observe.is_empty() && !def.of.is_empty() && only(&["observe", "of", "while"]) {
        independent(b, def, index)?
    } else {
        return Err(b
            .spec
            .error(b.file, def.id.span(), format!("property `{}` has no form with the keys {}", def.id.get_ref(), keys.join(", ")))
            .help("use: always | never | when + then | when + leads_to (+ within | fair, assuming) | when + holds + unless | can_always_reach (+ using) | reachable | observe + of (+ while)"));
    };
    if def.within.is_some() && !matches!(form, Form::LeadsTo { .. }) {
        return Err(b
            .spec
            .error(b.file, def.id.span(), "`within` belongs to `leads_to`")
            .help("remove it"));
    }
    let bounded = def.within.is_some();
    let stated = Stated {
        exactly: cycles(b, def.exactly.as_ref(), index)?,
        fastest: cycles(b, def.fastest.as_ref(), index)?,
    };
    if stated != Stated::default() && !bounded {
        return Err(b
            .spec
            .error(
                b.file,
                def.id.span(),
                "`exactly` and `fastest` belong to a response with `within`",
            )
            .help("add `within`, the bound that must hold, or remove them"));
    }
    let topic = def
        .topic
        .as_ref()
        .map(|t| topic(b, t, bounded))
        .transpose()?;
    let mut written: Vec<(String, String)> = written
        .iter()
        .map(|(k, t)| ((*k).to_owned(), t.get_ref().clone()))
        .collect();
    for (key, value) in [
        ("within", &def.within),
        ("exactly", &def.exactly),
        ("fastest", &def.fastest),
    ] {
        let text = value.as_ref().map(|v| scalar_text(v.get_ref()));
        written.extend(text.map(|text| (key.to_owned(), text)));
    }
    Ok(Property {
        id: def.id.get_ref().clone(),
        index,
        text: def.text.clone(),
        note: def.note.clone(),
        req: def.req.clone(),
        topic,
        form,
        stated,
        written,
    })
}

fn scalar_text(s: &Scalar) -> String {
    match s {
        Scalar::Bool(b) => b.to_string(),
        Scalar::Int(v) => v.to_string(),
        Scalar::Text(t) => t.clone(),
    }
}

fn topic(b: &Builder, text: &Text, bounded: bool) -> One<Topic> {
    match text.get_ref().as_str() {
        "fault" => Ok(Topic::Fault),
        "reaction" if bounded => Ok(Topic::Reaction),
        "reaction" => Err(b
            .spec
            .error(
                b.file,
                text.span(),
                "a reaction time needs a bounded response",
            )
            .help("use when + leads_to + within, or remove the topic")),
        other => Err(b
            .spec
            .error(b.file, text.span(), format!("`{other}` is no topic"))
            .help("write fault or reaction")),
    }
}

/// A number of cycles over parameters.
fn cycles(
    b: &mut Builder,
    value: Option<&Spanned<Scalar>>,
    index: Option<i64>,
) -> One<Option<Node>> {
    let Some(value) = value else {
        return Ok(None);
    };
    let text = Spanned::new(value.span(), scalar_text(value.get_ref()));
    let e = b.spec.expr(b.file, &text)?;
    let mut scope = b.system_scope(&text, index);
    scope.tense = crate::scope::Tense::None;
    let node = scope.expect(&e, Ty::Int)?;
    let (lo, hi) = scope.ranges.of(&node);
    if lo < 0 || hi > i128::from(u32::MAX) {
        return Err(scope
            .error(&e.span, format!("the bound can be {lo}..{hi} cycles"))
            .help("a bound is 0 or more; use parameters and numbers only"));
    }
    Ok(Some(node))
}

fn independent(b: &mut Builder, def: &schema::Property, index: Option<i64>) -> One<Form> {
    let mut of = Vec::new();
    for text in &def.of {
        let e = b.spec.expr(b.file, text)?;
        let mut scope = b.system_scope(text, index);
        let (_, node) = scope.resolve(&e, None)?;
        match node {
            Node::Cell(Space::Input, k) => of.push(k as usize),
            _ => {
                return Err(scope
                    .error(&e.span, format!("`{}` is not a free input", text.get_ref()))
                    .help("`of` lists ports that the environment chooses"));
            }
        }
    }
    let mut observe = Vec::new();
    for text in &def.observe {
        let e = b.spec.expr(b.file, text)?;
        let (_, node) = b.system_scope(text, index).resolve(&e, None)?;
        observe.push(b.add_observed(node));
    }
    let condition = maybe(b, def.while_.as_ref(), index)?;
    Ok(Form::Independent {
        observe,
        of,
        condition,
    })
}
