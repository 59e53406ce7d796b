//! Ids as a user types them: whole, or their beginning.

use crate::ending::Failure;
use furrow_catalog::Catalog;
use furrow_model::{ExperienceId, RunId, TraversalId};
use furrow_runner::export::places::PlacesOf;
use std::fmt::Display;

/// Finds an experience by the beginning of its id.
pub fn choose_experience(catalog: &Catalog, typed: &str) -> Result<ExperienceId, Failure> {
    choose("experience", typed, catalog.experiences()?.into_iter().map(|row| row.id))
}

/// Finds a traversal by the beginning of its id.
pub fn choose_traversal(catalog: &Catalog, typed: &str) -> Result<TraversalId, Failure> {
    let current: Vec<TraversalId> = catalog.traversals()?.into_iter().map(|row| row.id).collect();
    let begins = |id: &dyn Display| !typed.is_empty() && id.to_string().starts_with(typed);
    if !current.iter().any(|id| begins(id)) {
        let superseded = catalog.superseded()?;
        if let Some((_, later)) = superseded.iter().find(|(earlier, _)| begins(earlier)) {
            let after =
                |id: &TraversalId| superseded.iter().find(|(earlier, _)| earlier == id).map(|(_, later)| *later);
            let latest = std::iter::successors(Some(*later), after).last().unwrap_or(*later);
            return Err(Failure::new(format!(
                "traversal {typed} has other true poses by now: its latest version is {latest}; `furrow ls` lists it"
            )));
        }
        if let Some(row) = catalog.experiences()?.into_iter().find(|row| begins(&row.id)) {
            let of: Vec<String> = catalog.traversals_of(row.id)?.iter().map(|row| row.id.short()).collect();
            return Err(Failure::new(format!(
                "{typed} is an experience: name its traversal ({}), which `furrow ls` lists in its first column",
                if of.is_empty() { "none: it is generated".to_owned() } else { of.join(", ") }
            )));
        }
    }
    choose("traversal", typed, current.into_iter())
}

/// Finds an experience, else a traversal, by the beginning of its id.
pub fn choose_places(catalog: &Catalog, typed: &str) -> Result<PlacesOf, Failure> {
    let begins = |id: ExperienceId| !typed.is_empty() && id.to_string().starts_with(typed);
    if catalog.experiences()?.into_iter().any(|row| begins(row.id)) {
        return choose_experience(catalog, typed).map(PlacesOf::Experience);
    }
    choose_traversal(catalog, typed).map(PlacesOf::Traversal)
}

/// Finds a run by the beginning of its id, or the one that was started last as `latest`.
pub fn choose_run(catalog: &Catalog, typed: &str) -> Result<RunId, Failure> {
    let runs = catalog.runs()?;
    if typed == "latest" {
        let newest = runs.iter().max_by_key(|run| run.number);
        return newest
            .map(|run| run.id)
            .ok_or_else(|| Failure::new("no run in this store yet: `furrow run MATRIX.toml` makes one"));
    }
    choose("run", typed, runs.iter().map(|run| run.id))
}

/// The one id among `ids` that begins with what the user typed.
fn choose<T: Copy + Display>(what: &str, typed: &str, ids: impl Iterator<Item = T>) -> Result<T, Failure> {
    let found: Vec<T> = ids.filter(|id| !typed.is_empty() && id.to_string().starts_with(typed)).collect();
    match found.as_slice() {
        [one] => Ok(*one),
        [] => Err(Failure::new(format!(
            "no {what} begins with '{typed}': `furrow ls` and `furrow status` list what there is"
        ))),
        several => Err(Failure::new(format!("{} {what}s begin with '{typed}': type more of the id", several.len()))),
    }
}
