//! A chart as data: what `templates/chart.svg` draws. Coordinates are units of the viewBox.

use crate::palette::Tone;
use crate::scale::{Scale, rounded};
use crate::wording;
use serde::Serialize;

/// The usual width; a phone shows it at about three quarters, a wide page two beside each other.
pub(crate) const WIDTH: f64 = 480.0;
const FONT: f64 = 12.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 46.0;
const LEGEND_ROW: f64 = 19.0;
const LEGEND_KEY: f64 = 30.0;

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
}

/// A line, as a path; `data` carries the numbers it was drawn from.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Line {
    pub d: String,
    pub tone: Tone,
    pub dash: &'static str,
    pub width: f64,
    pub title: String,
    pub data: Vec<(&'static str, String)>,
}

/// A mark, with the values that its title shows.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Mark {
    pub d: String,
    pub tone: Tone,
    pub filled: bool,
    pub title: String,
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

/// An entry of the legend, placed.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Key {
    pub x: f64,
    pub y: f64,
    pub text: String,
    pub full: String,
    pub tone: Tone,
    pub line: Option<&'static str>,
    #[serde(skip)]
    pub shape: Option<usize>,
    pub mark: String,
    pub filled: bool,
    pub swatch: bool,
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
        }
    }

    /// Left to right over the plot.
    pub fn x_scale(&self, to: f64) -> Scale {
        Scale { from: 0.0, to, px_from: self.plot.x, px_to: self.plot.x + self.plot.w }
    }

    /// Bottom to top over the plot.
    pub fn y_scale(&self, to: f64) -> Scale {
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

    /// A legend below everything, in as many columns as its texts leave room for.
    pub fn add_legend(&mut self, mut keys: Vec<Key>) {
        let widest = keys.iter().map(|key| wording::width(&key.full, FONT)).fold(0.0, f64::max);
        let columns = ((self.width - 12.0) / (widest + LEGEND_KEY + 18.0)).floor().clamp(1.0, 4.0) as usize;
        let columns = columns.min(keys.len()).max(1);
        let each = (self.width - 12.0) / columns as f64;
        let top = self.height + 12.0;
        for (i, key) in keys.iter_mut().enumerate() {
            key.x = rounded(10.0 + (i % columns) as f64 * each);
            key.y = top + (i / columns) as f64 * LEGEND_ROW;
            key.text = wording::fitted(&key.full, FONT, each - LEGEND_KEY - 6.0);
            if let Some(shape) = key.shape {
                key.mark = mark_path(shape, key.x + 11.0, key.y, 4.0);
            }
        }
        self.height = top + keys.len().div_ceil(columns) as f64 * LEGEND_ROW - 4.0;
        self.legend = keys;
    }
}

impl Key {
    /// An entry with a line, a mark or both.
    pub fn new(text: &str, tone: Tone, line: Option<&'static str>, shape: Option<usize>, filled: bool) -> Self {
        let (text, full, mark) = (String::new(), text.to_owned(), String::new());
        Self { x: 0.0, y: 0.0, text, full, tone, line, shape, mark, filled, swatch: false }
    }

    /// An entry with a patch of colour.
    pub fn patch(text: &str, tone: Tone, filled: bool) -> Self {
        Self { swatch: true, ..Self::new(text, tone, None, None, filled) }
    }
}

fn name_tick(at: f64, name: &str, room: f64) -> Tick {
    Tick { at, text: wording::fitted(name, FONT, room), full: name.to_owned() }
}

/// The mark of collectives.
pub(crate) const DIAMOND: usize = 3;
/// The mark of what is known to be wrong.
pub(crate) const CROSS: usize = 6;

/// A mark of radius `r` about a point, as a path: circle, square, triangle, diamond, triangle on its tip, hexagon; [`CROSS`] last.
pub(crate) fn mark_path(mark: usize, x: f64, y: f64, r: f64) -> String {
    let polygon = |corners: &[(f64, f64)]| {
        let corners: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{} {}", rounded(x + dx * r), rounded(y + dy * r))).collect();
        format!("M{}Z", corners.join("L"))
    };
    match mark {
        CROSS => {
            let (l, t, e, b) = (rounded(x - r), rounded(y - r), rounded(x + r), rounded(y + r));
            format!("M{l} {t}L{e} {b}M{e} {t}L{l} {b}")
        }
        other => match other % 6 {
            0 => format!("M{} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z", rounded(x - r), d = 2.0 * r),
            1 => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            2 => polygon(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)]),
            3 => polygon(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
            4 => polygon(&[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)]),
            _ => polygon(&[(-1.1, 0.0), (-0.55, -1.0), (0.55, -1.0), (1.1, 0.0), (0.55, 1.0), (-0.55, 1.0)]),
        },
    }
}

/// Straight lines through points.
pub(crate) fn polyline(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let mut d = String::new();
    for (i, (x, y)) in points.into_iter().enumerate() {
        d.push_str(&format!("{}{x} {y}", if i == 0 { "M" } else { "L" }));
    }
    d
}
