use super::chosen_run;
use super::contrast::missing_text;
use crate::{Context, Ending, Failure, print_json};
use furrow_catalog::records::RunContrasts;
use furrow_catalog::{Catalog, Objects, tables, write_file};
use furrow_model::{CellKey, Outcome, RunId};
use furrow_reports::{CellInput, ContrastInput, MissingCell, ReportInput, Tile, choose_tiles, page};
use furrow_runner::contrasts;
use furrow_runner::pictures::picture_pair;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Write a run's report: one HTML page that needs nothing else.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow report latest -o report.html")]
pub struct Report {
    /// The run: its id, the beginning of it, or `latest`.
    run: String,
    /// The page to write.
    #[arg(short, long, value_name = "FILE.html")]
    output: PathBuf,
}

/// Tiles of a cell: so many accepted and rejected frames. Wrong ones come on top.
const ACCEPTED_TILES: usize = 3;
const REJECTED_TILES: usize = 2;
/// A page with many cells shows fewer pictures each, so that it stays small.
const TILES_IN_ALL: usize = 60;

impl Report {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let id = chosen_run(&catalog, &self.run)?;
        let html = rendered(&catalog, id, format!("furrow report {id} -o {}", self.output.display()))?;
        write_file(&self.output, html.as_bytes())?;
        if context.json {
            print_json(&serde_json::json!({ "run": id, "file": self.output, "bytes": html.len() }))?;
        } else {
            eprintln!("report: {}", self.output.display());
        }
        Ok(Ending::Done)
    }
}

/// A run's page; `command` is what the page says makes it again.
pub(super) fn rendered(catalog: &Catalog, id: RunId, command: String) -> Result<String, Failure> {
    let record = catalog.run(id)?;
    let drawn = |figure: &str| record.figures.is_empty() || record.figures.iter().any(|name| name == figure);
    let share = (TILES_IN_ALL / record.cells.len().max(1)).max(1);
    let (mut cells, mut missing) = (Vec::new(), Vec::new());
    let mut names: BTreeMap<CellKey, &str> = BTreeMap::new();
    for cell in &record.cells {
        if let Some(name) = names.get(&cell.key) {
            let label = format!("live {} against {}", cell.live, cell.experience);
            missing.push(MissingCell { label, reason: format!("the same cell as that of {name}, which is shown") });
            continue;
        }
        names.insert(cell.key, &cell.experience);
        match catalog.outcome(cell.key)? {
            Some(outcome) => {
                cells.push(cell_input(catalog, outcome.named(&cell.experience), drawn("tiles").then_some(share))?)
            }
            None => missing.push(MissingCell {
                label: format!("live {} against {}", cell.live, cell.experience),
                reason: "not finished: run the matrix again".to_owned(),
            }),
        }
    }
    missing.extend(record.blocked.iter().map(|blocked| MissingCell {
        label: format!("live {} against {}", blocked.live, blocked.experience),
        reason: blocked.reason.clone(),
    }));
    let contrasts = contrast_input(
        catalog.objects(),
        &record.contrasts,
        &cells.iter().map(|cell| &cell.outcome).collect::<Vec<_>>(),
    )?;
    Ok(page(&ReportInput {
        run: id,
        matrix_name: record.name,
        matrix_source: record.source,
        site: record.site,
        command,
        furrow_version: env!("CARGO_PKG_VERSION").to_owned(),
        cells,
        missing,
        contrasts,
    })?)
}

/// The run's contrasts, with what must be said beside them.
pub(super) fn contrast_input(
    objects: &Objects,
    asked: &[RunContrasts],
    outcomes: &[&Outcome],
) -> Result<ContrastInput, Failure> {
    let made = contrasts(objects, asked, outcomes)?;
    let warnings = asked.iter().flat_map(|asked| asked.warnings.iter().cloned());
    let mut notes: Vec<String> = Vec::new();
    // Settings warn of the same things.
    for note in warnings.chain(made.missing.iter().map(missing_text)) {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    Ok(ContrastInput { notes, found: made.found })
}

fn cell_input(catalog: &Catalog, outcome: Outcome, tiles: Option<usize>) -> Result<CellInput, Failure> {
    let events = tables::from_parquet("events", catalog.objects().read(outcome.events)?)?;
    let choices = match tiles {
        Some(share) => choose_tiles(&outcome, &events, ACCEPTED_TILES.min(share), REJECTED_TILES.min(share))?,
        None => Vec::new(),
    };
    let mut shown = Vec::new();
    for choice in choices {
        let matched = choice.node_image.map(|image| (choice.experience, image));
        let pictures = picture_pair(catalog, &outcome, choice.caption.live_stamp_ns, matched)?;
        shown.push(Tile {
            caption: choice.caption,
            live_jpeg: pictures.live,
            match_jpeg: pictures.matched,
            inlier_lines: pictures.lines,
        });
    }
    Ok(CellInput { outcome, events, tiles: shown })
}
