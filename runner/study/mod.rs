//! A whole matrix file: every setting planned, then run one after the other, as one run; then the contrasts of its
//! cells.

pub mod compare;
pub mod estimate;

pub mod reproduce;
pub mod run;
pub mod work;

use crate::evaluate::contrast::{Contrasts, contrasts};
use crate::inputs::traversals::Known;
use crate::matrix::{Facts, Matrix, Rule, Setting};
use crate::plan::{Plan, PlannedCell, plan};
use crate::progress::{Progress, Stage};
use crate::stages::conduct::Conduct;
use crate::stages::matching::open;
use crate::study::run::{CellResult, compute_cells, record};
use crate::study::work::{Clock, Work, rows};
use crate::{Blocked, RunError};
use furrow_catalog::Catalog;
use furrow_catalog::index::{FailureRow, TimingRow};
use furrow_catalog::records::{RunContrasts, RunRecord, record_id};
use furrow_model::{CellKey, ObjectId, Outcome, RunId, TraversalId};
use std::collections::{BTreeMap, BTreeSet};

/// A matrix file resolved against the store.
pub struct Study {
    /// The matrix as written.
    pub matrix: Matrix,
    /// Each setting with its cells, in the matrix' order; a cell or contrast that two settings come to is in the first
    /// only.
    pub parts: Vec<Plan>,
}

/// What a run gave.
#[derive(Debug, Clone)]
pub struct StudyResult {
    /// Its id: equal plans have equal ids.
    pub run: RunId,
    /// Finished cells with their settings, in the matrix' order.
    pub cells: Vec<(String, CellResult)>,
    /// Cells that failed.
    pub failed: Vec<Failed>,
    /// Cells that were not asked for and are not finished.
    pub left: usize,
    /// Which contenders beat which, where the matrix asks.
    pub contrasts: Contrasts,
    /// What the quality gate doubts of the generators that were used.
    pub doubts: Vec<String>,
    /// What was computed, by kind of stage.
    pub work: BTreeMap<String, Work>,
}

impl StudyResult {
    /// Nothing yet.
    pub(crate) fn of(run: RunId) -> Self {
        Self {
            run,
            cells: Vec::new(),
            failed: Vec::new(),
            left: 0,
            contrasts: Contrasts::default(),
            doubts: Vec::new(),
            work: BTreeMap::new(),
        }
    }

    /// Each doubt once.
    pub(crate) fn add_doubts(&mut self, doubts: Vec<String>) {
        for doubt in doubts {
            if !self.doubts.contains(&doubt) {
                self.doubts.push(doubt);
            }
        }
    }

    /// Remembers which of the cells that were tried failed, and that the others did not.
    pub(crate) fn enter_failures(&self, catalog: &Catalog, tried: &[CellKey]) -> Result<(), RunError> {
        let row = |failed: &Failed| FailureRow { cell: failed.key, run: self.run, reason: failed.cell.reason.clone() };
        Ok(catalog.enter_failures(tried, &self.failed.iter().map(row).collect::<Vec<_>>())?)
    }

    /// With the contrasts of its cells that the study asks for.
    pub(crate) fn contrasted(mut self, catalog: &Catalog, study: &Study) -> Result<Self, RunError> {
        let outcomes: Vec<&Outcome> = self.cells.iter().map(|(_, cell)| &cell.outcome).collect();
        self.contrasts = contrasts(catalog.objects(), study.contrasts(), &outcomes)?;
        Ok(self)
    }
}

/// A cell that failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failed {
    /// Its key.
    pub key: CellKey,
    /// Its setting.
    pub setting: String,
    /// Its live slot, label and why it failed.
    pub cell: Blocked,
}

impl Failed {
    /// A cell of a plan.
    pub(crate) fn of(part: &Plan, cell: &PlannedCell, reason: String) -> Self {
        let blocked = Blocked { live: part.live(cell.live).record.slot, experience: cell.label.clone(), reason };
        Self { key: cell.key, setting: part.setting.clone(), cell: blocked }
    }
}

