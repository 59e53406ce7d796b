//! One chart of lost-distance curves.

use super::arrange::{Column, Row, Setting};
use super::style::Style;
use super::variants::Variant;
use crate::chart::elements::{Band, Mark, Rule};
use crate::chart::palette::Tones;
use crate::chart::scale::{Scale, tick_text, ticks};
use crate::chart::shape::{mark_path, polyline, simplified};
use crate::chart::text::spaced;
use crate::chart::{Chart, WIDTH, number_ticks};
use crate::input::CellInput;
use crate::wording;
use furrow_model::{LostDistance, LostPoint};

/// The curves of a live traversal in one variant, up to a distance.
pub(super) fn chart(
    setting: &Setting<'_>,
    row: &Row<'_>,
    id: &str,
    to_m: f64,
    variant: &Variant,
    tones: &Tones,
) -> Chart {
    let title = format!("Live {}: {}", row.label, variant.name);
    let mut chart = Chart::new(id.to_owned(), title, &["100"], WIDTH, 210.0);
    let x_ticks = ticks(to_m, 6);
    let (x, y) = (chart.x_scale(x_ticks.last().copied().unwrap_or(1.0)), chart.y_scale(1.0));
    chart.x_ticks = number_ticks(x, x_ticks);
    chart.y_ticks = number_ticks(y, (0..5).map(|i| f64::from(i) / 4.0));
    chart.x_label = "d: distance travelled while lost (m)".to_owned();
    chart.y_label = variant.reading.to_owned();
    let (mut texts, mut keys) = (Vec::new(), Vec::new());
    for (index, (column, cell)) in setting.columns.iter().zip(&row.cells).enumerate() {
        let Some(cell) = cell else { continue };
        let style = Style::of(column, index, setting, tones);
        let text = lost_text(column, &cell.outcome.evaluation.lost);
        let curve = Curve { column, cell, variant, style: &style, crowded: setting.crowded };
        curve.draw(&mut chart, (x, y), &text);
        keys.push(style.key(&column.label));
        texts.push(text);
    }
    let spacings = setting.distinct(|outcome| tick_text(outcome.keyframes.distance_m));
    for (text, spacing) in spacings.iter().filter_map(|text| Some((text, text.parse::<f64>().ok()?))) {
        if spacing <= x.to {
            let text = format!("keyframes every {text} m");
            chart.rules.push(Rule { x: x.px(spacing), text, before: spacing > 0.6 * x.to });
        }
    }
    chart.desc = match setting.crowded {
        true => {
            format!("Variant {}, {} experiences; their numbers are in the table of cells.", variant.name, texts.len())
        }
        false => format!("Variant {}. {}.", variant.name, texts.join("; ")),
    };
    chart.add_legend(keys);
    chart
}

fn lost_text(column: &Column, lost: &LostDistance) -> String {
    if lost.stretches.is_empty() {
        return format!("{}: never lost", column.label);
    }
    let (share, longest) = (wording::percent(lost.lost_fraction), wording::tenths(lost.max_lost_m));
    format!("{}: lost on {share} of the route, at most {longest} m at a stretch", column.label)
}

/// The curve up to the chart's end and to its first point at zero, after which it stays there.
pub(super) fn drawn_part(curve: &[LostPoint], to_m: f64) -> &[LostPoint] {
    let is_over = |p: &LostPoint| {
        p.distance_m >= to_m || [p.survival, p.length_biased, p.per_gap].iter().all(|value| *value <= 0.0)
    };
    let end = curve.iter().position(is_over).map_or(curve.len(), |last| last + 1);
    &curve[..end]
}

/// The curve of one experience.
struct Curve<'a> {
    column: &'a Column,
    cell: &'a CellInput,
    variant: &'a Variant,
    style: &'a Style,
    crowded: bool,
}

impl Curve<'_> {
    /// Its band, its line, and marks on it.
    fn draw(&self, chart: &mut Chart, (x, y): (Scale, Scale), text: &str) {
        let (variant, key) = (self.variant, self.cell.outcome.key.short());
        let curve = drawn_part(&self.cell.outcome.evaluation.lost.curve, x.to);
        // A crowded page leaves out what is finer than a pen.
        let drawn = |path: Vec<(f64, f64)>| if self.crowded { simplified(&path, 0.3) } else { path };
        let banded = || curve.iter().filter_map(|p| Some((p.distance_m, (variant.band)(p)?)));
        let bound = |end: usize| banded().map(move |(d, band)| (x.px(d), y.px(band[end])));
        let outline: Vec<(f64, f64)> = if variant.steps {
            corners(bound(1)).into_iter().chain(corners(bound(0)).into_iter().rev()).collect()
        } else {
            bound(1).chain(bound(0).rev()).collect()
        };
        if !outline.is_empty() {
            chart.bands.push(Band {
                d: polyline(drawn(outline)) + "Z",
                tone: self.style.tone.clone(),
                series: Some(self.style.series),
                data: vec![("cell", key.clone())],
            });
        }
        let path = drawn(curve.iter().map(|p| (x.px(p.distance_m), y.px((variant.value)(p)))).collect());
        let d = if variant.steps { stepped(path) } else { polyline(path) };
        let mut data = vec![("cell", key), ("variant", variant.name.to_owned())];
        if !self.crowded {
            data.push(("d", spaced(curve.iter().map(|p| p.distance_m))));
            data.push(("p", spaced(curve.iter().map(variant.value))));
        }
        chart.lines.push(self.style.line(self.column, d, text, data));
        let within: Vec<&LostPoint> = curve.iter().filter(|p| p.distance_m <= x.to).collect();
        let marks = thinned(&within, self.style.series, if self.crowded { 1 } else { 6 });
        chart.marks.extend(marks.into_iter().map(|point| self.mark(point, (x, y))));
    }

    fn mark(&self, point: &LostPoint, (x, y): (Scale, Scale)) -> Mark {
        let value = (self.variant.value)(point);
        let band = (self.variant.band)(point).map(|ends| ends.map(wording::percent));
        let band = band.map_or(String::new(), |[low, high]| format!(" (95 % band {low} to {high})"));
        let (name, d, shown) = (&self.column.label, tick_text(point.distance_m), wording::percent(value));
        Mark {
            d: mark_path(self.style.mark, x.px(point.distance_m), y.px(value), 3.2),
            tone: self.style.tone.clone(),
            filled: self.style.filled,
            title: format!("{name}, d = {d} m: {shown}{band}"),
            series: Some(self.style.series),
            data: vec![
                ("cell", self.cell.outcome.key.short()),
                ("d", point.distance_m.to_string()),
                ("p", value.to_string()),
            ],
        }
    }
}

/// Up to `wanted` of the points, others for each line so that marks do not cover each other; all of a short curve.
fn thinned<'p>(points: &[&'p LostPoint], index: usize, wanted: usize) -> Vec<&'p LostPoint> {
    let every = if points.len() <= wanted + 2 { 1 } else { points.len().div_ceil(wanted) };
    points.iter().skip((index * 2) % every.max(1)).step_by(every).copied().collect()
}

/// The corners of a line whose values hold until the next point.
fn corners(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for (x, y) in points {
        corners.extend(corners.last().map(|last| (x, last.1)));
        corners.push((x, y));
    }
    corners
}

/// A path in which each value holds until the next point.
fn stepped(points: Vec<(f64, f64)>) -> String {
    let mut d = String::new();
    for (x, y) in points {
        d.push_str(&if d.is_empty() { format!("M{x} {y}") } else { format!("H{x}V{y}") });
    }
    d
}
