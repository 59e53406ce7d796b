//! The legend of a chart: what its marks and lines are, and which of them can be switched.

use super::elements::Key;
use super::layout::{Chart, FONT};
use super::scale::rounded;
use super::shape::mark_path;
use super::text::{fitted, width};

const LEGEND_ROW: f64 = 19.0;
const LEGEND_KEY: f64 = 30.0;

impl Chart {
    /// A legend below everything, in as many columns as its texts leave room for.
    pub fn add_legend(&mut self, mut keys: Vec<Key>) {
        let widest = keys.iter().map(|key| width(&key.full, FONT)).fold(0.0, f64::max);
        let columns = ((self.width - 12.0) / (widest + LEGEND_KEY + 18.0)).floor().clamp(1.0, 4.0) as usize;
        let columns = columns.min(keys.len()).max(1);
        let each = (self.width - 12.0) / columns as f64;
        let top = self.height + 12.0;
        for (i, key) in keys.iter_mut().enumerate() {
            key.x = rounded(10.0 + (i % columns) as f64 * each);
            key.y = top + (i / columns) as f64 * LEGEND_ROW;
            key.text = fitted(&key.full, FONT, each - LEGEND_KEY - 6.0);
            if let Some(shape) = key.shape {
                key.mark = mark_path(shape, key.x + 11.0, key.y, 4.0);
            }
        }
        self.height = top + keys.len().div_ceil(columns) as f64 * LEGEND_ROW - 4.0;
        self.legend_y = top - 14.0;
        self.legend = keys;
    }
}
