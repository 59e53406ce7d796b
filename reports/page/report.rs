//! The report: from a run's outcomes to one HTML file.

use super::cells::{self, Table};
use super::contrasts::{self, ContrastTable};
use super::figure_view::{FigureView, FigureViews};
use super::gallery::{self, Album, Still};
use super::lineage::{CellLineage, ContrastLineage, contrast_lineages};
use super::page_data::{PageData, page_data};
use super::script;
use super::sheets::{Sheet, sheets};
use super::summary::{Summary, summary};
use super::template::Templates;
use crate::chart::palette::{Tone, Tones};
use crate::error::ReportError;
use crate::figures;
use crate::figures::arrange::{self, Kind, Setting, arrange};
use crate::input::{CellInput, ReportInput};
use crate::wording;
use furrow_model::metric::{METRICS, RIGHT};
use serde::Serialize;

#[derive(Serialize)]
struct ReportView {
    name: String,
    site: String,
    run: String,
    run_short: String,
    command: String,
    version: String,
    matrix_source: String,
    tones: Vec<Tone>,
    summary: Summary,
    missing: Vec<(String, String)>,
    overview: Vec<FigureView>,
    tables: Vec<Table>,
    contrasts: Option<ContrastTable>,
    contrast_lineages: Vec<ContrastLineage>,
    contrast_figure: Option<FigureView>,
    parts: Vec<Part>,
    across: Vec<FigureView>,
    /// The contact sheets where every cell localised against something generated: there, the generated images are the
    /// question.
    first_sheets: Vec<Sheet>,
    /// The contact sheets elsewhere.
    sheets: Vec<Sheet>,
    stills: Vec<Still>,
    albums: Vec<Album>,
    lineages: Vec<CellLineage>,
    /// Headings and what they mean.
    metrics: Vec<[&'static str; 2]>,
    right: &'static str,
    data: PageData,
    script: String,
    script_source: String,
}

/// The figures of one setting.
#[derive(Serialize)]
struct Part {
    title: String,
    figures: Vec<FigureView>,
}

/// Draws a run as one self-contained HTML page: no network, no script but its own, every name escaped.
///
/// Metrics are taken from the outcomes; the tables of events give the points on the route and the inlier histograms.
/// Equal inputs give equal bytes.
///
/// # Errors
/// [`ReportError`] where cells contradict themselves: a cell given twice, events that are not the outcome's, a tile
/// that is no JPEG.
pub fn page(input: &ReportInput) -> Result<String, ReportError> {
    let settings = arrange(&input.cells)?;
    let tones = arrange::tones(&settings);
    let crowded = settings.iter().any(|setting| setting.crowded);
    let mut views = FigureViews::new(wording::shown(&input.command), crowded)?;
    let overview = views.all(figures::overview(input, &settings, &tones))?;
    let contrast_figure = figures::contrasts(input).map(|figure| views.next(figure)).transpose()?;
    let parts = parts(&settings, &tones, &mut views)?;
    let across = views.all(figures::across(input))?;
    let sheets = sheets(&input.generators)?;
    let (first_sheets, sheets) = if all_generated(&settings) { (sheets, Vec::new()) } else { (Vec::new(), sheets) };
    let tables = cells::tables(&settings);
    let metrics = meanings(&tables);
    let source = script::script();
    let cells: Vec<&CellInput> = settings.iter().flat_map(Setting::cells).collect();
    let keys = cells.iter().map(|cell| cell.outcome.key.short()).collect();
    Templates::new()?.report(ReportView {
        name: wording::shown(&input.matrix_name),
        site: wording::shown(&input.site),
        run: input.run.to_string(),
        run_short: input.run.short(),
        command: wording::shown(&input.command),
        version: wording::shown(&input.furrow_version),
        matrix_source: wording::shown_lines(&input.matrix_source),
        tones: tones.all(),
        summary: summary(input),
        missing: input.missing.iter().map(|cell| (wording::shown(&cell.label), wording::shown(&cell.reason))).collect(),
        overview,
        tables,
        contrasts: contrasts::table(&input.contrasts),
        contrast_lineages: contrast_lineages(&input.contrasts, &keys),
        contrast_figure,
        parts,
        across,
        first_sheets,
        sheets,
        stills: gallery::stills(&cells)?,
        albums: gallery::albums(&cells)?,
        lineages: cells.iter().map(|cell| CellLineage::of(&cell.outcome)).collect(),
        metrics,
        right: RIGHT,
        data: page_data(&settings)?,
        script_source: script::source_of(&source),
        script: source,
    })
}

/// The headings that the tables have, and what they mean.
fn meanings(tables: &[Table]) -> Vec<[&'static str; 2]> {
    let has = |heading: &str| tables.iter().flat_map(|table| &table.headings).any(|other| other.text == heading);
    METRICS.iter().filter(|metric| has(metric.heading)).map(|metric| [metric.heading, metric.meaning]).collect()
}

/// Whether nothing recorded is under its own name among the experiences.
fn all_generated(settings: &[Setting<'_>]) -> bool {
    settings.iter().flat_map(|setting| &setting.columns).all(|column| column.kind == Kind::Named)
}

fn parts(settings: &[Setting<'_>], tones: &Tones, views: &mut FigureViews) -> Result<Vec<Part>, ReportError> {
    let mut parts = Vec::new();
    for (index, setting) in settings.iter().enumerate() {
        let figures = figures::of_setting(setting, index, tones)?;
        parts.push(Part { title: setting.title.clone(), figures: views.all(figures)? });
    }
    Ok(parts)
}
