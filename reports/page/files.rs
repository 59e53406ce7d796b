//! A run's figures as files of their own.

use crate::chart::{Chart, SvgWriter};
use crate::error::ReportError;
use crate::figures::arrange::{self, arrange};
use crate::figures::data::Data;
use crate::figures::{self, Figure};
use crate::input::ReportInput;
use crate::wording;
use polars::prelude::{DataFrame, PolarsResult};

/// A figure of the page as files: its charts, its words and its numbers.
#[derive(Debug, Clone)]
pub struct FigureFiles {
    /// A file name without an ending: letters, digits and hyphens.
    pub name: String,
    /// The figure's number on the page, its title, its caption, and the command that makes it.
    pub caption: String,
    /// Name (as above) and SVG of each chart; an SVG stands alone, in the light page's colours.
    pub charts: Vec<(String, String)>,
    data: Data,
}

impl FigureFiles {
    /// The numbers drawn, as CSV (RFC 4180), all digits kept.
    pub fn csv(&self) -> String {
        self.data.csv()
    }

    /// The numbers drawn, as a frame.
    ///
    /// # Errors
    /// What polars says of columns that do not fit together, which would be a bug in furrow.
    pub fn frame(&self) -> PolarsResult<DataFrame> {
        self.data.frame()
    }
}

/// Every figure of the page that [`page`](crate::page()) draws, in its order.
///
/// # Errors
/// As for the page.
pub fn figure_files(input: &ReportInput) -> Result<Vec<FigureFiles>, ReportError> {
    let settings = arrange(&input.cells)?;
    let writer = SvgWriter::new()?;
    let drawn = figures::of_page(input, &settings, &arrange::tones(&settings))?;
    drawn.into_iter().enumerate().map(|(i, figure)| files(i + 1, figure, &writer, &input.command)).collect()
}

fn files(number: usize, figure: Figure, writer: &SvgWriter, command: &str) -> Result<FigureFiles, ReportError> {
    let more = figure.more.iter().flat_map(|(_, charts)| charts);
    let chart = |chart: &Chart| Ok((chart.id.clone(), writer.file(chart)?));
    let (title, caption, command) = (figure.title, figure.caption, wording::shown(command));
    Ok(FigureFiles {
        name: figure.id.trim_end_matches("-figure").to_owned(),
        caption: format!("Figure {number}. {title}\n\n{caption}\n\nMade by: {command} --figures svg\n"),
        charts: figure.panels.iter().chain(more).map(chart).collect::<Result<_, ReportError>>()?,
        data: figure.data,
    })
}
