//! What a certificate is about, taken from the specification alone.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine as machine;

use crate::Failure;
use crate::format::{Header, Kind, Property, Source, Task, Verdict};

/// The systems of a specification file, or the runs of a machine file.
pub struct Subject {
    /// The header of a certificate that claims nothing.
    pub header: Header,
    /// The systems with their parameter values, one for each task of the header.
    pub bounds: Vec<Bound>,
}

fn unreadable(e: impl std::fmt::Display) -> Failure {
    Failure::Unreadable(format!("the specification cannot be read: {e}"))
}

impl Subject {
    /// Reads a specification or machine file with everything it uses.
    ///
    /// # Errors
    /// [`Failure::Unreadable`], with what is wrong.
    pub fn load(
        path: &Path,
        kind: Kind,
        readings: &BTreeMap<String, String>,
    ) -> Result<Self, Failure> {
        let mut subject = Self {
            header: Header {
                subject: path.display().to_string(),
                kind,
                readings: BTreeMap::new(),
                file: Vec::new(),
                task: Vec::new(),
            },
            bounds: Vec::new(),
        };
        let mut files: Vec<PathBuf> = Vec::new();
        match kind {
            Kind::Specification => {
                let spec = Spec::load(path).map_err(unreadable)?;
                files.extend(spec.files().map(PathBuf::from));
                for name in spec.systems() {
                    let bound = spec.system(name, None);
                    let bound = bind(bound, &BTreeMap::new(), readings)?;
                    subject.add(bound.system.text.clone(), bound);
                }
            }
            Kind::Machine => {
                let families = machine::families(path);
                let machine = machine::load(path, &families).map_err(unreadable)?;
                files.push(path.to_owned());
                files.extend(machine.data_files());
                let mut specs: BTreeMap<_, Spec> = BTreeMap::new();
                for run in &machine.runs {
                    let spec = match specs.entry((
                        &run.file,
                        &run.wiring,
                        run.half,
                        run.asks.as_ref().map(|asks| &asks.own.name),
                    )) {
                        Entry::Occupied(known) => known.into_mut(),
                        Entry::Vacant(new) => {
                            let spec = machine.spec(run).map_err(unreadable)?;
                            files.extend(spec.files().map(PathBuf::from));
                            new.insert(spec)
                        }
                    };
                    let cycle = u64::try_from(run.cycle).ok();
                    let bound = spec.system(&run.system, cycle);
                    subject.add(run.title.clone(), bind(bound, &run.params, readings)?);
                }
            }
        }
        let mut seen = Vec::new();
        for file in files {
            let known = file.canonicalize().unwrap_or_else(|_| file.clone());
            if !seen.contains(&known) {
                subject.header.file.push(source(&file)?);
                seen.push(known);
            }
        }
        Ok(subject)
    }

    fn add(&mut self, title: String, bound: Bound) {
        let system = &bound.system;
        self.header.readings.extend(bound.readings());
        let parameters = system.params.iter().zip(&bound.values);
        let property = |p: &stillpoint_lang::ir::Property| Property {
            id: label(p),
            text: p.text.clone(),
            written: (p.written.iter())
                .map(|(key, text)| format!("{key}: {text}"))
                .collect(),
            verdict: Verdict::Open,
            reason: String::new(),
        };
        self.header.task.push(Task {
            system: system.name.clone(),
            title,
            states: 0,
            faults: Vec::new(),
            parameters: parameters
                .filter(|(p, _)| p.reading.is_none())
                .map(|(p, value)| (p.var.name.clone(), *value))
                .collect(),
            property: system.properties.iter().map(property).collect(),
        });
        self.bounds.push(bound);
    }

    /// Whether a header speaks of this subject. Its path, the verdicts and the numbers of states are its own.
    ///
    /// # Errors
    /// [`Failure::Rejected`], with what differs.
    pub fn matches(&self, given: &Header) -> Result<(), Failure> {
        let differ = |what: String| Err(Failure::Rejected(what));
        let own = &self.header;
        for (a, b) in own.file.iter().zip(&given.file) {
            if a != b {
                return differ(format!(
                    "{} is not the file that the certificate was made for (SHA-256 {} there, {} here)",
                    a.name, b.sha256, a.sha256
                ));
            }
        }
        if own.file.len() != given.file.len() {
            return differ("the specification uses other files".to_owned());
        }
        if own.readings != given.readings {
            return differ("its readings are not those of the specification".to_owned());
        }
        if own.task.len() != given.task.len() {
            return differ(format!(
                "it speaks of {} systems, the specification of {}",
                given.task.len(),
                own.task.len()
            ));
        }
        for (a, b) in own.task.iter().zip(&given.task) {
            if (&a.system, &a.title) != (&b.system, &b.title) {
                return differ(format!(
                    "it speaks of {} in place of {}",
                    b.system, a.system
                ));
            }
            if a.parameters != b.parameters {
                return differ(format!("{}: other parameter values", a.system));
            }
            if a.property.len() != b.property.len() {
                return differ(format!(
                    "{}: it accounts for {} properties, the specification has {}",
                    a.system,
                    b.property.len(),
                    a.property.len()
                ));
            }
            for (p, q) in a.property.iter().zip(&b.property) {
                if (&p.id, &p.text, &p.written) != (&q.id, &q.text, &q.written) {
                    return differ(format!(
                        "{}: it states {} otherwise than the specification",
                        a.system, p.id
                    ));
                }
            }
        }
        Ok(())
    }
}

/// The id of a property, with the index of a copy.
pub(crate) fn label(property: &stillpoint_lang::ir::Property) -> String {
    let id = &property.id;
    property.index.map_or(id.clone(), |i| format!("{id}[{i}]"))
}

fn bind(
    system: Result<stillpoint_lang::ir::System, Diagnostics>,
    params: &BTreeMap<String, Vec<i64>>,
    readings: &BTreeMap<String, String>,
) -> Result<Bound, Failure> {
    Bound::new(system.map_err(unreadable)?, params, readings).map_err(unreadable)
}

fn source(path: &Path) -> Result<Source, Failure> {
    let bytes = stillpoint_lang::files::read(path)
        .map_err(|e| unreadable(format!("{}: {e}", path.display())))?;
    let digits = Sha256::digest(&bytes);
    Ok(Source {
        name: path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into(),
        sha256: format!("{digits:x}"),
    })
}
