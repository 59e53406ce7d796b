//! A chart: what `chart.svg` draws. Coordinates are units of the viewBox.

use super::elements::{Band, Key, Line, Mark, Note, Patch, Plot, Rule, Tick};
use super::scale::rounded;
use super::text::{fitted, width};
use serde::Serialize;

/// The usual width; a phone shows it at about three quarters, a wide page two beside each other.
pub(crate) const WIDTH: f64 = 480.0;
pub(super) const FONT: f64 = 12.0;
pub(super) const TITLE_FONT: f64 = 13.0;
pub(super) const RIGHT: f64 = 14.0;
const TOP: f64 = 46.0;

/// A whole chart.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Chart {
    pub id: String,
    /// Written above the plot.
    pub title: String,
    /// For people who cannot see it.
    pub desc: String,
    pub width: f64,
    pub height: f64,
    pub plot: Plot,
    pub x_label: String,
    /// Where the x axis' label stands.
    pub axis_y: f64,
    pub y_label: String,
    /// The values at the ends of the plot, where an axis has numbers.
    pub x_range: Option<[f64; 2]>,
    pub y_range: Option<[f64; 2]>,
    pub x_ticks: Vec<Tick>,
    pub y_ticks: Vec<Tick>,
    pub slanted: bool,
    /// Horizontal and vertical grid lines.
    pub grid: (bool, bool),
    pub patches: Vec<Patch>,
    pub bands: Vec<Band>,
    pub lines: Vec<Line>,
    pub rules: Vec<Rule>,
    pub marks: Vec<Mark>,
    pub notes: Vec<Note>,
    pub legend: Vec<Key>,
    /// Where the legend begins.
    pub legend_y: f64,
}

impl Chart {
    /// An empty chart with room on the left for the widest of `y_texts` and a plot of `plot_height`.
    pub fn new(id: String, title: String, y_texts: &[&str], width: f64, plot_height: f64) -> Self {
        let widest = y_texts.iter().map(|text| self::width(text, FONT)).fold(0.0, f64::max);
        let x = rounded(widest.clamp(20.0, 150.0) + 14.0);
        let plot = Plot { x, y: TOP, w: width - x - RIGHT, h: plot_height };
        Self {
            id,
            title: fitted(&title, TITLE_FONT, width - 20.0),
            desc: String::new(),
            width,
            height: TOP + plot_height + 44.0,
            plot,
            x_label: String::new(),
            axis_y: TOP + plot_height + 36.0,
            y_label: String::new(),
            x_range: None,
            y_range: None,
            x_ticks: Vec::new(),
            y_ticks: Vec::new(),
            slanted: false,
            grid: (true, false),
            patches: Vec::new(),
            bands: Vec::new(),
            lines: Vec::new(),
            rules: Vec::new(),
            marks: Vec::new(),
            notes: Vec::new(),
            legend: Vec::new(),
            legend_y: 0.0,
        }
    }

    /// Writes another title, cut to the chart's width.
    pub fn set_title(&mut self, title: &str) {
        self.title = fitted(title, TITLE_FONT, self.width - 20.0);
    }
}
