//! The story: from a run's outcomes to one HTML file.

use crate::arrange::{Kind, Setting, arrange};
use crate::chart::{Chart, WIDTH};
use crate::contrasts::{self, ContrastTable};
use crate::figures::{self, Figure};
use crate::gallery::{self, Album, Sheet};
use crate::input::{CellInput, ReportError, ReportInput};
use crate::interaction::{self, PageData};
use crate::palette::{Tone, Tones};
use crate::summary::{Summary, summary};
use crate::table::{self, Lineage, Table};
use crate::template::Templates;
use crate::wording;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
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
    overview: Vec<FigureView>,
    tables: Vec<Table>,
    contrasts: Option<ContrastTable>,
    contrast_lineages: Vec<contrasts::Lineage>,
    contrast_figure: Option<FigureView>,
    parts: Vec<Part>,
    across: Vec<FigureView>,
    /// The contact sheets where every cell localised against something generated: there, what was painted is the question.
    painted: Vec<Sheet>,
    /// The contact sheets elsewhere.
    sheets: Vec<Sheet>,
    stills: Vec<Album>,
    albums: Vec<Album>,
    lineages: Vec<Lineage>,
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

#[derive(Serialize)]
struct FigureView {
    id: String,
    number: usize,
    title: String,
    caption: String,
    panels: Vec<Panel>,
    more: Vec<(String, Vec<Panel>)>,
    command: String,
    rows: String,
    /// In base64; none where the page would grow too large.
    csv: Option<String>,
}

#[derive(Serialize)]
struct Panel {
    svg: String,
    label: String,
    /// Set where the chart is wider than usual: it then keeps its size and scrolls in its own box.
    wide: bool,
    width: f64,
}

/// Draws a run as one self-contained HTML page: no network, no script but its own, every name escaped.
///
/// Metrics are taken from the outcomes; the tables of events give the points on the route and the inlier histograms. Equal inputs give
/// equal bytes.
///
/// # Errors
/// [`ReportError`] where cells contradict themselves: a cell given twice, events that are not the outcome's, a tile that is no JPEG.
pub fn page(input: &ReportInput) -> Result<String, ReportError> {
    let settings = arrange(&input.cells)?;
    let tones = Tones::of_settings(&settings);
    let templates = Templates::new()?;
    let mut views =
        Views::new(&templates, wording::shown(&input.command), settings.iter().any(|setting| setting.crowded));
    let overview = views.all(figures::overview(input, &settings, &tones))?;
    let contrast_figure =
        figures::contrasts::figure(&input.contrasts.found).map(|figure| views.view(figure)).transpose()?;
    let parts = parts(&settings, &tones, &mut views)?;
    let across = views.all(figures::across(input))?;
    let sheets = gallery::sheets(&input.generators)?;
    let (painted, sheets) = if generated_alone(&settings) { (sheets, Vec::new()) } else { (Vec::new(), sheets) };
    let script = interaction::script();
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
        overview,
        tables: table::of_settings(&settings),
        contrasts: contrasts::table(&input.contrasts),
        contrast_lineages: contrasts::lineages(
            &input.contrasts,
            &cells.iter().map(|cell| cell.outcome.key.short()).collect(),
        ),
        contrast_figure,
        parts,
        across,
        painted,
        sheets,
        stills: gallery::stills(&cells)?,
        albums: gallery::albums(&cells)?,
        lineages: cells.iter().map(|cell| Lineage::of(&cell.outcome)).collect(),
        data: interaction::page_data(&settings)?,
        script_source: interaction::source_of(&script),
        script,
    })
}

/// Whether nothing recorded is under its own name among the experiences.
fn generated_alone(settings: &[Setting<'_>]) -> bool {
    settings.iter().flat_map(|setting| &setting.columns).all(|column| column.kind == Kind::Named)
}

fn parts(settings: &[Setting<'_>], tones: &Tones, views: &mut Views<'_>) -> Result<Vec<Part>, ReportError> {
    let mut parts = Vec::new();
    for (i, setting) in settings.iter().enumerate() {
        let figures = figures::of_setting(setting, &format!("s{i}"), tones)?;
        parts.push(Part { title: setting.title.clone(), figures: views.all(figures)? });
    }
    Ok(parts)
}

/// Bytes of figures' data that a page carries in itself, before base64; of a crowded page.
const DATA_AT_MOST: usize = 1_500_000;
const CROWDED_DATA_AT_MOST: usize = 300_000;

/// Turns figures into what the template shows: numbered on, their data within the page's room.
struct Views<'t> {
    templates: &'t Templates,
    command: String,
    number: usize,
    room: usize,
}

impl<'t> Views<'t> {
    fn new(templates: &'t Templates, command: String, crowded: bool) -> Self {
        Self { templates, command, number: 0, room: if crowded { CROWDED_DATA_AT_MOST } else { DATA_AT_MOST } }
    }

    fn all(&mut self, figures: Vec<Figure>) -> Result<Vec<FigureView>, ReportError> {
        figures.into_iter().map(|figure| self.view(figure)).collect()
    }

    fn view(&mut self, figure: Figure) -> Result<FigureView, ReportError> {
        let panels = |charts: &[Chart]| charts.iter().map(|chart| self.panel(chart)).collect::<Result<Vec<_>, _>>();
        let drawn = panels(&figure.panels)?;
        let more = figure.more.iter().map(|(summary, charts)| Ok((summary.clone(), panels(charts)?)));
        let more = more.collect::<Result<_, ReportError>>()?;
        self.number += 1;
        Ok(FigureView {
            id: figure.id,
            number: self.number,
            title: figure.title,
            caption: figure.caption,
            panels: drawn,
            more,
            command: self.command.clone(),
            rows: wording::counted(figure.data.rows(), "row", "rows"),
            csv: self.within_room(figure.data.csv()),
        })
    }

    fn panel(&self, chart: &Chart) -> Result<Panel, ReportError> {
        let svg = self.templates.chart(chart)?;
        Ok(Panel { svg, label: chart.title.clone(), wide: chart.width > WIDTH, width: chart.width })
    }

    fn within_room(&mut self, csv: String) -> Option<String> {
        self.room = self.room.checked_sub(csv.len())?;
        Some(STANDARD.encode(csv))
    }
}
