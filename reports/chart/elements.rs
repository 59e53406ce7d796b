//! The elements of a chart. Coordinates are units of its viewBox.
//!
//! `data` carries the numbers that an element was drawn from, and `cell` or `cells` whose they are; `series` is the
//! legend entry that switches it.

use super::palette::Tone;
use super::scale::tick_text;
use serde::Serialize;

/// A tick: where, what it says, and the whole of it where it had to be cut.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Tick {
    pub at: f64,
    pub text: String,
    pub full: String,
}

impl Tick {
    /// A tick with a text that fits.
    pub fn new(at: f64, text: String) -> Self {
        Self { at, full: text.clone(), text }
    }

    /// A tick of a number.
    pub fn number(at: f64, value: f64) -> Self {
        Self::new(at, tick_text(value))
    }
}

/// A shaded band, as a path.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Band {
    pub d: String,
    pub tone: Tone,
    pub series: Option<usize>,
    pub data: Vec<(&'static str, String)>,
}

/// A line, as a path.
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

/// An entry of the legend: a line, a mark, both, or a swatch of colour.
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
    /// What it switches on and off; none of an entry that only explains.
    pub series: Option<usize>,
}

impl Key {
    /// An entry with a line, a mark or both.
    pub fn new(text: &str, tone: Tone, line: Option<&'static str>, shape: Option<usize>, filled: bool) -> Self {
        let (text, full, mark) = (String::new(), text.to_owned(), String::new());
        Self { x: 0.0, y: 0.0, text, full, tone, line, shape, mark, filled, swatch: false, series: None }
    }

    /// An entry with a patch of colour.
    pub fn patch(text: &str, tone: Tone, filled: bool) -> Self {
        Self { swatch: true, ..Self::new(text, tone, None, None, filled) }
    }

    /// The same, as a switch of a series.
    pub fn switching(self, series: usize) -> Self {
        Self { series: Some(series), ..self }
    }
}
