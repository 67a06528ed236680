//! Assembles a system: expands instances, binds parameters, wires ports, orders the steps.

use std::collections::HashMap;

use crate::diag::{Diagnostic, Diagnostics, Result, nearest};
use crate::interval::Ranges;
use crate::ir::{
    Enum, Form, Instance, Lazy, LazyKind, Node, Param, Property, Reading, Rule, Site, Space, State,
    Stmt, System, Ty, Var,
};
use crate::lang::ast::{self, Kind, TypeKind};
use crate::scope::{Meaning, Scope, Tense};
use crate::schema::{self, Scalar, Text};
use crate::spec::Spec;

type One<T> = std::result::Result<T, Diagnostic>;
pub(crate) type Names = HashMap<String, Meaning>;

/// Numbers outside this range do not fit a cell; the least 32-bit value marks "not yet evaluated".
const CELL: (i128, i128) = (-(i32::MAX as i128), i32::MAX as i128);

/// A system being assembled.
pub(crate) struct Builder<'a> {
    pub spec: &'a Spec,
    pub file: usize,
    pub sys: System,
    pub options: HashMap<String, u32>,
    /// Names of the system level: parameters and inputs.
    pub names: Names,
    /// `instance -> member -> meaning`.
    pub members: HashMap<String, Names>,
    pub arrays: HashMap<String, i64>,
    pub errors: Vec<Diagnostic>,
    /// Which instance a state cell or an output belongs to.
    state_owner: Vec<usize>,
    lazy_owner: Vec<Option<usize>>,
}

/// An instance before it is ordered.
struct Unit {
    name: String,
    machine: String,
    index: Option<i64>,
    names: Names,
    wires: Vec<(u32, String, usize)>,
    rules: Vec<Rule>,
    states: std::ops::Range<u32>,
}

impl Spec {
    /// Resolves the system `name`; `cycle_us` replaces the cycle time of its `T#` literals.
    ///
    /// # Errors
    /// Everything the language chapter calls an error that does not depend on parameter values.
    pub fn system(&self, name: &str, cycle_us: Option<u64>) -> Result<System> {
        let Some(found) = self.systems.get(name) else {
            let source = &self.sources[0];
            let help = match nearest(name, self.systems()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("it declares {}", self.systems().collect::<Vec<_>>().join(", ")),
            };
            let message = format!("declares no system `{name}`");
            return Err(Diagnostic::new(&source.name, &source.text, None, message)
                .help(help)
                .into());
        };
        Builder::new(self, found.file, name, &found.def, cycle_us)?.build(&found.def)
    }

    /// A system of one instance of `machine` with every input free: the machine on its own.
    ///
    /// # Errors
    /// As [`Spec::system`].
    pub fn open_machine(&self, machine: &str) -> Result<System> {
        let Some(found) = self.machines.get(machine) else {
            let source = &self.sources[0];
            let message = format!("declares no machine `{machine}`");
            return Err(Diagnostic::new(&source.name, &source.text, None, message).into());
        };
        let text = |s: &str| toml::Spanned::new(found.span.clone(), s.to_owned());
        let ports = found.def.input.keys();
        let def = schema::System {
            text: found.def.text.clone(),
            cycle: None,
            timers: None,
            note: String::new(),
            param: schema::Map::new(),
            input: schema::Map::new(),
            instance: std::iter::once((
                text(machine),
                schema::Instance {
                    machine: text(machine),
                    count: None,
                    param: schema::Map::new(),
                },
            ))
            .collect(),
            wire: schema::Map::new(),
            free: schema::Free {
                ports: ports.map(|p| text(&format!("{machine}.{}", p.get_ref()))).collect(),
            },
            unreached: schema::Map::new(),
            property: Vec::new(),
        };
        Builder::new(self, found.file, machine, &def, None)?.build(&def)
    }
}

impl<'a> Builder<'a> {
    fn new(
        spec: &'a Spec,
        file: usize,
        name: &str,
        def: &schema::System,
        cycle_us: Option<u64>,
    ) -> Result<Self> {
        let enums = spec
            .enums
            .iter()
            .map(|(n, d)| Enum {
                name: n.clone(),
                text: d.def.text.clone(),
                values: d.def.values.iter().map(|v| v.get_ref().clone()).collect(),
            })
            .collect();
        let mut builder = Self {
            spec,
            file,
            sys: System {
                name: format!("{}/{name}", spec.name),
                text: def.text.clone(),
                note: def.note.clone(),
                cycle_us: cycle_us.unwrap_or(1000),
                scaled: false,
                enums,
                readings: Vec::new(),
                params: Vec::new(),
                states: Vec::new(),
                inputs: Vec::new(),
                lazies: Vec::new(),
                instances: Vec::new(),
                sites: Vec::new(),
                atoms: Vec::new(),
                observed: Vec::new(),
                properties: Vec::new(),
                unreached: Vec::new(),
                warnings: Vec::new(),
            },
            options: HashMap::new(),
            names: HashMap::new(),
            members: HashMap::new(),
            arrays: HashMap::new(),
            errors: Vec::new(),
            state_owner: Vec::new(),
            lazy_owner: Vec::new(),
        };
        builder.header(def, cycle_us)?;
        Ok(builder)
    }

