//! Figures as the report's template shows them.

use crate::chart::{Chart, SvgWriter, WIDTH};
use crate::error::ReportError;
use crate::figures::Figure;
use crate::wording;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// Bytes of figures' data that a page carries in itself, before base64; of a crowded page.
const DATA_AT_MOST: usize = 1_500_000;
const CROWDED_DATA_AT_MOST: usize = 300_000;

#[derive(Serialize)]
pub(super) struct FigureView {
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

/// Turns figures into views: numbered on, their data within the page's room.
pub(super) struct FigureViews {
    writer: SvgWriter,
    command: String,
    number: usize,
    room: usize,
}

impl FigureViews {
    pub fn new(command: String, crowded: bool) -> Result<Self, ReportError> {
        let room = if crowded { CROWDED_DATA_AT_MOST } else { DATA_AT_MOST };
        Ok(Self { writer: SvgWriter::new()?, command, number: 0, room })
    }

    pub fn all(&mut self, figures: Vec<Figure>) -> Result<Vec<FigureView>, ReportError> {
        figures.into_iter().map(|figure| self.next(figure)).collect()
    }

    pub fn next(&mut self, figure: Figure) -> Result<FigureView, ReportError> {
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
        let svg = self.writer.element(chart)?;
        Ok(Panel { svg, label: chart.title.clone(), wide: chart.width > WIDTH, width: chart.width })
    }

    fn within_room(&mut self, csv: String) -> Option<String> {
        self.room = self.room.checked_sub(csv.len())?;
        Some(STANDARD.encode(csv))
    }
}
