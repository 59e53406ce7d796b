//! The axes of a chart: scales over the plot, ticks of numbers and of names.

use super::elements::Tick;
use super::layout::{Chart, FONT, RIGHT, WIDTH};
use super::scale::{Scale, rounded, tick_text, ticks};
use super::text::{fitted, width};

/// Ticks at these values of an axis.
pub(crate) fn number_ticks(scale: Scale, values: impl IntoIterator<Item = f64>) -> Vec<Tick> {
    values.into_iter().map(|value| Tick::number(scale.px(value), value)).collect()
}

impl Chart {
    /// An empty chart with numbers from 0 on both axes, and its scales.
    pub fn from_zero(
        id: &str,
        title: &str,
        (most_x, x_label): (f64, &str),
        (most_y, y_label): (f64, &str),
    ) -> (Self, Scale, Scale) {
        let (x_values, y_values) = (ticks(most_x, 5), ticks(most_y, 5));
        let texts: Vec<String> = y_values.iter().map(|value| tick_text(*value)).collect();
        let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
        let mut chart = Self::new(id.to_owned(), title.to_owned(), &widest, WIDTH, 210.0);
        chart.leave_room_for(&x_values.last().map(|value| tick_text(*value)).unwrap_or_default());
        let x = chart.x_scale(x_values.last().copied().unwrap_or(1.0));
        let y = chart.y_scale(y_values.last().copied().unwrap_or(1.0));
        (chart.x_ticks, chart.y_ticks) = (number_ticks(x, x_values), number_ticks(y, y_values));
        (chart.x_label, chart.y_label) = (x_label.to_owned(), y_label.to_owned());
        (chart, x, y)
    }

    /// Narrows the plot so that a tick's text at its right end fits.
    fn leave_room_for(&mut self, last: &str) {
        self.plot.w -= rounded((0.5 * width(last, FONT) - RIGHT).max(0.0));
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
        self.slanted = names.iter().any(|(_, name)| width(name, FONT) > room);
        let limit = if self.slanted { 150.0 } else { room };
        self.x_ticks = names.iter().map(|(at, name)| name_tick(*at, name, limit)).collect();
        if self.slanted {
            let widest = self.x_ticks.iter().map(|tick| width(&tick.text, FONT)).fold(0.0, f64::max);
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
    Tick { at, text: fitted(name, FONT, room), full: name.to_owned() }
}