    fn header(&mut self, def: &schema::System, cycle_us: Option<u64>) -> Result<()> {
        if let (Some(cycle), None) = (&def.cycle, cycle_us) {
            let literal = format!("T#{}", cycle.get_ref().replace(' ', ""));
            match crate::lang::parse_expr(&literal).map(|e| e.kind) {
                Ok(Kind::Time(us)) if us > 0 => self.sys.cycle_us = us,
                _ => self.errors.push(
                    self.spec
                        .error(self.file, cycle.span(), format!("`{}` is not a cycle time", cycle.get_ref()))
                        .help("write for example \"12 ms\""),
                ),
            }
        }
        match def.timers.as_ref().map(|t| (t, t.get_ref().as_str())) {
            None | Some((_, "exact")) => {}
            Some((_, "scaled")) => self.sys.scaled = true,
            Some((t, other)) => self.errors.push(
                self.spec
                    .error(self.file, t.span(), format!("`timers` cannot be `{other}`"))
                    .help("use \"exact\" or \"scaled\""),
            ),
        }
        for (name, e) in &self.spec.enums {
            if e.def.values.is_empty() {
                self.errors.push(
                    self.spec
                        .error(e.file, e.span.clone(), format!("enum `{name}` has no values"))
                        .help("list its values in rising order"),
                );
            }
        }
        // Options of readings are parameters, so that one generated step serves every reading.
        for (id, reading) in &self.spec.readings {
            self.sys.readings.push(Reading {
                id: id.clone(),
                text: reading.def.text.clone(),
                options: reading.def.options.iter().map(|o| o.get_ref().clone()).collect(),
                note: reading.def.note.clone(),
            });
            for (k, option) in reading.def.options.iter().enumerate() {
                let name = option.get_ref().clone();
                let cell = self.sys.params.len() as u32;
                if self.options.insert(name.clone(), cell).is_some() {
                    self.errors.push(
                        self.spec
                            .error(reading.file, option.span(), format!("option `{name}` stands twice"))
                            .help("option names are unique over all readings"),
                    );
                }
                self.sys.params.push(Param {
                    var: Var {
                        name,
                        ty: Ty::Bool,
                        lo: Node::Const(0),
                        hi: Node::Const(1),
                        text: reading.def.text.clone(),
                        ids: Vec::new(),
                    },
                    default: Node::Const(i64::from(k == 0)),
                    reading: Some(id.clone()),
                });
            }
        }
        if self.errors.is_empty() {
            Ok(())
        } else {
            Err(Diagnostics(std::mem::take(&mut self.errors)))
        }
    }