/// Resolves all settings of a matrix.
///
/// # Errors
/// [`RunError::Plan`] where the matrix makes no sense for this store at all; what only stops single cells is in
/// [`Plan::blocked`].
pub fn study(catalog: &Catalog, matrix: Matrix, source: &str) -> Result<Study, RunError> {
    let mut study = some_settings(catalog, matrix, source, |_| true)?;
    let (mut seen, mut asked) = (BTreeSet::new(), Vec::new());
    for part in &mut study.parts {
        // Within a setting, several names of one cell are the user's wish; across settings it is what the axis does not
        // touch.
        let before = seen.clone();
        part.cells.retain(|cell| !before.contains(&cell.key));
        seen.extend(part.cells.iter().map(|cell| cell.key));
        if let Some(contrasts) = &mut part.contrasts {
            contrasts.pairs.retain(|pair| pair.cells.is_empty() || !asked.contains(pair));
            asked.extend(contrasts.pairs.iter().cloned());
        }
    }
    Ok(study)
}

/// Resolves some settings of a matrix, by their places; each part then has all its cells, also those that it shares
/// with another.
pub(crate) fn some_settings(
    catalog: &Catalog,
    matrix: Matrix,
    source: &str,
    wanted: impl Fn(usize) -> bool,
) -> Result<Study, RunError> {
    let known = Known::default();
    let settings = matrix.settings().into_iter().enumerate().filter(|(place, _)| wanted(*place));
    let planned = |(_, setting): (usize, Setting)| {
        let recogniser = open(&setting.matrix)?;
        plan(catalog, &known, setting, source.to_owned(), recogniser)
    };
    let parts = settings.map(planned).collect::<Result<_, _>>()?;
    Ok(Study { matrix, parts })
}

impl Study {
    /// All cells with their parts.
    pub fn cells(&self) -> impl Iterator<Item = (&Plan, &PlannedCell)> {
        self.parts.iter().flat_map(|part| part.cells.iter().map(move |cell| (part, cell)))
    }

    /// The contrasts that the settings ask for.
    pub fn contrasts(&self) -> impl Iterator<Item = &RunContrasts> {
        self.parts.iter().filter_map(|part| part.contrasts.as_ref())
    }

    /// What the settings warn of, each once.
    pub fn warnings(&self) -> Vec<String> {
        let mut all: Vec<String> = Vec::new();
        for warning in self.parts.iter().flat_map(|part| &part.warnings) {
            if !all.contains(warning) {
                all.push(warning.clone());
            }
        }
        let met: BTreeSet<usize> = self.parts.iter().flat_map(|part| part.rules_met.iter().copied()).collect();
        let rules = self.matrix.include.iter().chain(&self.matrix.exclude).enumerate();
        let idle = rules.filter(|(place, _)| !met.contains(place));
        all.extend(
            idle.map(|(_, rule)| format!("the rule {rule} applies to no cell: is a slot or name in it misspelt?")),
        );
        all
    }

    /// Leaves only the cells that some of the rules apply to asked for, and shows what is blocked among them; how many
    /// of the unfinished that are.
    pub fn only(&mut self, rules: &[Rule]) -> usize {
        for Plan { matrix, blocked, .. } in &mut self.parts {
            let facts = |cell: &Blocked| Facts::of(matrix, &cell.live.to_string(), &cell.experience);
            blocked.retain(|cell| rules.iter().any(|rule| rule.applies(&facts(cell))));
        }
        self.ask(|plan, cell| rules.iter().any(|rule| rule.applies(&plan.facts(cell))))
    }

    /// Leaves only the cells that failed when they were last tried asked for; how many that are.
    ///
    /// # Errors
    /// Where the catalogue cannot be read.
    pub fn only_failed(&mut self, catalog: &Catalog) -> Result<usize, RunError> {
        let failed: BTreeSet<CellKey> = catalog.failures()?.into_iter().map(|row| row.cell).collect();
        Ok(self.ask(|_, cell| failed.contains(&cell.key)))
    }

    fn ask(&mut self, wanted: impl Fn(&Plan, &PlannedCell) -> bool) -> usize {
        for part in &mut self.parts {
            let asked: Vec<bool> = part.cells.iter().map(|cell| cell.asked && wanted(part, cell)).collect();
            part.cells.iter_mut().zip(asked).for_each(|(cell, asked)| cell.asked = asked);
        }
        self.cells().filter(|(_, cell)| cell.is_due()).count()
    }

