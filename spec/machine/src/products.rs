//! Products of a whole machine, which are too large to be enumerated: what the proof engines are asked beside the explorations.

use serde::Deserialize;

use super::explore_file::ExploreData;
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

impl Machine {
    /// The products of this machine; none where the family has no `product.toml`.
    ///
    /// # Errors
    /// The file is wrong.
    pub fn products(&self) -> Result<Vec<Run>> {
        let family = &self.basis.family;
        if !files::is_file(&family.folder.join(FILE)) {
            return Ok(Vec::new());
        }
        let file = DataFile::read(&family.folder, FILE, "products")?;
        let data: FileData = file.parse()?;
        let mut check = file.check();
        let explore = check.explores(data.explore, &family.known);
        check.findings.finish(())?;
        let (judged, logic) = (&self.basis.judged, &self.basis.logic);
        Ok(runs::plan(family, &explore, self.parts(), judged, logic)?.runs)
    }
}
