//! A chart as data: what `templates/chart.svg` draws. Coordinates are units of the viewBox.

use crate::legend::Key;
use crate::palette::Tone;
use crate::scale::{Scale, rounded};
use crate::wording;
use serde::Serialize;

/// The usual width; a phone shows it at about three quarters, a wide page two beside each other.
pub(crate) const WIDTH: f64 = 480.0;
pub(crate) const FONT: f64 = 12.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 46.0;

/// A tick: where, what it says, and the whole of it where it had to be cut.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Tick {
    pub at: f64,
    pub text: String,
    pub full: String,
}

/// A shaded band, as a path.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Band {
    pub d: String,
    pub tone: Tone,
    pub series: Option<usize>,
    pub data: Vec<(&'static str, String)>,
}

/// A line, as a path; `data` carries the numbers it was drawn from, and `cell` or `cells` whose they are. `series` is the legend entry that
/// switches it.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Line {
    pub d: String,
    pub tone: Tone,
    pub dash: &'static str,
    pub width: f64,
    pub title: String,
    pub series: Option<usize>,
    pub data: Vec<(&'static str, String)>,
}

/// A mark, with the values that its title shows.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Mark {
    pub d: String,
    pub tone: Tone,
    pub filled: bool,
    pub title: String,
    pub series: Option<usize>,
    pub data: Vec<(&'static str, String)>,
}

/// A filled rectangle, with a number in it or none.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Patch {
    pub x: f64,
    pub y: f64,
    pub w: f64,
    pub h: f64,
    pub tone: Tone,
    pub opacity: f64,
    pub hollow: bool,
    pub text: String,
    pub title: String,
    pub series: Option<usize>,
    pub data: Vec<(&'static str, String)>,
}

/// A vertical line that marks a value on the x axis.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Rule {
    pub x: f64,
    pub text: String,
    /// Text to the left of the line, where there is no room to its right.
    pub before: bool,
}

/// A line of text inside the plot.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Note {
    pub x: f64,
    pub y: f64,
    pub text: String,
    pub full: String,
}

/// The plot's rectangle.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Plot {
    pub x: f64,
    pub y: f64,
    pub w: f64,
    pub h: f64,
}

/// A whole chart.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Chart {
    pub id: String,
    /// Written above the plot.
    pub title: String,
    /// For those who do not see it.
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
        let widest = y_texts.iter().map(|text| wording::width(text, FONT)).fold(0.0, f64::max);
        let x = rounded(widest.clamp(20.0, 150.0) + 14.0);
        let plot = Plot { x, y: TOP, w: width - x - RIGHT, h: plot_height };
        Self {
            id,
            title: wording::fitted(&title, 13.0, width - 20.0),
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

    /// Narrows the plot so that a tick's text at its right end fits.
    pub fn leave_room_for(&mut self, last: &str) {
        self.plot.w -= rounded((0.5 * wording::width(last, FONT) - RIGHT).max(0.0));
    }

    /// Left to right over the plot.
    pub fn x_scale(&mut self, to: f64) -> Scale {
        self.x_range = Some([0.0, to]);
        Scale { from: 0.0, to, px_from: self.plot.x, px_to: self.plot.x + self.plot.w }
    }

    /// Bottom to top over the plot.
    pub fn y_scale(&mut self, to: f64) -> Scale {
        self.y_range = Some([0.0, to]);
        Scale { from: 0.0, to, px_from: self.plot.y + self.plot.h, px_to: self.plot.y }
    }

    /// Ticks below the plot, for names: slanted where they do not fit upright.
    pub fn name_x_ticks(&mut self, names: &[(f64, &str)]) {
        let room = self.plot.w / names.len().max(1) as f64 - 4.0;
        self.slanted = names.iter().any(|(_, name)| wording::width(name, FONT) > room);
        let limit = if self.slanted { 150.0 } else { room };
        self.x_ticks = names.iter().map(|(at, name)| name_tick(*at, name, limit)).collect();
        if self.slanted {
            let widest = self.x_ticks.iter().map(|tick| wording::width(&tick.text, FONT)).fold(0.0, f64::max);
            self.height += rounded(widest * 0.71);
            self.axis_y += rounded(widest * 0.71);
        }
    }

    /// Ticks beside the plot, for names.
    pub fn name_y_ticks(&mut self, names: &[(f64, &str)]) {
        let room = self.plot.x - 10.0;
        self.y_ticks = names.iter().map(|(at, name)| name_tick(*at, name, room)).collect();
    }
}

fn name_tick(at: f64, name: &str, room: f64) -> Tick {
    Tick { at, text: wording::fitted(name, FONT, room), full: name.to_owned() }
}
