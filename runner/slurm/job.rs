//! A plan's unfinished work as stages of units. What several cells need is one unit of an early stage, so that no two tasks compute it.

use crate::RunError;
use crate::inputs::codebook::codebook_key;
use crate::inputs::contender::Contender;
use crate::inputs::key::key_of;
use crate::inputs::traversals::LiveTraversal;
use crate::plan::{CellIx, LiveIx, Plan};
use crate::stages::codebook_of;
use crate::study::Study;
use furrow_catalog::{Catalog, write_file};
use furrow_model::{CellKey, ExperienceId, ObjectId, TraversalId};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The stages, each behind the ones before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StageName {
    /// Codebooks, calibrated thresholds, generated experiences.
    Prepare,
    /// The words of passes and experiences.
    Words,
    /// Matches, and their inliers.
    Verify,
    /// Decisions and evaluations: the outcomes.
    Cells,
}

impl StageName {
    /// All, in order.
    pub const ALL: [Self; 4] = [Self::Prepare, Self::Words, Self::Verify, Self::Cells];

    /// As job names and files spell it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Prepare => "prepare",
            Self::Words => "words",
            Self::Verify => "verify",
            Self::Cells => "cells",
        }
    }

    /// The stage of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stage| stage.name() == name)
    }
}

/// Something to compute in one setting of the matrix, by the ids that its plan knows it by.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unit {
    /// The setting's place in the matrix.
    pub setting: usize,
    /// What.
    pub what: What,
}

/// What a unit computes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum What {
    /// The codebook.
    Codebook,
    /// The threshold of a live pass' rig.
    Threshold(TraversalId),
    /// A generated experience.
    Make(ExperienceId),
    /// The words of a live pass.
    LiveWords(TraversalId),
    /// The words of an experience.
    ExperienceWords(ExperienceId),
    /// A live pass against the members of these cells.
    Verify(Vec<CellKey>),
    /// Outcomes.
    Cells(Vec<CellKey>),
}

/// What workers are told, as a file of the run's folder.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// Where the matrix file lies.
    pub path: PathBuf,
    /// Its text.
    pub source: String,
    /// The passes that it is resolved against.
    pub passes: Vec<TraversalId>,
    /// The generators.
    pub generators: Vec<ObjectId>,
    /// The stages with their tasks.
    pub stages: BTreeMap<StageName, Vec<Vec<Unit>>>,
}

/// Where a round's job lies.
pub(super) fn job_file(folder: &Path) -> PathBuf {
    folder.join("job.json")
}

/// Tasks of a stage at the most: enough for a large cluster, few enough that each start of the program is small beside its work.
const TASKS: usize = 256;

impl Job {
    /// The unfinished cells of a study, `due`, and all that they need.
    pub fn of(catalog: &Catalog, study: &Study, path: &Path, due: &BTreeSet<CellKey>) -> Result<Self, RunError> {
        let mut units = Units::default();
        for (setting, part) in study.parts.iter().enumerate() {
            let cells: Vec<CellIx> =
                CellIx::all(part.cells.len()).filter(|cell| due.contains(&part.cell(*cell).key)).collect();
            if !cells.is_empty() {
                units.add(catalog, setting, part, &cells)?;
            }
        }
        let sites = catalog.traversals()?.into_iter().filter(|row| row.site == study.matrix.site);
        Ok(Self {
            path: path.to_owned(),
            source: study.parts.first().map_or_else(String::new, |part| part.source.clone()),
            passes: sites.map(|row| row.id).collect(),
            generators: catalog.generators()?.into_iter().map(|row| row.id).collect(),
            stages: units.stages.into_iter().map(|(stage, units)| (stage, tasks_of(units))).collect(),
        })
    }

    /// The cells of a task.
    pub fn cells_of(&self, stage: StageName, task: usize) -> Vec<CellKey> {
        let units = self.stages.get(&stage).and_then(|tasks| tasks.get(task)).into_iter().flatten();
        let cells = |unit: &Unit| match &unit.what {
            What::Cells(cells) => cells.clone(),
            _ => Vec::new(),
        };
        units.flat_map(cells).collect()
    }

    /// The cells of all tasks.
    pub fn all_cells(&self) -> Vec<CellKey> {
        let tasks = self.stages.get(&StageName::Cells).map_or(0, Vec::len);
        (0..tasks).flat_map(|task| self.cells_of(StageName::Cells, task)).collect()
    }

    /// Reads the job of a round's folder.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        let path = job_file(folder);
        let wrong = |error: &dyn std::fmt::Display| RunError::Slurm(format!("{}: {error}", path.display()));
        let text = fs::read(&path).map_err(|error| wrong(&error))?;
        serde_json::from_slice(&text).map_err(|error| wrong(&error))
    }

    /// Writes the job of a round's folder.
    pub fn write(&self, folder: &Path) -> Result<(), RunError> {
        let text = serde_json::to_vec(self).map_err(|error| RunError::Slurm(error.to_string()))?;
        Ok(write_file(&job_file(folder), &text)?)
    }
}

