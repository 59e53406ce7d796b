//! The latest run of each experiment.

use super::verdict::{Measured, Verdict};
use crate::RunError;
use crate::evaluate::contrast::contrasts;
use furrow_catalog::Catalog;
use furrow_model::{CellKey, Difference, Experience, ExperienceId, ExperienceKind, ObjectId, Outcome, RunId, TimeSlot};
use std::collections::BTreeMap;

/// What was run, by experiment: the first word of its matrix' name, such as `X10`.
#[derive(Debug, Clone, Default)]
pub struct Evidence {
    /// The runs.
    pub runs: BTreeMap<String, Ran>,
}

/// A run of an experiment.
#[derive(Debug, Clone)]
pub struct Ran {
    /// The run.
    pub run: RunId,
    /// The matrix' name.
    pub name: String,
    /// The site.
    pub site: String,
    /// Cells without an outcome: blocked or not finished.
    pub missing: usize,
    /// The finished cells.
    pub cells: Vec<Cell>,
    /// Good localisations of one cell less those of another, where the matrix contrasts them on one live traversal.
    pub(super) contrasts: BTreeMap<[CellKey; 2], Difference>,
}

/// A finished cell.
#[derive(Debug, Clone)]
pub struct Cell {
    /// What tells its setting from the matrix' others.
    pub setting: String,
    /// Its outcome, under its own name.
    pub outcome: Outcome,
    /// Where it is one generated experience: what it was made from.
    pub(super) child: Option<Child>,
}

/// A generated experience.
#[derive(Debug, Clone, Copy)]
pub(super) struct Child {
    pub parent: ExperienceId,
    pub parent_slot: TimeSlot,
    pub mimics: TimeSlot,
}

impl Evidence {
    /// The latest run of every matrix whose name begins with an experiment's.
    pub(super) fn of(catalog: &Catalog) -> Result<Self, RunError> {
        let mut runs = BTreeMap::new();
        // The latest come last and take the place of those before.
        for row in catalog.runs()? {
            let id = row.matrix.split_whitespace().next().unwrap_or_default().trim_end_matches(':').to_owned();
            let number = id.strip_prefix('X').and_then(|number| number.parse::<u32>().ok());
            if number.is_some_and(|number| (1..=15).contains(&number)) {
                runs.insert(id, row.id);
            }
        }
        let ran = |(experiment, run): (String, RunId)| Ok((experiment, Ran::of(catalog, run)?));
        Ok(Self { runs: runs.into_iter().map(ran).collect::<Result<_, RunError>>()? })
    }

    /// The cells of some experiments; those that were not run have none.
    pub(super) fn cells<'a>(&'a self, experiments: &'a [&'a str]) -> impl Iterator<Item = &'a Cell> + Clone {
        experiments.iter().filter_map(|id| self.runs.get(*id)).flat_map(|ran| &ran.cells)
    }

    /// Whether a cell has more good localisations than another, and both numbers in words: by the paired interval of a
    /// contrast where a run has one and the traversal is long enough for it, else by the intervals that the two
    /// outcomes carry.
    pub(super) fn more_good(&self, of: &Cell, over: &Cell) -> (Verdict, String) {
        let pair = [of.outcome.key, over.outcome.key];
        let (own, other) = (Measured::good(&of.outcome), Measured::good(&over.outcome));
        let contrast = self.runs.values().find_map(|ran| ran.contrasts.get(&pair));
        match contrast.and_then(|difference| difference.interval.map(|interval| (difference, interval))) {
            Some((difference, [low, high])) => {
                let paired = Measured { value: difference.difference, low, high };
                let both = format!("{:.0} against {:.0}, paired {}", own.value, other.value, paired.signed());
                (difference.verdict.into(), both)
            }
            None => (own.exceeds(other), format!("{} against {}", own.in_words(), other.in_words())),
        }
    }
}

impl Ran {
    fn of(catalog: &Catalog, run: RunId) -> Result<Self, RunError> {
        let record = catalog.run(run)?;
        let mut cells = Vec::new();
        for cell in &record.cells {
            if let Some(outcome) = catalog.outcome(cell.key)? {
                let outcome = outcome.named(&cell.experience);
                let child = child_of(catalog, &outcome)?;
                cells.push(Cell { setting: cell.setting.clone(), outcome, child });
            }
        }
        let missing = record.cells.len() - cells.len() + record.blocked.len();
        let outcomes: Vec<&Outcome> = cells.iter().map(|cell| &cell.outcome).collect();
        let found = contrasts(catalog.objects(), &record.contrasts, &outcomes)?.found.into_iter();
        let of_one_pass = found.filter_map(|contrast| match contrast.live.as_slice() {
            [traversal] => Some((traversal.cells, contrast.good)),
            _ => None,
        });
        Ok(Self { run, name: record.name, site: record.site, missing, contrasts: of_one_pass.collect(), cells })
    }
}

fn child_of(catalog: &Catalog, outcome: &Outcome) -> Result<Option<Child>, RunError> {
    let [member] = outcome.members.as_slice() else { return Ok(None) };
    let record: Experience = furrow_catalog::records::read(catalog.objects(), ObjectId(member.id.0))?;
    let ExperienceKind::Generated { parent, mimics, .. } = record.kind else { return Ok(None) };
    Ok(Some(Child { parent, parent_slot: catalog.experience(parent)?.slot, mimics }))
}

impl Cell {
    /// Whether it is one recorded experience.
    pub(super) fn is_recorded(&self) -> bool {
        self.outcome.members.len() == 1 && self.child.is_none()
    }

    /// The slot of its one experience.
    pub(super) fn slot(&self) -> Option<TimeSlot> {
        self.outcome.members.first().filter(|_| self.outcome.members.len() == 1).map(|member| member.slot)
    }

    /// Whether another cell asks the same live traversal in the same setting.
    pub(super) fn beside(&self, other: &Cell) -> bool {
        self.outcome.live_traversal == other.outcome.live_traversal
            && self.setting == other.setting
            && self.outcome.codebook == other.outcome.codebook
            && self.outcome.threshold_inliers == other.outcome.threshold_inliers
    }
}