    /// The run's record: what was asked, cell by cell.
    pub fn record(&self, catalog: &Catalog) -> Result<RunRecord, RunError> {
        let mut parts = self.parts.iter().map(record);
        let mut all = parts.next().unwrap_or_else(|| RunRecord {
            name: self.matrix.name.clone(),
            site: self.matrix.site.clone(),
            source: String::new(),
            figures: Vec::new(),
            cells: Vec::new(),
            blocked: Vec::new(),
            traversals: Vec::new(),
            generators: Vec::new(),
            contrasts: Vec::new(),
        });
        for part in parts {
            all.cells.extend(part.cells);
            all.blocked.extend(part.blocked);
            all.contrasts.extend(part.contrasts);
        }
        (all.traversals, all.generators) = self.inputs(catalog)?;
        Ok(all)
    }

    /// The traversals and generators that the cells come from, by id.
    fn inputs(&self, catalog: &Catalog) -> Result<(Vec<TraversalId>, Vec<ObjectId>), RunError> {
        let (mut traversals, mut generators) = (BTreeSet::new(), BTreeSet::new());
        for part in &self.parts {
            traversals.extend(part.vocabulary.iter().chain(&part.lives).map(|traversal| traversal.id));
            for contender in &part.contenders {
                traversals.insert(TraversalId(record_id(&contender.traversal)?.0));
                generators.extend(contender.making.as_ref().map(|making| making.generator));
            }
        }
        let known: BTreeSet<ObjectId> = catalog.generators()?.into_iter().map(|row| row.id).collect();
        for id in generators.intersection(&known) {
            let record = catalog.generator(*id)?;
            traversals.extend(record.source.iter().chain(&record.target).flat_map(|domain| &domain.traversals));
        }
        Ok((traversals.into_iter().collect(), generators.into_iter().collect()))
    }
}

/// Runs every cell that is asked for and not finished, and enters the run.
///
/// # Errors
/// [`RunError`], unless asked to keep going: then what failed is in the result. What was finished before stays
/// finished.
pub fn run(
    catalog: &Catalog,
    study: &Study,
    conduct: Conduct,
    progress: Progress<'_>,
) -> Result<StudyResult, RunError> {
    // The run is known from its plan: entered first, it shows in `status` also where it is killed.
    let run = catalog.enter_run(&study.record(catalog)?)?;
    let clock = Clock::new(progress);
    let mut result = StudyResult::of(run);
    let ended = study.parts.iter().try_for_each(|part| run_part(catalog, part, conduct, &clock, &mut result));
    result.work = clock.work();
    catalog.enter_timings(&rows(&result.work))?;
    let tried: Vec<CellKey> = study.cells().filter(|(_, cell)| cell.is_due()).map(|(_, cell)| cell.key).collect();
    result.enter_failures(catalog, &tried)?;
    ended?;
    result.contrasted(catalog, study)
}

fn run_part(
    catalog: &Catalog,
    part: &Plan,
    conduct: Conduct,
    clock: &Clock<'_>,
    result: &mut StudyResult,
) -> Result<(), RunError> {
    let trained_before = clock.work_of(Stage::VocabularyTraining);
    let cells = compute_cells(catalog, part, conduct, &|progress| clock.hear(progress));
    enter_training(catalog, part, clock.work_of(Stage::VocabularyTraining), trained_before)?;
    result.failed.extend(cells.failed.iter().map(|(i, reason)| Failed::of(part, part.cell(*i), reason.clone())));
    cells.ended?;
    let finished = cells.results.iter().flatten().count();
    result.left += cells.results.len() - finished - cells.failed.len();
    result.cells.extend(cells.results.into_iter().flatten().map(|cell| (part.setting.clone(), cell)));
    result.add_doubts(cells.doubts);
    Ok(())
}

/// Remembers what training a codebook took, by its id; where a killed training was taken up, what its rest took.
fn enter_training(catalog: &Catalog, part: &Plan, now: Work, before: Work) -> Result<(), RunError> {
    let Some(spec) = &part.codebook else { return Ok(()) };
    let Some(id) = catalog.objects().derived(crate::inputs::codebook::codebook_key(spec)?)? else { return Ok(()) };
    if now.units == before.units {
        return Ok(());
    }
    let row = TimingRow {
        stage: "codebook".to_owned(),
        subject: id.to_string(),
        units: spec.images.len() as u64,
        seconds: now.seconds - before.seconds,
        threads: rayon::current_num_threads() as u32,
    };
    Ok(catalog.enter_timings(&[row])?)
}