/// Units in equal shares; the cells of a setting that come to lie in one share are one unit.
fn tasks_of(units: Vec<Unit>) -> Vec<Vec<Unit>> {
    let share = units.len().div_ceil(TASKS).max(1);
    units.chunks(share).map(merged).collect()
}

fn merged(units: &[Unit]) -> Vec<Unit> {
    let mut task: Vec<Unit> = Vec::new();
    for unit in units {
        match (task.last_mut(), &unit.what) {
            (Some(Unit { setting, what: What::Cells(cells) }), What::Cells(more)) if *setting == unit.setting => {
                cells.extend(more);
            }
            _ => task.push(unit.clone()),
        }
    }
    task
}

/// Units by stage; what several settings need is there once.
#[derive(Default)]
struct Units {
    stages: BTreeMap<StageName, Vec<Unit>>,
    seen: BTreeSet<ObjectId>,
}

impl Units {
    fn push(&mut self, stage: StageName, key: ObjectId, setting: usize, what: What) {
        if self.seen.insert(key) {
            self.stages.entry(stage).or_default().push(Unit { setting, what });
        }
    }

    /// The cells of a plan, by their places, and all that they need.
    fn add(&mut self, catalog: &Catalog, setting: usize, part: &Plan, cells: &[CellIx]) -> Result<(), RunError> {
        let Some(spec) = &part.codebook else { return Ok(()) };
        let (matrix, objects) = (&part.matrix, catalog.objects());
        let codebook = codebook_of(part).map(codebook_key);
        let lives: BTreeSet<LiveIx> = cells.iter().map(|cell| part.cell(*cell).live).collect();
        let members: Vec<&Contender> = part.members(cells).into_iter().map(|i| part.contender(i)).collect();
        if let Some(key) = codebook
            && objects.derived(key)?.is_none()
        {
            self.push(StageName::Prepare, key, setting, What::Codebook);
        }
        for contender in members.iter().filter(|contender| contender.making.is_some()) {
            self.push(StageName::Prepare, ObjectId(contender.id.0), setting, What::Make(contender.id));
        }
        for live in lives.iter().map(|live| part.live(*live)) {
            if matrix.verification.threshold.is_none() {
                let vocabulary: Vec<TraversalId> = part.vocabulary.iter().map(|pass| pass.id).collect();
                let key = key_of("threshold", &(vocabulary, &live.record.rig, spec.features));
                self.push(StageName::Prepare, key, setting, What::Threshold(live.id));
            }
            if let Some(codebook) = codebook {
                let key = key_of("live words", &(codebook, spec.features, live.id));
                self.push(StageName::Words, key, setting, What::LiveWords(live.id));
            }
        }
        for (contender, codebook) in members.iter().flat_map(|contender| codebook.map(|codebook| (contender, codebook)))
        {
            let key = key_of("words", &(codebook, spec.features, contender.id));
            self.push(StageName::Words, key, setting, What::ExperienceWords(contender.id));
        }
        for live in lives {
            let of_live: Vec<CellIx> = cells.iter().copied().filter(|cell| part.cell(*cell).live == live).collect();
            let key = recognised(part, part.live(live), codebook, &of_live);
            let keys = of_live.iter().map(|cell| part.cell(*cell).key).collect();
            self.push(StageName::Verify, key, setting, What::Verify(keys));
        }
        for cell in cells {
            let key = part.cell(*cell).key;
            self.push(StageName::Cells, ObjectId(key.0), setting, What::Cells(vec![key]));
        }
        Ok(())
    }
}

/// All that the answers of some cells' members to a live pass depend on.
fn recognised(part: &Plan, live: &LiveTraversal, codebook: Option<ObjectId>, cells: &[CellIx]) -> ObjectId {
    let members: Vec<ExperienceId> = part.members(cells).into_iter().map(|i| part.contender(i).id).collect();
    let recogniser = json!([format!("{:?}", part.matrix.localiser), part.matrix.keyframes]);
    key_of("verify", &(recogniser, codebook, live.id, members))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_shared_out_whole_and_once() {
        let key = |i: usize| CellKey(furrow_catalog::digest(&i.to_le_bytes()).0);
        let units: Vec<Unit> =
            (0..10_000).map(|i| Unit { setting: i / 100, what: What::Cells(vec![key(i)]) }).collect();
        let tasks = tasks_of(units);
        assert!(tasks.len() <= TASKS && tasks.len() > TASKS / 2, "{}", tasks.len());
        let cells: Vec<CellKey> = (tasks.iter().flatten())
            .flat_map(|unit| match &unit.what {
                What::Cells(cells) => cells.clone(),
                _ => Vec::new(),
            })
            .collect();
        assert_eq!(cells, (0..10_000).map(key).collect::<Vec<_>>());
        for unit in tasks.iter().flatten() {
            let What::Cells(cells) = &unit.what else { panic!("{unit:?}") };
            assert!(cells.iter().all(|cell| (0..100).any(|i| key(unit.setting * 100 + i) == *cell)));
        }
    }
}
