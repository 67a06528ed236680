//! What stands in another file: a machine that takes the place of the one with its name, a property that is asked of a system.

use std::sync::Arc;

use toml::Spanned;

use crate::Spec;
use crate::diag::{Diagnostic, Result};
use crate::schema::{Property, Scalar};
use crate::written::Written;

impl Spec {
    /// Asks one thing of a system in place of its own properties: whenever `when` is TRUE, `then` is, in the same cycle or at most
    /// `within` cycles later.
    pub fn ask(&mut self, system: &str, id: &str, when: &str, then: &str, within: Option<i64>) {
        let text = |text: &str| Spanned::new(0..0, text.to_owned());
        let property = Property {
            id: text(id),
            text: match within {
                Some(_) => format!("after {when}: in time {then}"),
                None => format!("whenever {when}: {then}"),
            },
            when: Some(text(when)),
            then: within.is_none().then(|| text(then)),
            leads_to: within.map(|_| text(then)),
            within: within.map(|cycles| Spanned::new(0..0, Scalar::Int(cycles))),
            note: String::new(),
            req: Vec::new(),
            topic: None,
            always: None,
            never: None,
            exactly: None,
            fastest: None,
            fair: Vec::new(),
            assuming: None,
            holds: None,
            unless: None,
            can_always_reach: None,
            using: None,
            reachable: None,
            observe: Vec::new(),
            of: Vec::new(),
            while_: None,
        };
        if let Some(system) = self.systems.get_mut(system) {
            system.def.property = vec![property];
        }
    }

    /// Puts a machine of another file in the place of the one with its name, if there is one. Parameters and inputs that it
    /// leaves out are those of the machine it replaces: it does not use them.
    ///
    /// # Errors
    /// An output is missing.
    pub fn replace(
        &mut self,
        file: &str,
        source: &Arc<str>,
        name: &Spanned<String>,
        machine: &Written,
    ) -> Result<()> {
        let Some(old) = self.machines.get(name.get_ref()) else {
            return Ok(());
        };
        let mut def = machine.def().clone();
        let missing: Vec<&str> = (old.def.output.keys())
            .filter(|key| !def.output.contains_key(*key))
            .map(|key| key.get_ref().as_str())
            .collect();
        if !missing.is_empty() {
            let message = format!(
                "logic '{}' has no output {}",
                name.get_ref(),
                missing.join(", ")
            );
            return Err(Diagnostic::new(file, source, Some(name.span()), message)
                .label("in this table")
                .help(format!(
                    "add it under [logic.{}.output]: the systems of the family read it",
                    name.get_ref()
                ))
                .into());
        }
        for (key, port) in &old.def.input {
            def.input.entry(key.clone()).or_insert_with(|| port.clone());
        }
        for (key, port) in &old.def.param {
            def.param.entry(key.clone()).or_insert_with(|| port.clone());
        }
        self.put_machine(file, source, name, def);
        Ok(())
    }
}
