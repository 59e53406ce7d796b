//! The story: from a run's outcomes to one HTML file.

use crate::arrange::{Setting, arrange};
use crate::chart::WIDTH;
use crate::contrasts::{self, ContrastTable};
use crate::figures::{self, Figure};
use crate::gallery::{self, Album};
use crate::input::{CellInput, ReportError, ReportInput};
use crate::palette::{Tone, Tones};
use crate::summary::{Summary, summary};
use crate::table::{self, Lineage, Table};
use crate::template::Templates;
use crate::wording;
use serde::Serialize;

#[derive(Serialize)]
struct PageView {
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
    tables: Vec<Table>,
    contrasts: Option<ContrastTable>,
    contrast_figure: Option<FigureView>,
    parts: Vec<Part>,
    albums: Vec<Album>,
    lineages: Vec<Lineage>,
}

/// The figures of one setting.
#[derive(Serialize)]
struct Part {
    title: String,
    figures: Vec<FigureView>,
}

#[derive(Serialize)]
struct FigureView {
    id: String,
    number: usize,
    title: String,
    caption: String,
    panels: Vec<Panel>,
    more: Vec<(String, Vec<Panel>)>,
}

#[derive(Serialize)]
struct Panel {
    svg: String,
    label: String,
    /// Set where the chart is wider than usual: it then keeps its size and scrolls in its own box.
    wide: bool,
    width: f64,
}

/// Draws a run as one self-contained HTML page: no network, no script, every name escaped.
///
/// Metrics are taken from the outcomes; the tables of events give the points on the route and the inlier histograms. Equal inputs give
/// equal bytes.
///
/// # Errors
/// [`ReportError`] where cells contradict themselves: a cell given twice, events that are not the outcome's, a tile that is no JPEG.
pub fn page(input: &ReportInput) -> Result<String, ReportError> {
    let settings = arrange(&input.cells)?;
    let tones = tones_of(&settings);
    let templates = Templates::new()?;
    let contrast_figure = figures::contrasts::figure(&input.contrasts.found)
        .map(|figure| figure_view(figure, 1, &templates))
        .transpose()?;
    let parts = parts(&settings, &tones, &templates, usize::from(contrast_figure.is_some()))?;
    let cells: Vec<&CellInput> = settings.iter().flat_map(Setting::cells).collect();
    templates.page(PageView {
        name: wording::shown(&input.matrix_name),
        site: wording::shown(&input.site),
        run: input.run.to_string(),
        run_short: input.run.short(),
        command: wording::shown(&input.command),
        version: wording::shown(&input.furrow_version),
        matrix_source: input.matrix_source.lines().map(wording::shown).collect::<Vec<_>>().join("\n"),
        tones: tones.all(),
        summary: summary(input),
        missing: input.missing.iter().map(|cell| (wording::shown(&cell.label), wording::shown(&cell.reason))).collect(),
        tables: settings.iter().map(table::of_setting).collect(),
        contrasts: contrasts::table(&input.contrasts),
        contrast_figure,
        parts,
        albums: gallery::albums(&cells)?,
        lineages: cells.iter().map(|cell| Lineage::of(&cell.outcome)).collect(),
    })
}

fn tones_of(settings: &[Setting<'_>]) -> Tones {
    let rows = settings.iter().flat_map(|setting| setting.rows.iter().map(|row| row.slot));
    let columns = settings.iter().flat_map(|setting| setting.columns.iter().map(|column| column.slot));
    Tones::new(rows.chain(columns).collect())
}

/// The figures of each setting, numbered on from `before`.
fn parts(
    settings: &[Setting<'_>],
    tones: &Tones,
    templates: &Templates,
    before: usize,
) -> Result<Vec<Part>, ReportError> {
    let mut number = before;
    let mut view = |figure: Figure| {
        number += 1;
        figure_view(figure, number, templates)
    };
    let mut parts = Vec::new();
    for (i, setting) in settings.iter().enumerate() {
        let figures = figures::of_setting(setting, &format!("s{i}"), tones)?;
        let figures = figures.into_iter().map(&mut view).collect::<Result<Vec<_>, _>>()?;
        parts.push(Part { title: setting.title.clone(), figures });
    }
    Ok(parts)
}

fn figure_view(figure: Figure, number: usize, templates: &Templates) -> Result<FigureView, ReportError> {
    let panel = |chart: &crate::chart::Chart| {
        let svg = templates.chart(chart)?;
        Ok(Panel { svg, label: chart.title.clone(), wide: chart.width > WIDTH, width: chart.width })
    };
    let panels = |charts: &[crate::chart::Chart]| charts.iter().map(panel).collect::<Result<Vec<_>, ReportError>>();
    let more = figure.more.iter().map(|(summary, charts)| Ok((summary.clone(), panels(charts)?)));
    Ok(FigureView {
        id: figure.id,
        number,
        title: figure.title,
        caption: figure.caption,
        panels: panels(&figure.panels)?,
        more: more.collect::<Result<_, ReportError>>()?,
    })
}