    pub(crate) fn ranges(&self) -> Ranges<'_> {
        Ranges {
            params: &self.sys.params,
            states: &self.sys.states,
            inputs: &self.sys.inputs,
            lazies: &self.sys.lazies,
        }
    }

    /// Scope of a machine's own texts.
    fn machine_scope<'b>(&'b self, file: usize, text: &'b Text, names: &'b Names, tense: Tense) -> Scope<'b> {
        static NONE: std::sync::OnceLock<(HashMap<String, Names>, HashMap<String, i64>)> =
            std::sync::OnceLock::new();
        let (members, arrays) = NONE.get_or_init(Default::default);
        Scope {
            spec: self.spec,
            file,
            text,
            names,
            members,
            arrays,
            index: Vec::new(),
            options: &self.options,
            ranges: self.ranges(),
            tense,
            cycle_us: self.sys.cycle_us,
            calls: Vec::new(),
        }
    }

    /// Scope of wires and properties.
    pub(crate) fn system_scope<'b>(&'b self, text: &'b Text, index: Option<i64>) -> Scope<'b> {
        Scope {
            spec: self.spec,
            file: self.file,
            text,
            names: &self.names,
            members: &self.members,
            arrays: &self.arrays,
            index: index.map(|k| ("i".to_owned(), k)).into_iter().collect(),
            options: &self.options,
            ranges: self.ranges(),
            tense: Tense::Now,
            cycle_us: self.sys.cycle_us,
            calls: Vec::new(),
        }
    }

    fn note<T>(&mut self, result: One<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(e) => {
                self.errors.push(e);
                None
            }
        }
    }

    fn build(mut self, def: &schema::System) -> Result<System> {
        let file = self.file;
        for (name, port) in &def.param {
            let param = self.declare_param(file, name, &port.0, &self.names.clone());
            if let Some(meaning) = self.note(param) {
                self.names.insert(name.get_ref().clone(), meaning);
            }
        }
        for (name, port) in &def.input {
            let made = self.variables(file, name.get_ref(), name.get_ref(), &port.0, &self.names.clone());
            if let Some((vars, array)) = self.note(made) {
                let meaning = self.add_inputs(vars, array);
                self.names.insert(name.get_ref().clone(), meaning);
            }
        }
        let mut units = Vec::new();
        for (name, instance) in &def.instance {
            self.expand(name, instance, &mut units);
        }
        self.fail_early()?;
        let wires = self.wiring(def, &units);
        for (k, unit) in units.iter_mut().enumerate() {
            self.ports(k, unit, def, &wires);
        }
        self.fail_early()?;
        for (k, unit) in units.iter_mut().enumerate() {
            self.expressions(k, unit);
        }
        self.fail_early()?;
        let needs: Vec<Vec<usize>> =
            (0..units.len()).map(|k| self.connect(&units[k], def, &wires)).collect();
        for unit in &mut units {
            self.rules(unit);
        }
        self.fail_early()?;
        let order = self.order(&units, &needs)?;
        let mut slots: Vec<Option<Unit>> = units.into_iter().map(Some).collect();
        for k in order {
            if let Some(unit) = slots[k].take() {
                self.sys.instances.push(Instance {
                    name: unit.name,
                    machine: unit.machine,
                    rules: unit.rules,
                    states: unit.states,
                });
            }
        }
        for property in &def.property {
            self.property(property);
        }
        for (name, reason) in &def.unreached {
            let known = self.sys.instances.iter().any(|i| {
                i.rules.iter().any(|r| {
                    let plain = r.name.split('.').next_back().unwrap_or("");
                    *name.get_ref() == r.name
                        || name.get_ref().strip_suffix(plain).is_some_and(|head| {
                            head.strip_suffix('.').is_some_and(|h| i.name.split('[').next() == Some(h))
                        })
                })
            });
            if !known {
                self.errors.push(
                    self.spec
                        .error(file, name.span(), format!("there is no rule `{}`", name.get_ref()))
                        .help("write \"instance.rule\" = \"reason\""),
                );
            }
            self.sys.unreached.push((name.get_ref().clone(), reason.clone()));
        }
        self.unused();
        self.fail_early()?;
        Ok(self.sys)
    }

    /// Errors of one stage make the next meaningless.
    fn fail_early(&mut self) -> Result<()> {
        if self.errors.is_empty() {
            return Ok(());
        }
        let mut errors = std::mem::take(&mut self.errors);
        // Copies of one machine repeat its errors.
        let mut seen = std::collections::HashSet::new();
        errors.retain(|e| seen.insert((e.file.clone(), e.span.clone(), e.message.clone())));
        errors.sort_by_key(|e| (e.file.clone(), e.span.as_ref().map_or(0, |s| s.start)));
        Err(Diagnostics(errors))
    }

    /// A scalar given where an expression is meant.
    fn scalar_expr(&self, file: usize, value: &toml::Spanned<Scalar>) -> One<(ast::Expr, Text)> {
        let (written, quoted) = match value.get_ref() {
            Scalar::Bool(b) => (if *b { "TRUE" } else { "FALSE" }.to_owned(), false),
            Scalar::Int(v) => (v.to_string(), false),
            Scalar::Text(t) => (t.clone(), true),
        };
        let text = toml::Spanned::new(value.span(), written);
        let mut e = self.spec.expr(file, &text)?;
        if !quoted {
            e.span = 0..0;
        }
        Ok((e, text))
    }

    fn constant(
        &self,
        file: usize,
        value: &toml::Spanned<Scalar>,
        want: Ty,
        names: &Names,
    ) -> One<Node> {
        let (e, text) = self.scalar_expr(file, value)?;
        self.machine_scope(file, &text, names, Tense::None).expect(&e, want)
    }

    /// The cells of a declaration: one, or those of an array with its lower index bound.
    fn variables(
        &self,
        file: usize,
        full: &str,
        written: &str,
        port: &schema::Port,
        names: &Names,
    ) -> One<(Vec<Var>, Option<i64>)> {
        let ty = self.spec.type_of(file, &port.ty)?;
        if crate::lang::is_keyword(written) || written.is_empty() {
            return Err(self
                .spec
                .error(file, port.ty.span(), format!("`{written}` cannot be a name"))
                .help("names start with a letter and are not keywords"));
        }
        let (element, array) = match &ty.kind {
            TypeKind::Array(lo, hi, element) => (element.as_ref(), Some((*lo, *hi))),
            _ => (&ty, None),
        };
        let mut scope = self.machine_scope(file, &port.ty, names, Tense::None);
        let (ty, lo, hi) = match &element.kind {
            TypeKind::Bool => (Ty::Bool, Node::Const(0), Node::Const(1)),
            TypeKind::Enum(name) => match self.spec.enums.get_full(name) {
                Some((k, _, e)) => {
                    let top = e.def.values.len() as i64 - 1;
                    (Ty::Enum(k), Node::Const(0), Node::Const(top))
                }
                None => {
                    let known = self.spec.enums.keys().map(String::as_str);
                    let help = nearest(name, known.chain(["BOOL", "INT", "TIME"]))
                        .map_or("declare it under [enum]".to_owned(), |n| format!("did you mean `{n}`?"));
                    return Err(scope.error(&element.span, format!("there is no type `{name}`")).help(help));
                }
            },
            TypeKind::Int(Some((lo, hi))) | TypeKind::Time(Some((lo, hi))) => {
                let (a, b) = (scope.expect(lo, Ty::Int)?, scope.expect(hi, Ty::Int)?);
                let (least, most) = (scope.ranges.of(&a), scope.ranges.of(&b));
                if least.0 < CELL.0 || most.1 > CELL.1 {
                    return Err(scope
                        .error(&element.span, format!("range {}..{} does not fit 32 bits", least.0, most.1))
                        .help("use a range within -2147483647..2147483647"));
                }
                if least.0 > most.1 {
                    return Err(scope
                        .error(&element.span, format!("range {}..{} is empty", least.0, most.1))
                        .help("the lower bound comes first"));
                }
                (Ty::Int, a, b)
            }
            _ => {
                return Err(scope
                    .error(&element.span, "a variable needs a range")
                    .help("write INT(0..7) or TIME(0..100)"));
            }
        };
        let var = |name: String| Var {
            name,
            ty,
            lo: lo.clone(),
            hi: hi.clone(),
            text: port.text.clone(),
            ids: port.id.clone(),
        };
        Ok(match array {
            None => (vec![var(full.to_owned())], None),
            Some((first, last)) => (
                (first..=last).map(|k| var(format!("{full}[{k}]"))).collect(),
                Some(first),
            ),
        })
    }

    fn declare_param(&mut self, file: usize, name: &Text, port: &schema::Port, names: &Names) -> One<Meaning> {
        let (vars, array) = self.variables(file, name.get_ref(), name.get_ref(), port, names)?;
        let Some(default) = &port.default else {
            return Err(self
                .spec
                .error(file, name.span(), format!("parameter `{}` has no default", name.get_ref()))
                .help("add `default = ...` so that the file can be checked on its own"));
        };
        let base = self.sys.params.len() as u32;
        let (ty, len) = (vars[0].ty, vars.len() as u32);
        let value = self.constant(file, default, ty, names)?;
        let (lo, hi) = (self.ranges().of(&vars[0].lo).0, self.ranges().of(&vars[0].hi).1);
        let range = self.ranges().of(&value);
        if range.1 < lo || range.0 > hi {
            return Err(self
                .spec
                .error(file, default.span(), format!("default {} is outside {lo}..{hi}", range.0))
                .help(format!("give `{}` a default of its type", name.get_ref())));
        }
        for var in vars {
            self.sys.params.push(Param {
                var,
                default: value.clone(),
                reading: None,
            });
        }
        Ok(match array {
            None => Meaning::Value(ty, Node::Cell(Space::Param, base)),
            Some(first) => Meaning::Array(ty, Space::Param, base, first, len),
        })
    }

    fn add_inputs(&mut self, vars: Vec<Var>, array: Option<i64>) -> Meaning {
        let base = self.sys.inputs.len() as u32;
        let (ty, len) = (vars[0].ty, vars.len() as u32);
        self.sys.inputs.extend(vars);
        match array {
            None => Meaning::Value(ty, Node::Cell(Space::Input, base)),
            Some(first) => Meaning::Array(ty, Space::Input, base, first, len),
        }
    }

    /// Makes the units of an instance (array): parameters and state.
    fn expand(&mut self, name: &Text, def: &schema::Instance, units: &mut Vec<Unit>) {
        let Some(machine) = self.spec.machines.get(def.machine.get_ref()) else {
            let known = self.spec.machines();
            let help = nearest(def.machine.get_ref(), known)
                .map_or("declare it under [machine]".to_owned(), |n| format!("did you mean `{n}`?"));
            self.errors.push(
                self.spec
                    .error(self.file, def.machine.span(), format!("there is no machine `{}`", def.machine.get_ref()))
                    .help(help),
            );
            return;
        };
        let base = name.get_ref();
        let count = def.count.as_ref().map(|c| *c.get_ref());
        if let (Some(count), Some(written)) = (count, &def.count) {
            if !(1..=64).contains(&count) {
                self.errors.push(
                    self.spec
                        .error(self.file, written.span(), format!("count {count} is not possible"))
                        .help("1 to 64 instances"),
                );
                return;
            }
            self.arrays.insert(base.clone(), count);
        }
        for key in def.param.keys() {
            if !machine.def.param.contains_key(key) {
                let known = machine.def.param.keys().map(|k| k.get_ref().as_str());
                let help = nearest(key.get_ref(), known)
                    .map_or("its machine has no such parameter".to_owned(), |n| format!("did you mean `{n}`?"));
                self.errors.push(
                    self.spec
                        .error(self.file, key.span(), format!("machine `{}` has no parameter `{}`", def.machine.get_ref(), key.get_ref()))
                        .help(help),
                );
            }
        }
        for index in 1..=count.unwrap_or(1) {
            let full = if count.is_some() { format!("{base}[{index}]") } else { base.clone() };
            let mut unit = Unit {
                name: full,
                machine: def.machine.get_ref().clone(),
                index: count.map(|_| index),
                names: HashMap::new(),
                wires: Vec::new(),
                rules: Vec::new(),
                states: 0..0,
            };
            for (param, port) in &machine.def.param {
                let meaning = self.bind_param(machine.file, param, &port.0, def, &unit);
                if let Some(meaning) = self.note(meaning) {
                    unit.names.insert(param.get_ref().clone(), meaning);
                }
            }
            let first = self.sys.states.len() as u32;
            for (state, port) in &machine.def.state {
                let made = self.add_state(machine.file, state, &port.0, &unit, units.len());
                if let Some(meaning) = self.note(made) {
                    if unit.names.insert(state.get_ref().clone(), meaning).is_some() {
                        self.twice(machine.file, state);
                    }
                }
            }
            unit.states = first..self.sys.states.len() as u32;
            units.push(unit);
        }
    }

    fn twice(&mut self, file: usize, name: &Text) {
        self.errors.push(
            self.spec
                .error(file, name.span(), format!("`{}` is declared twice in this machine", name.get_ref()))
                .help("parameters, inputs, state, lets and outputs share one name space"),
        );
    }

    fn bind_param(
        &mut self,
        file: usize,
        param: &Text,
        port: &schema::Port,
        def: &schema::Instance,
        unit: &Unit,
    ) -> One<Meaning> {
        let given = def.param.iter().find(|(k, _)| k.get_ref() == param.get_ref());
        if let Some((_, value)) = given {
            let (vars, _) = self.variables(file, param.get_ref(), param.get_ref(), port, &unit.names)?;
            let (e, text) = self.scalar_expr(self.file, value)?;
            if let Kind::Name(n) = &e.kind {
                if let Some(m @ Meaning::Array(..)) = self.names.get(n) {
                    return Ok(m.clone());
                }
            }
            let mut scope = self.system_scope(&text, unit.index);
            scope.tense = Tense::None;
            let node = scope.expect(&e, vars[0].ty)?;
            return Ok(Meaning::Value(vars[0].ty, node));
        }
        if let Some(meaning) = self.names.get(param.get_ref()) {
            let (vars, array) = self.variables(file, param.get_ref(), param.get_ref(), port, &unit.names)?;
            let same = match meaning {
                Meaning::Value(ty, _) => *ty == vars[0].ty && array.is_none(),
                Meaning::Array(ty, Space::Param, _, first, len) => {
                    *ty == vars[0].ty && array == Some(*first) && vars.len() == *len as usize
                }
                _ => false,
            };
            if !same {
                return Err(self
                    .spec
                    .error(file, param.span(), format!("parameter `{}` has another type than the system's", param.get_ref()))
                    .help("bind it in the instance: `param = { name = \"...\" }`"));
            }
            return Ok(meaning.clone());
        }
        let meaning = self.declare_param(file, param, port, &unit.names)?;
        self.names.insert(param.get_ref().clone(), meaning.clone());
        Ok(meaning)
    }

    fn add_state(&mut self, file: usize, name: &Text, port: &schema::Port, unit: &Unit, owner: usize) -> One<Meaning> {
        let full = format!("{}.{}", unit.name, name.get_ref());
        let (vars, array) = self.variables(file, &full, name.get_ref(), port, &unit.names)?;
        let ty = vars[0].ty;
        let Some(written) = &port.init else {
            return Err(self
                .spec
                .error(file, name.span(), format!("state `{}` has no initial value", name.get_ref()))
                .help("add `init = ...`, or `init = \"ANY\"` for every value"));
        };
        let any = matches!(written.get_ref(), Scalar::Text(t) if t == "ANY");
        let init = if any { None } else { Some(self.constant(file, written, ty, &unit.names)?) };
        if let Some(init) = &init {
            let (a, b) = (self.ranges().of(init), (self.ranges().of(&vars[0].lo).0, self.ranges().of(&vars[0].hi).1));
            if a.1 < b.0 || a.0 > b.1 {
                return Err(self
                    .spec
                    .error(file, written.span(), format!("initial value {} is outside {}..{}", a.0, b.0, b.1))
                    .help("choose a value of the type"));
            }
        }
        let base = self.sys.states.len() as u32;
        let len = vars.len() as u32;
        for var in vars {
            self.sys.states.push(State { var, init: init.clone() });
            self.state_owner.push(owner);
        }
        Ok(Meaning::State(ty, base, array.map(|first| (first, len))))
    }

    /// Ports by full name, from `[wire]` and `[free]`: the key, or none for a free port, and its place.
    fn wiring(&mut self, def: &schema::System, units: &[Unit]) -> HashMap<String, (Option<usize>, Text)> {
        let mut out: HashMap<String, (Option<usize>, Text)> = HashMap::new();
        let wires = def.wire.keys().enumerate().map(|(k, key)| (Some(k), key));
        let free = def.free.ports.iter().map(|key| (None, key));
        for (wire, key) in wires.chain(free) {
            let mut hits = 0;
            for unit in units {
                let indexed = unit.name.rsplit_once('[').map(|(base, _)| format!("{base}[i]"));
                let written = key.get_ref().replace(' ', "");
                let port = [Some(unit.name.clone()), indexed]
                    .into_iter()
                    .flatten()
                    .find_map(|n| written.strip_prefix(&format!("{n}.")).map(str::to_owned));
                let Some(port) = port else { continue };
                let machine = &self.spec.machines[&unit.machine].def;
                if !machine.input.keys().any(|k| *k.get_ref() == port) {
                    continue;
                }
                hits += 1;
                let full = format!("{}.{port}", unit.name);
                if out.insert(full.clone(), (wire, key.clone())).is_some() {
                    self.errors.push(
                        self.spec
                            .error(self.file, key.span(), format!("port `{full}` is bound twice"))
                            .help("wire it once, or declare it free, not both"),
                    );
                }
            }
            if hits == 0 {
                let ports: Vec<String> = units
                    .iter()
                    .flat_map(|u| {
                        let machine = &self.spec.machines[&u.machine].def;
                        machine.input.keys().map(move |k| format!("{}.{}", u.name, k.get_ref()))
                    })
                    .collect();
                let help = nearest(key.get_ref(), ports.iter().map(String::as_str)).map_or(
                    "write `instance.port` or `instance[i].port`".to_owned(),
                    |n| format!("did you mean `{n}`?"),
                );
                self.errors.push(
                    self.spec
                        .error(self.file, key.span(), format!("`{}` is not an input port", key.get_ref()))
                        .help(help),
                );
            }
        }
        out
    }

    /// Gives every input port a meaning: a free input, or a reserved named expression.
    fn ports(
        &mut self,
        _owner: usize,
        unit: &mut Unit,
        def: &schema::System,
        wires: &HashMap<String, (Option<usize>, Text)>,
    ) {
        let machine = &self.spec.machines[&unit.machine];
        for (port, declared) in &machine.def.input {
            let full = format!("{}.{}", unit.name, port.get_ref());
            let made = self.variables(machine.file, &full, port.get_ref(), &declared.0, &unit.names);
            let Some((vars, array)) = self.note(made) else { continue };
            let meaning = match wires.get(&full) {
                None => {
                    self.errors.push(
                        self.spec
                            .error(self.file, self.spec.systems.get(self.sys.name.rsplit('/').next().unwrap_or("")).map_or(0..0, |s| s.span.clone()), format!("port `{full}` is not wired"))
                            .help("wire it under [system.NAME.wire], or list it under free.ports"),
                    );
                    continue;
                }
                Some((None, _)) => self.add_inputs(vars, array),
                Some((Some(_), key)) if array.is_some() => {
                    self.errors.push(
                        self.spec
                            .error(self.file, key.span(), "an array port cannot be wired")
                            .help("make it free, or use scalar ports"),
                    );
                    continue;
                }
                Some((Some(k), _)) => {
                    let (lo, hi) = (self.ranges().of(&vars[0].lo).0, self.ranges().of(&vars[0].hi).1);
                    let lazy = self.sys.lazies.len();
                    self.sys.lazies.push(Lazy {
                        name: full.clone(),
                        kind: LazyKind::Wire,
                        ty: vars[0].ty,
                        value: Node::Const(0),
                        lo: lo as i64,
                        hi: hi as i64,
                        ids: Vec::new(),
                        text: String::new(),
                    });
                    self.lazy_owner.push(None);
                    let written = def.wire.get_index(*k).map(|(key, _)| key.get_ref().clone());
                    unit.wires.push((lazy as u32, written.unwrap_or_default(), *k));
                    Meaning::Value(vars[0].ty, Node::Lazy(lazy as u32))
                }
            };
            if unit.names.insert(port.get_ref().clone(), meaning).is_some() {
                self.twice(machine.file, port);
            }
        }
    }

    /// Lets and outputs.
    fn expressions(&mut self, owner: usize, unit: &mut Unit) {
        let machine = &self.spec.machines[&unit.machine];
        let lets = machine.def.lets.iter().map(|x| (x, LazyKind::Let));
        let outputs = machine.def.output.iter().map(|x| (x, LazyKind::Output));
        for ((name, def), kind) in lets.chain(outputs) {
            let tense = if kind == LazyKind::Let { Tense::Start } else { Tense::Now };
            let made = (|| {
                let e = self.spec.expr(machine.file, &def.0.value)?;
                let mut scope = self.machine_scope(machine.file, &def.0.value, &unit.names, tense);
                let (ty, node) = scope.resolve(&e, None)?;
                let (lo, hi) = scope.ranges.of(&node);
                let (lo, hi) = match ty {
                    Ty::Int => (lo, hi),
                    Ty::Bool => (0, 1),
                    Ty::Enum(k) => (0, self.spec.enums[k].def.values.len() as i128 - 1),
                };
                if lo < CELL.0 || hi > CELL.1 {
                    return Err(scope
                        .error(&e.span, format!("`{}` can be {lo}..{hi}, more than 32 bits", name.get_ref()))
                        .help("narrow the operands, or use LIMIT"));
                }
                Ok((ty, node, lo as i64, hi as i64))
            })();
            let Some((ty, value, lo, hi)) = self.note(made) else { continue };
            let index = self.sys.lazies.len() as u32;
            self.sys.lazies.push(Lazy {
                name: format!("{}.{}", unit.name, name.get_ref()),
                kind,
                ty,
                value,
                lo,
                hi,
                ids: def.0.id.clone(),
                text: def.0.text.clone(),
            });
            self.lazy_owner.push(Some(owner));
            let meaning = Meaning::Value(ty, Node::Lazy(index));
            if unit.names.insert(name.get_ref().clone(), meaning).is_some() {
                self.twice(machine.file, name);
            }
        }
        self.members.insert(unit.name.clone(), unit.names.clone());
    }

    /// Fills in the wired expressions of a unit; returns the units whose step must come before.
    fn connect(
        &mut self,
        unit: &Unit,
        def: &schema::System,
        _wires: &HashMap<String, (Option<usize>, Text)>,
    ) -> Vec<usize> {
        let mut needs = Vec::new();
        for (lazy, _, k) in &unit.wires {
            let Some((_, text)) = def.wire.get_index(*k) else { continue };
            let (ty, lo, hi, port) = {
                let l = &self.sys.lazies[*lazy as usize];
                (l.ty, i128::from(l.lo), i128::from(l.hi), l.name.clone())
            };
            let made = (|| {
                let e = self.spec.expr(self.file, text)?;
                let mut scope = self.system_scope(text, unit.index);
                let node = scope.expect(&e, ty)?;
                let (a, b) = scope.ranges.of(&node);
                if a < lo || b > hi {
                    return Err(scope
                        .error(&e.span, format!("the wire can be {a}..{b}, port `{port}` takes {lo}..{hi}"))
                        .help("widen the port, or use LIMIT"));
                }
                Ok(node)
            })();
            if let Some(node) = self.note(made) {
                self.providers(&node, &mut needs);
                self.sys.lazies[*lazy as usize].value = node;
            }
        }
        needs
    }

    /// The units whose outputs or new state an expression reads.
    fn providers(&self, node: &Node, out: &mut Vec<usize>) {
        node.visit(&mut |n| match n {
            Node::Cell(Space::Now, k) | Node::Element { space: Space::Now, base: k, .. } => {
                out.extend(self.state_owner.get(*k as usize).copied());
            }
            Node::Lazy(k) => out.extend(self.lazy_owner.get(*k as usize).copied().flatten()),
            _ => {}
        });
    }

    /// Data-flow order: providers first, else the order of the file.
    fn order(&self, units: &[Unit], needs: &[Vec<usize>]) -> Result<Vec<usize>> {
        let mut done = vec![false; units.len()];
        let mut order = Vec::new();
        while order.len() < units.len() {
            let next = (0..units.len()).find(|k| !done[*k] && needs[*k].iter().all(|n| done[*n]));
            let Some(k) = next else {
                let stuck: Vec<&str> =
                    (0..units.len()).filter(|k| !done[*k]).map(|k| units[k].name.as_str()).collect();
                let span = self
                    .spec
                    .systems
                    .get(self.sys.name.rsplit('/').next().unwrap_or(""))
                    .map_or(0..0, |s| s.span.clone());
                return Err(self
                    .spec
                    .error(self.file, span, format!("combinational loop between {}", stuck.join(", ")))
                    .help("break it with PREV(...) in one of the wires")
                    .into());
            };
            done[k] = true;
            order.push(k);
        }
        Ok(order)
    }

    fn rules(&mut self, unit: &mut Unit) {
        let machine = &self.spec.machines[&unit.machine];
        for rule in &machine.def.rule {
            let name = format!("{}.{}", unit.name, rule.name.get_ref());
            if rule.id.is_empty() && rule.note.is_empty() {
                self.errors.push(
                    self.spec
                        .error(machine.file, rule.name.span(), format!("rule `{}` names no requirement", rule.name.get_ref()))
                        .help("add `id = [...]`, or a `note` that says why it has none"),
                );
            }
            let when = (|| {
                let e = self.spec.expr(machine.file, &rule.when)?;
                self.machine_scope(machine.file, &rule.when, &unit.names, Tense::Start).expect(&e, Ty::Bool)
            })();
            let when = self.note(when);
            let statements = self.spec.effect(machine.file, &rule.then);
            let Some(statements) = self.note(statements) else { continue };
            let mut then = Vec::new();
            for statement in &statements {
                let made = self.statement(machine.file, &rule.then, statement, unit, &name);
                if let Some(made) = self.note(made) {
                    then.push(made);
                }
            }
            if let Some(when) = when {
                unit.rules.push(Rule {
                    name,
                    ids: rule.id.clone(),
                    note: rule.note.clone(),
                    when,
                    then,
                });
            }
        }
    }

    fn statement(&mut self, file: usize, text: &Text, s: &ast::Stmt, unit: &Unit, rule: &str) -> One<Stmt> {
        match s {
            ast::Stmt::If(branches, rest) => {
                let mut out = Vec::new();
                for (guard, body) in branches {
                    let g = self.machine_scope(file, text, &unit.names, Tense::Now).expect(guard, Ty::Bool)?;
                    out.push((g, self.body(file, text, body, unit, rule)?));
                }
                Ok(Stmt::If(out, self.body(file, text, rest, unit, rule)?))
            }
            ast::Stmt::Assign(target, value) => {
                let mut scope = self.machine_scope(file, text, &unit.names, Tense::Now);
                let (name_expr, index) = match &target.kind {
                    Kind::Index(base, index) => (base.as_ref(), Some(index.as_ref())),
                    _ => (target, None),
                };
                let Kind::Name(name) = &name_expr.kind else {
                    return Err(scope.error(&target.span, "this cannot be assigned").help("assign to a state variable"));
                };
                let (ty, base, array) = match unit.names.get(name) {
                    Some(Meaning::State(ty, base, array)) => (*ty, *base, *array),
                    Some(_) => {
                        return Err(scope
                            .error(&target.span, format!("`{name}` is not a state variable"))
                            .help("only state can be assigned; declare it under `state`"));
                    }
                    None => {
                        let help = nearest(name, unit.names.keys().map(String::as_str))
                            .map_or("declare it under `state`".to_owned(), |n| format!("did you mean `{n}`?"));
                        return Err(scope.error(&target.span, format!("`{name}` is not known here")).help(help));
                    }
                };
                let index = match (index, array) {
                    (Some(i), Some((lo, len))) => Some((scope.index_node(i, lo, len)?, lo, len)),
                    (None, None) => None,
                    (Some(_), None) => {
                        return Err(scope.error(&target.span, format!("`{name}` is not an array")).help("leave out the index"));
                    }
                    (None, Some(_)) => {
                        return Err(scope.error(&target.span, format!("`{name}` is an array")).help("assign to its elements"));
                    }
                };
                let node = scope.expect(value, ty)?;
                let (a, b) = scope.ranges.of(&node);
                let var = &self.sys.states[base as usize].var;
                // The range that surely lies within the variable's for every parameter value.
                let sure = (scope.ranges.of(&var.lo).1, scope.ranges.of(&var.hi).0);
                let most = (scope.ranges.of(&var.lo).0, scope.ranges.of(&var.hi).1);
                if ty == Ty::Int && (b < most.0 || a > most.1) {
                    return Err(scope
                        .error(&value.span, format!("the value is {a}..{b}, `{name}` holds {}..{}", most.0, most.1))
                        .help("widen the variable's range, or limit the value"));
                }
                let checked = ty == Ty::Int && (a < sure.0 || b > sure.1) && node != var.hi && node != var.lo;
                let site = self.sys.sites.len() as u32;
                self.sys.sites.push(Site { name: format!("{rule}: {name}") });
                Ok(Stmt::Assign { base, index, value: node, checked, site })
            }
        }
    }

    fn body(&mut self, file: usize, text: &Text, list: &[ast::Stmt], unit: &Unit, rule: &str) -> One<Vec<Stmt>> {
        list.iter().map(|s| self.statement(file, text, s, unit, rule)).collect()
    }

    fn property(&mut self, def: &schema::Property) {
        for index in crate::property::copies(self, def) {
            let made = crate::property::resolve(self, def, index);
            if let Some(p) = self.note::<Property>(made) {
                self.sys.properties.push(p);
            }
        }
    }

    pub(crate) fn add_atom(&mut self, node: Node) -> usize {
        if let Some(k) = self.sys.atoms.iter().position(|a| *a == node) {
            return k;
        }
        self.sys.atoms.push(node);
        self.sys.atoms.len() - 1
    }

    pub(crate) fn add_observed(&mut self, node: Node) -> usize {
        self.sys.observed.push(node);
        self.sys.observed.len() - 1
    }

    /// Warnings: inputs and named expressions that nothing reads.
    fn unused(&mut self) {
        let mut inputs = vec![false; self.sys.inputs.len()];
        let mut lazies = vec![false; self.sys.lazies.len()];
        self.sys.nodes(&mut |n| match n {
            Node::Cell(Space::Input, k) => inputs[*k as usize] = true,
            Node::Element { space: Space::Input, base, len, .. } => {
                inputs[*base as usize..(*base + *len) as usize].fill(true);
            }
            Node::Lazy(k) => lazies[*k as usize] = true,
            _ => {}
        });
        for p in &self.sys.properties {
            if let Form::Independent { of, .. } = &p.form {
                of.iter().for_each(|k| inputs[*k] = true);
            }
        }
        for (input, read) in self.sys.inputs.iter().zip(inputs) {
            if !read {
                self.sys.warnings.push(format!("input `{}` is never read", input.name));
            }
        }
        for (lazy, read) in self.sys.lazies.iter().zip(lazies) {
            let what = match lazy.kind {
                LazyKind::Let => "let",
                LazyKind::Wire => "input",
                LazyKind::Output => continue, // an output is for the reader of reports too
            };
            if !read {
                self.sys.warnings.push(format!("{what} `{}` is never read", lazy.name));
            }
        }
    }
}
