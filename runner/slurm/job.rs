//! A plan's unfinished work as stages of units. What several cells need is one unit of an early stage, so that no two
//! tasks compute it.

use crate::RunError;
use crate::plan::{CellIx, Plan};
use crate::stages::graph::{Graph, Part, State, Step};
use crate::study::Study;
use furrow_catalog::{Catalog, write_file};
use furrow_model::{CellKey, ExperienceId, ObjectId, TraversalId};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The stages, each behind the ones before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StageName {
    /// Codebooks, calibrated thresholds, generated experiences.
    Prepare,
    /// The words of traversals and experiences.
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
    /// The threshold of a live traversal's rig.
    Threshold(TraversalId),
    /// A generated experience.
    Make(ExperienceId),
    /// The words of a live traversal.
    LiveWords(TraversalId),
    /// The words of an experience.
    ExperienceWords(ExperienceId),
    /// A live traversal against the members of these cells.
    Verify(Vec<CellKey>),
    /// Outcomes.
    Cells(Vec<CellKey>),
}

/// What the submitting process hands to workers, as a file of the run's folder.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// Where the matrix file lies.
    pub path: PathBuf,
    /// Its text.
    pub source: String,
    /// The traversals that it is resolved against.
    pub traversals: Vec<TraversalId>,
    /// The generators.
    pub generators: Vec<ObjectId>,
    /// The stages with their tasks.
    pub stages: BTreeMap<StageName, Vec<Vec<Unit>>>,
}

/// Where a round's job lies.
pub(super) fn job_file(folder: &Path) -> PathBuf {
    folder.join("job.json")
}

/// Tasks of a stage at the most: enough for a large cluster, few enough that each start of the program is small beside
/// its work.
const TASKS: usize = 256;

impl Job {
    /// The unfinished cells of a study, `due`, and all that they need.
    pub fn of(catalog: &Catalog, study: &Study, path: &Path, due: &BTreeSet<CellKey>) -> Result<Self, RunError> {
        let part = |(setting, plan): (usize, _)| Part { setting, plan, cells: cells_among(plan, due) };
        let parts = study.parts.iter().enumerate().map(part).filter(|part| !part.cells.is_empty());
        let graph = Graph::new(parts.collect())?;
        let units = units_by_stage(&graph, &graph.states(catalog.objects())?);
        let sites = catalog.traversals()?.into_iter().filter(|row| row.site == study.matrix.site);
        Ok(Self {
            path: path.to_owned(),
            source: study.parts.first().map_or_else(String::new, |part| part.source.clone()),
            traversals: sites.map(|row| row.id).collect(),
            generators: catalog.generators()?.into_iter().map(|row| row.id).collect(),
            stages: units.into_iter().map(|(stage, units)| (stage, tasks_of(units))).collect(),
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

/// The cells of a plan that are among some keys.
fn cells_among(plan: &Plan, keys: &BTreeSet<CellKey>) -> Vec<CellIx> {
    CellIx::all(plan.cells.len()).filter(|cell| keys.contains(&plan.cell(*cell).key)).collect()
}

/// The steps of a graph that are not finished, as units.
fn units_by_stage(graph: &Graph<'_>, states: &[State]) -> BTreeMap<StageName, Vec<Unit>> {
    let mut stages: BTreeMap<StageName, Vec<Unit>> = BTreeMap::new();
    let (mut verified, mut cells) = (BTreeSet::new(), BTreeSet::new());
    for (node, state) in graph.nodes().iter().zip(states) {
        // With a generated experience its generator is measured: that may be missing where the experience is there.
        if state.is_finished() && !matches!(node.step, Step::Make(_)) {
            continue;
        }
        let Part { setting, plan, cells: asked } = graph.part_of(node);
        let (stage, what) = match node.step {
            Step::Codebook => (StageName::Prepare, What::Codebook),
            Step::Make(i) => (StageName::Prepare, What::Make(plan.contender(i).id)),
            Step::Threshold(live) => (StageName::Prepare, What::Threshold(plan.live(live).id)),
            Step::LiveWords(live) => (StageName::Words, What::LiveWords(plan.live(live).id)),
            Step::ContenderWords(i) => (StageName::Words, What::ExperienceWords(plan.contender(i).id)),
            // Matched and verified together, once for all members.
            Step::Verify(live, _) if verified.insert((*setting, live)) => {
                let of_live = asked.iter().map(|cell| plan.cell(*cell)).filter(|cell| cell.live == live);
                (StageName::Verify, What::Verify(of_live.map(|cell| cell.key).collect()))
            }
            Step::Match(..) | Step::Verify(..) => continue,
            Step::Cell(i) if cells.insert(plan.cell(i).key) => (StageName::Cells, What::Cells(vec![plan.cell(i).key])),
            Step::Cell(_) => continue,
        };
        stages.entry(stage).or_default().push(Unit { setting: *setting, what });
    }
    stages
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::graph::example;

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
    #[test]
    fn tasks_are_the_graphs_unfinished_steps() {
        let folder = tempfile::tempdir().unwrap();
        let catalog = Catalog::init(folder.path()).unwrap();
        let plan = example::plan();
        let keys: Vec<CellKey> = plan.cells.iter().map(|cell| cell.key).collect();
        let study = Study { matrix: plan.matrix.clone(), parts: vec![plan] };
        let job = |due: &[CellKey]| {
            let due = due.iter().copied().collect();
            Job::of(&catalog, &study, Path::new("m.toml"), &due).unwrap().stages
        };
        let tasks =
            |due: &[CellKey]| job(due).into_iter().map(|(stage, tasks)| (stage, tasks.len())).collect::<Vec<_>>();
        let all = [(StageName::Prepare, 3), (StageName::Words, 4), (StageName::Verify, 2), (StageName::Cells, 4)];
        assert_eq!(tasks(&keys), all);
        let verified: Vec<What> =
            job(&keys)[&StageName::Verify].iter().flatten().map(|unit| unit.what.clone()).collect();
        assert_eq!(verified, [What::Verify(keys[..3].to_vec()), What::Verify(keys[3..].to_vec())]);
        // The second live traversal meets the recorded experience only.
        let one = [(StageName::Prepare, 2), (StageName::Words, 2), (StageName::Verify, 1), (StageName::Cells, 1)];
        assert_eq!(tasks(&keys[3..]), one);
        assert_eq!(tasks(&[]), []);
    }
}
