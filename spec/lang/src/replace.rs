//! A machine that stands in another file and takes the place of the one with its name.

use std::sync::Arc;

use toml::Spanned;

use crate::Spec;
use crate::diag::{Diagnostic, Result};
use crate::written::Written;

impl Spec {
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
