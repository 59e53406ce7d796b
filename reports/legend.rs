//! The legend of a chart: what its marks and lines are, and which of them can be switched.

use crate::chart::{Chart, FONT};
use crate::palette::Tone;
use crate::scale::rounded;
use crate::shape::mark_path;
use crate::wording;
use serde::Serialize;

const LEGEND_ROW: f64 = 19.0;
const LEGEND_KEY: f64 = 30.0;

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
    /// What it switches on and off; none of an entry that only explains.
    pub series: Option<usize>,
}

impl Chart {
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
        self.legend_y = top - 14.0;
        self.legend = keys;
    }
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

    /// The same, and a switch of a series.
    pub fn of(self, series: usize) -> Self {
        Self { series: Some(series), ..self }
    }
}
