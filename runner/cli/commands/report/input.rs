//! Everything of a run that its report shows, read from the store.

use super::cells::{read_cells, read_tracks, read_trainings};
use super::generators::{find_parents, read_generators};
use super::pictures::{add_stills, add_tiles};
use crate::ending::Failure;
use crate::views::contrasts::missing_text;
use furrow_catalog::records::RunContrasts;
use furrow_catalog::{Catalog, Objects};
use furrow_model::{Outcome, RunId};
use furrow_reports::{ContrastInput, ReportInput};
use furrow_runner::contrasts;

/// Reads it; `command` is the command that writes the page again.
pub fn report_input(catalog: &Catalog, id: RunId, command: String) -> Result<ReportInput, Failure> {
    let record = catalog.run(id)?;
    let drawn = |figure: &str| record.figures.is_empty() || record.figures.iter().any(|name| name == figure);
    let (mut cells, missing) = read_cells(catalog, &record)?;
    let outcomes: Vec<&Outcome> = cells.iter().map(|cell| &cell.outcome).collect();
    let contrasts = contrast_input(catalog.objects(), &record.contrasts, &outcomes)?;
    if drawn("tiles") {
        add_tiles(catalog, &mut cells)?;
        add_stills(catalog, &mut cells)?;
    }
    Ok(ReportInput {
        run: id,
        command,
        furrow_version: env!("CARGO_PKG_VERSION").to_owned(),
        tracks: read_tracks(catalog, &cells)?,
        trained: read_trainings(catalog, &cells)?,
        generators: read_generators(catalog, &record, &find_parents(catalog, &cells)?, drawn("tiles"))?,
        matrix_name: record.name,
        matrix_source: record.source,
        site: record.site,
        cells,
        missing,
        contrasts,
    })
}

/// The run's contrasts, with warnings and what could not be computed.
pub fn contrast_input(
    objects: &Objects,
    asked: &[RunContrasts],
    outcomes: &[&Outcome],
) -> Result<ContrastInput, Failure> {
    let made = contrasts(objects, asked, outcomes)?;
    let warnings = asked.iter().flat_map(|asked| asked.warnings.iter().cloned());
    let mut notes: Vec<String> = Vec::new();
    // Several settings give the same warning.
    for note in warnings.chain(made.missing.iter().map(missing_text)) {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    Ok(ContrastInput { notes, found: made.found })
}
