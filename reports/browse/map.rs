//! Tracks from above, as SVG.

use crate::chart::scale::{rounded, tick_text};
use furrow_model::Purpose;
use serde::Serialize;

const WIDTH: f64 = 720.0;
/// No map is taller or flatter than these shares of its width.
const TALLEST: f64 = 0.75;
const FLATTEST: f64 = 0.3;
const MARGIN: f64 = 28.0;
/// Below the tracks: the scale bar.
const FOOT: f64 = 34.0;
/// Points nearer than this to the one before are left out, in units of the drawing.
const NEAR: f64 = 0.6;

/// Metres to the drawing's units; north, or ahead, is up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Canvas {
    scale: f64,
    left_m: f64,
    top_m: f64,
    offset: [f64; 2],
    height: f64,
}

impl Canvas {
    /// Around all points; a stretch of at least a metre.
    pub fn around<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points.filter(|point| point.iter().all(|value| value.is_finite())) {
            for i in 0..2 {
                (low[i], high[i]) = (low[i].min(point[i]), high[i].max(point[i]));
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [0.0; 2]);
        }
        let extent = [0, 1].map(|i| (high[i] - low[i]).max(1.0));
        let inside = WIDTH - 2.0 * MARGIN;
        let wanted = (extent[1] / extent[0] * inside).clamp(FLATTEST * inside, TALLEST * inside);
        let scale = (inside / extent[0]).min(wanted / extent[1]);
        let spare = [inside - scale * (high[0] - low[0]), wanted - scale * (high[1] - low[1])];
        let offset = spare.map(|spare| MARGIN + spare / 2.0);
        Self { scale, left_m: low[0], top_m: high[1], offset, height: wanted + 2.0 * MARGIN + FOOT }
    }

    /// Where a point is drawn.
    pub fn at(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        let (x, y) =
            (self.offset[0] + self.scale * (east - self.left_m), self.offset[1] + self.scale * (self.top_m - north));
        [rounded(x), rounded(y)]
    }

    /// A path through the points that are known; it is broken where they are not.
    pub fn path(&self, points: &[Option<[f64; 2]>]) -> String {
        let mut d = String::new();
        let mut last: Option<[f64; 2]> = None;
        let known = |point: &Option<[f64; 2]>| point.filter(|point| point.iter().all(|value| value.is_finite()));
        for (i, point) in points.iter().enumerate() {
            let Some(here) = known(point).map(|point| self.at(point)) else {
                last = None;
                continue;
            };
            let ends = points.get(i + 1).is_none_or(|next| known(next).is_none());
            let near = last.is_some_and(|last| (here[0] - last[0]).hypot(here[1] - last[1]) < NEAR);
            if near && !ends {
                continue;
            }
            d += &format!("{}{} {}", if last.is_some() { 'L' } else { 'M' }, here[0], here[1]);
            last = Some(here);
        }
        d
    }

    /// A map of these tracks.
    pub fn map(&self, label: String, caption: String, north: bool, lines: Vec<Line>) -> Map {
        let most_m = (WIDTH / 3.0) / self.scale;
        let decade = 10f64.powf(most_m.log10().floor());
        let length_m =
            [5.0, 2.0, 1.0].into_iter().map(|m| m * decade).find(|length| *length <= most_m).unwrap_or(decade);
        let text = if length_m < 1000.0 {
            format!("{} m", tick_text(length_m))
        } else {
            format!("{} km", tick_text(length_m / 1000.0))
        };
        let bar = Bar { x: MARGIN, y: rounded(self.height - 14.0), length: rounded(length_m * self.scale), text };
        Map { width: WIDTH, height: rounded(self.height), label, caption, north, bar, lines }
    }
}

/// A track.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Line {
    pub d: String,
    /// The class of its slot's colour.
    pub tone: String,
    /// Dashes by purpose, so that colour does not stand alone.
    pub dash: &'static str,
    /// Where it starts.
    pub start: Option<[f64; 2]>,
    /// The traversal that it links to; none on the page of that traversal.
    pub traversal: Option<String>,
    pub title: String,
}

#[derive(Debug, Clone, Serialize)]
struct Bar {
    x: f64,
    y: f64,
    length: f64,
    text: String,
}

/// What `templates/map.html` draws.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Map {
    width: f64,
    height: f64,
    label: String,
    caption: String,
    north: bool,
    bar: Bar,
    lines: Vec<Line>,
}

/// The dashes of a purpose.
pub(super) fn dash(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Experience => "",
        Purpose::Evaluation => "7 4",
        Purpose::Vocabulary => "2 4",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_keeps_angles_and_north_up() {
        let points = [[0.0, 0.0], [30.0, 0.0], [30.0, 20.0]];
        let canvas = Canvas::around(points.iter());
        let [start, corner, end] = points.map(|point| canvas.at(point));
        // 664 units across for 30 m: a metre is 22.13 of them, both ways.
        assert!((corner[0] - start[0] - 664.0).abs() < 0.02 && corner[1] == start[1], "{start:?} {corner:?}");
        assert!((corner[1] - end[1] - 20.0 * 664.0 / 30.0).abs() < 0.02 && end[0] == corner[0], "{end:?}");
        let map = canvas.map(String::new(), String::new(), true, Vec::new());
        assert_eq!(map.bar.text, "10 m");
        assert!((map.bar.length - 221.33).abs() < 0.01, "{}", map.bar.length);
    }

    #[test]
    fn unknown_positions_break_a_track_and_a_standstill_is_a_point() {
        let points =
            [Some([0.0, 0.0]), Some([10.0, 0.0]), None, Some([f64::NAN, 0.0]), Some([20.0, 0.0]), Some([30.0, 0.0])];
        let canvas = Canvas::around(points.iter().flatten());
        let d = canvas.path(&points);
        assert_eq!((d.matches('M').count(), d.matches('L').count()), (2, 2), "{d}");
        let still = Canvas::around([[5.0, 5.0]].iter());
        assert!(still.at([5.0, 5.0]).iter().all(|value| value.is_finite()));
        assert!(Canvas::around([].iter()).at([0.0, 0.0]).iter().all(|value| value.is_finite()));
    }
}
