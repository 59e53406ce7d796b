//! A run on a cluster: what its tasks finished and what failed, entered into the catalogue.

use super::job::StageName;
use super::queue::Queue;
use super::report::{Report, tail};
use super::round::Round;
use crate::RunError;
use crate::generation::stage::make_contender;
use crate::plan::CellIx;
use crate::progress::Progress;
use crate::stages::codebook::trained;
use crate::stages::conduct::Conduct;
use crate::stages::shared::codebook_of;
use crate::study::run::CellResult;
use crate::study::{Failed, Study, StudyResult};
use furrow_catalog::index::TimingRow;
use furrow_catalog::{Catalog, digest};
use furrow_model::{CellKey, RunId};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A run on a cluster, as the submitting process sees it.
pub(super) struct Run<'a> {
    pub catalog: &'a Catalog,
    pub study: &'a Study,
    pub path: &'a Path,
    pub run: RunId,
    pub queue: &'a Queue,
    pub conduct: Conduct,
    pub progress: Progress<'a>,
}

impl Run<'_> {
    /// What the run's jobs are called: equal runs of other stores are other jobs.
    pub fn name(&self) -> String {
        let root = std::fs::canonicalize(self.catalog.root()).unwrap_or_else(|_| self.catalog.root().to_owned());
        let store = digest(root.as_os_str().as_encoded_bytes());
        format!("furrow-{}-{}", self.run.short(), store.short())
    }

    /// The cells that no worker has finished yet.
    pub fn unfinished(&self, asked: &BTreeSet<CellKey>) -> Result<BTreeSet<CellKey>, RunError> {
        let objects = self.catalog.objects();
        let unfinished = asked.iter().map(|key| Ok((*key, objects.derived(furrow_model::ObjectId(key.0))?.is_none())));
        let unfinished = unfinished.collect::<Result<Vec<_>, RunError>>()?;
        Ok(unfinished.into_iter().filter(|(_, unfinished)| *unfinished).map(|(key, _)| key).collect())
    }

    /// A round has ended: what its tasks took is entered, once; the cells that its tasks say have failed, with the
    /// reason and their log's last lines.
    pub fn end(&self, round: &Round) -> Result<BTreeMap<CellKey, String>, RunError> {
        let reports: Vec<_> =
            round.reports().filter_map(|(stage, task, report)| Some((stage, task, report?))).collect();
        if !round.has_ended() {
            self.catalog.enter_timings(&timings(reports.iter().map(|(_, _, report)| report)))?;
            round.close()?;
        }
        let mut failed = BTreeMap::new();
        for (stage, task, report) in reports.iter().filter(|(_, _, report)| !report.is_whole()) {
            let said = match tail(&round.folder, *stage, *task) {
                log if log.is_empty() => log,
                log => format!("\n  the end of the log of task {} {task}:{log}", stage.name()),
            };
            failed.extend(report.failed.iter().map(|(key, reason)| (*key, format!("{reason}{said}"))));
            if let Some(fault) = &report.fault {
                // Of an early stage, everything behind it fails with it; where the others go on, their own tasks tell.
                let keys: Vec<CellKey> = match stage {
                    StageName::Cells => round.job.cells_of(*stage, *task),
                    _ if self.conduct.keep_going => Vec::new(),
                    _ => round.job.all_cells(),
                };
                keys.into_iter().for_each(|key| _ = failed.entry(key).or_insert_with(|| format!("{fault}{said}")));
            }
        }
        let unfinished = self.unfinished(&failed.keys().copied().collect())?;
        failed.retain(|key, _| unfinished.contains(key));
        Ok(failed)
    }

    /// Enters what workers finished, and what they made on the way.
    pub fn settle(
        &self,
        asked: &BTreeSet<CellKey>,
        failed: BTreeMap<CellKey, String>,
    ) -> Result<StudyResult, RunError> {
        let asked_now: Vec<CellKey> = asked.iter().copied().collect();
        self.catalog.collect_outcomes(&asked_now)?;
        let mut result = StudyResult::of(self.run);
        for part in &self.study.parts {
            let mut fresh = Vec::new();
            for (i, cell) in CellIx::all(part.cells.len()).zip(&part.cells) {
                let known = match (&cell.outcome, asked.contains(&cell.key)) {
                    (Some(outcome), _) => Some((outcome.clone(), true)),
                    (None, true) => self.catalog.outcome(cell.key)?.map(|outcome| (outcome, false)),
                    (None, false) => None,
                };
                if let Some((outcome, cached)) = known {
                    let outcome = outcome.named(&cell.label);
                    result.cells.push((part.setting.clone(), CellResult { outcome, cached }));
                    fresh.extend((!cached).then_some(i));
                } else if let Some(reason) = failed.get(&cell.key) {
                    result.failed.push(Failed::of(part, cell, reason.clone()));
                } else {
                    result.left += 1;
                }
            }
            result.add_doubts(self.enter_made(part, &fresh)?);
        }
        result.enter_failures(self.catalog, &asked_now)?;
        result.contrasted(self.catalog, self.study)
    }

    /// Enters the codebook and the generated experiences behind some finished cells of a plan, which workers left as
    /// objects; what the quality gate doubts of them.
    fn enter_made(&self, part: &crate::Plan, finished: &[CellIx]) -> Result<Vec<String>, RunError> {
        if finished.is_empty() {
            return Ok(Vec::new());
        }
        if let Some(spec) = codebook_of(part) {
            trained(self.catalog, spec)?;
        }
        let mut doubts = Vec::new();
        for contender in part.members(finished).into_iter().map(|i| part.contender(i)) {
            doubts.extend(make_contender(self.catalog, contender, self.progress)?.1);
        }
        Ok(doubts)
    }
}

/// What tasks took, by kind of stage.
fn timings<'a>(reports: impl Iterator<Item = &'a Report>) -> Vec<TimingRow> {
    let mut rows: BTreeMap<(String, u32), (u64, f64)> = BTreeMap::new();
    for report in reports {
        for (stage, work) in report.work.iter().filter(|(_, work)| work.units > 0) {
            let sum = rows.entry((stage.clone(), report.threads)).or_default();
            *sum = (sum.0 + work.units, sum.1 + work.seconds);
        }
    }
    let row =
        |((stage, threads), (units, seconds))| TimingRow { stage, subject: String::new(), units, seconds, threads };
    rows.into_iter().map(row).collect()
}
