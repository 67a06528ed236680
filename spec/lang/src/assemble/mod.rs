//! Assembles a system: expands instances, binds parameters, wires ports, orders the steps.

use std::cell::Cell;
use std::collections::HashMap;

use crate::diag::{Diagnostic, Diagnostics, Result, nearest};
use crate::interval::Ranges;
use crate::ir::{Enum, Instance, Node, Param, Property, Reading, Rule, System, Ty, Var};
use crate::schema::{self, Text};
use crate::scope::{BUDGET, Meaning, Scope, Tense};
use crate::spec::Spec;
use crate::syntax::ast::Kind;

mod inline;
mod instances;
mod rules;
mod wiring;

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
    /// Lets and outputs whose definition is wrong: instance and name.
    pub failed: Vec<(String, String)>,
    /// Which instance a state cell or an output belongs to.
    state_owner: Vec<usize>,
    lazy_owner: Vec<Option<usize>>,
}

/// An instance before it is ordered.
struct Unit {
    name: String,
    machine: String,
    index: Option<i64>,
    /// All its names.
    names: Names,
    /// The names a rule may use: all but the outputs, which are evaluated after the rules.
    inner: Names,
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
                None => format!(
                    "it declares {}",
                    self.systems().collect::<Vec<_>>().join(", ")
                ),
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
                ports: ports
                    .map(|p| text(&format!("{machine}.{}", p.get_ref())))
                    .collect(),
            },
            unreached: schema::Map::new(),
            property: Vec::new(),
        };
        let mut builder = Builder::new(self, found.file, machine, &def, None)?;
        // Named after the file that declares it, whichever file includes that one.
        builder.sys.name = format!("{}/{machine}", self.sources[found.file].spec);
        builder.build(&def)
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
                enums,
                ..System::default()
            },
            options: HashMap::new(),
            names: HashMap::new(),
            members: HashMap::new(),
            arrays: HashMap::new(),
            errors: Vec::new(),
            failed: Vec::new(),
            state_owner: Vec::new(),
            lazy_owner: Vec::new(),
        };
        builder.header(def, cycle_us)?;
        Ok(builder)
    }

    fn header(&mut self, def: &schema::System, cycle_us: Option<u64>) -> Result<()> {
        if let (Some(cycle), None) = (&def.cycle, cycle_us) {
            let literal = format!("T#{}", cycle.get_ref().replace(' ', ""));
            match crate::syntax::parse_expr(&literal).map(|e| e.kind) {
                Ok(Kind::Time(us)) if us > 0 => self.sys.cycle_us = us,
                _ => self.errors.push(
                    self.spec
                        .error(
                            self.file,
                            cycle.span(),
                            format!("`{}` is not a cycle time", cycle.get_ref()),
                        )
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
                        .error(
                            e.file,
                            e.span.clone(),
                            format!("enum `{name}` has no values"),
                        )
                        .help("list its values in rising order"),
                );
            }
        }
        // Options of readings are parameters, so that one generated step serves every reading.
        for (id, reading) in &self.spec.readings {
            self.sys.readings.push(Reading {
                id: id.clone(),
                text: reading.def.text.clone(),
                options: reading
                    .def
                    .options
                    .iter()
                    .map(|o| o.get_ref().clone())
                    .collect(),
                note: reading.def.note.clone(),
            });
            for (k, option) in reading.def.options.iter().enumerate() {
                let name = option.get_ref().clone();
                let cell = self.sys.params.len() as u32;
                if self.options.insert(name.clone(), cell).is_some() {
                    self.errors.push(
                        self.spec
                            .error(
                                reading.file,
                                option.span(),
                                format!("option `{name}` stands twice"),
                            )
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
    fn machine_scope<'b>(
        &'b self,
        file: usize,
        text: &'b Text,
        names: &'b Names,
        tense: Tense,
    ) -> Scope<'b> {
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
            left: Cell::new(BUDGET),
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
            left: Cell::new(BUDGET),
        }
    }

    fn note<T>(&mut self, result: One<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(e) => {
                if !self.follows(&e.message) {
                    self.errors.push(e);
                }
                None
            }
        }
    }

    /// Whether an error only says that a name is missing whose own definition is wrong, which has been told.
    fn follows(&self, message: &str) -> bool {
        self.failed.iter().any(|(instance, name)| {
            message == format!("`{name}` is not known here")
                || message == format!("`{instance}` has nothing named `{name}`")
        })
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
            let made = self.variables(
                file,
                name.get_ref(),
                name.get_ref(),
                &port.0,
                &self.names.clone(),
            );
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
        for unit in &units {
            self.connect(unit, def, &wires);
        }
        let needs: Vec<Vec<usize>> = units
            .iter()
            .enumerate()
            .map(|(k, unit)| self.providers(k, unit))
            .collect();
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
                            head.strip_suffix('.')
                                .is_some_and(|h| i.name.split('[').next() == Some(h))
                        })
                })
            });
            if !known {
                self.errors.push(
                    self.spec
                        .error(
                            file,
                            name.span(),
                            format!("there is no rule `{}`", name.get_ref()),
                        )
                        .help("write \"instance.rule\" = \"reason\""),
                );
            }
            self.sys
                .unreached
                .push((name.get_ref().clone(), reason.clone()));
        }
        self.unused();
        self.fail_early()?;
        inline::trivial_wires(&mut self.sys);
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
}
