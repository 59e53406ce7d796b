//! A matrix file resolved against the store: every setting planned, and which of the cells are asked for.

use crate::inputs::traversals::Known;
use crate::matrix::{Facts, Matrix, Rule, Setting};
use crate::plan::{Plan, PlannedCell, plan};
use crate::stages::matching::open;
use crate::{Blocked, RunError};
use furrow_catalog::Catalog;
use furrow_catalog::records::RunContrasts;
use furrow_model::CellKey;
use std::collections::BTreeSet;

/// A matrix file resolved against the store.
pub struct Study {
    /// The matrix as written.
    pub matrix: Matrix,
    /// Each setting with its cells, in the matrix' order; a cell or contrast that two settings come to is in the first
    /// only.
    pub parts: Vec<Plan>,
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
}
