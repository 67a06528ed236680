//! Products of parts of a machine, which are too large to be enumerated: what the proof engines are asked beside the explorations.

use std::path::Path;

use serde::Deserialize;

use super::explore_file::ExploreData;
use super::family::{Explore, Known};
use super::ground::DataFile;
use super::{Machine, Run, runs};
use stillpoint_lang::diag::Result;
use stillpoint_lang::files;

/// Where a family has them.
const FILE: &str = "product.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileData {
    #[serde(default)]
    explore: Vec<ExploreData>,
}

/// The products of the family in `folder`; none where it has no `product.toml`.
///
/// # Errors
/// The file is wrong.
pub(super) fn load(folder: &Path, known: &Known) -> Result<Vec<Explore>> {
    if !files::is_file(&folder.join(FILE)) {
        return Ok(Vec::new());
    }
    let file = DataFile::read(folder, FILE, "products")?;
    let data: FileData = file.parse()?;
    let mut check = file.check();
    let explore = check.explores(data.explore, known);
    check.findings.finish(explore)
}

impl Machine {
    /// The products of this machine; none where the family has none for it.
    ///
    /// # Errors
    /// Faults of the family's data.
    pub fn products(&self) -> Result<Vec<Run>> {
        let family = &self.basis.family;
        let (judged, logic) = (&self.basis.judged, &self.basis.logic);
        Ok(runs::plan(family, &family.products, self.parts(), judged, logic)?.runs)
    }
}
