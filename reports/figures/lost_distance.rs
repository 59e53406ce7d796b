//! Lost-distance curves (thesis Fig 6.3; X8, X9, X12 to X15; SPEC 4.1): a panel per live pass, a line per experience.

use super::style::Style;
use super::variants::{VARIANTS, Variant};
use super::{Figure, listed};
use crate::arrange::{Column, Row, Setting};
use crate::chart::{Band, Chart, Mark, Rule, Tick, WIDTH};
use crate::data::Data;
use crate::palette::Tones;
use crate::scale::{tick_text, ticks};
use crate::shape::{mark_path, polyline, simplified};
use crate::wording;
use furrow_model::{LostPoint, Outcome};

const NEAR_IN_KEYFRAMES: f64 = 5.0;

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Figure {
    let [survival, others @ ..] = &VARIANTS;
    // A crowded page leaves the other variants to the figure's data.
    let more: &[Variant] = if setting.crowded { &[] } else { others };
    let panels = |variant: &Variant| -> Vec<Chart> {
        setting
            .rows
            .iter()
            .enumerate()
            .flat_map(|(i, row)| charts(setting, row, &format!("{name}-lost{i}"), variant, tones))
            .collect()
    };
    let spacing = setting.distinct(|outcome| tick_text(outcome.keyframes.distance_m));
    let sources = setting.distinct(|outcome| wording::shown(&outcome.evaluation.distance_source));
    Figure {
        id: format!("{name}-lost-figure"),
        title: "How far the robot drives without knowing where it is".to_owned(),
        caption: format!(
            "Lost-distance curves, variant survival: the height at d is the chance that, at a random metre of the route, more than d metres \
             have been driven since the last localisation; at d = 0 it is the share of the route driven lost. Lower is better. A panel per \
             live pass, a line per experience; distances from {}. Shaded: 95 % band of a moving-block bootstrap along this one pass; it \
             does not cover the difference between one drive and the next. The dotted line marks the keyframe spacing of {} m: lost \
             stretches up to about that length are a matter of sub-sampling.",
            listed(sources),
            listed(spacing)
        ),
        panels: panels(survival),
        more: more.iter().map(|variant| (variant.heading.to_owned() + variant.reading, panels(variant))).collect(),
        data: data(setting),
    }
}

fn data(setting: &Setting<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "variant", "d_m", "value", "low", "high"]);
    for (row, column, cell) in setting.places() {
        let curve = drawn_part(&cell.outcome.evaluation.lost.curve, f64::INFINITY);
        for variant in &VARIANTS {
            for point in curve {
                let [low, high] = (variant.band)(point);
                data.push(vec![
                    cell.outcome.key.short().into(),
                    row.label.clone().into(),
                    column.label.clone().into(),
                    variant.name.into(),
                    point.distance_m.into(),
                    (variant.value)(point).into(),
                    low.into(),
                    high.into(),
                ]);
            }
        }
    }
    data
}

/// The whole range; and the first metres, where they would be squeezed together.
fn charts(setting: &Setting<'_>, row: &Row<'_>, id: &str, variant: &Variant, tones: &Tones) -> Vec<Chart> {
    let outcomes = row.cells.iter().flatten().map(|cell| &cell.outcome);
    let whole = outcomes.clone().map(reach_m).fold(0.0, f64::max);
    let spacing = outcomes.map(|outcome| outcome.keyframes.distance_m).fold(0.0, f64::max);
    let near = NEAR_IN_KEYFRAMES * spacing;
    let id = format!("{id}-{}", variant.name.replace(' ', "-"));
    let mut charts = vec![chart(setting, row, &id, whole.max(spacing), variant, tones)];
    if whole > 3.0 * near && near > 0.0 && !setting.crowded {
        let mut close = chart(setting, row, &format!("{id}-near"), near, variant, tones);
        close.title = wording::fitted(&format!("{}, the first {} m", close.title, tick_text(near)), 13.0, WIDTH - 20.0);
        charts.push(close);
    }
    charts
}

/// The distance from which on nothing is left to draw.
fn reach_m(outcome: &Outcome) -> f64 {
    let curve = &outcome.evaluation.lost.curve;
    let alive =
        curve.iter().filter(|p| p.survival > 0.0 || p.survival_band[1] > 0.0).map(|p| p.distance_m).fold(0.0, f64::max);
    alive.max(outcome.evaluation.lost.max_lost_m)
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: &str, to_m: f64, variant: &Variant, tones: &Tones) -> Chart {
    let title = format!("Live {}: {}", row.label, variant.name);
    let mut chart = Chart::new(id.to_owned(), title, &["100"], WIDTH, 210.0);
    let x_ticks = ticks(to_m, 6);
    let (x, y) = (chart.x_scale(x_ticks.last().copied().unwrap_or(1.0)), chart.y_scale(1.0));
    chart.x_ticks = x_ticks
        .iter()
        .map(|tick| (x.px(*tick), tick_text(*tick)))
        .map(|(at, text)| Tick { at, full: text.clone(), text })
        .collect();
    let quarter = |i: i32| f64::from(i) / 4.0;
    chart.y_ticks = (0..5)
        .map(|i| (y.px(quarter(i)), tick_text(quarter(i))))
        .map(|(at, text)| Tick { at, full: text.clone(), text })
        .collect();
    chart.x_label = "d: distance driven lost (m)".to_owned();
    chart.y_label = variant.reading.to_owned();
    let mut told = Vec::new();
    let mut keys = Vec::new();
    for (index, (column, cell)) in setting.columns.iter().zip(&row.cells).enumerate() {
        let Some(cell) = cell else { continue };
        let style = Style::of(column, index, setting, tones);
        let lost = &cell.outcome.evaluation.lost;
        let text = if lost.stretches.is_empty() {
            format!("{}: never lost", column.label)
        } else {
            let share = wording::percent(lost.lost_fraction);
            format!(
                "{}: lost on {share} of the route, at most {} m at a stretch",
                column.label,
                wording::tenths(lost.max_lost_m)
            )
        };
        let curve = drawn_part(&lost.curve, x.to);
        let points: Vec<(f64, f64)> = curve.iter().map(|p| (p.distance_m, (variant.value)(p))).collect();
        // As fine as a pen: what a crowded page leaves out is not seen.
        let drawn = |path: Vec<(f64, f64)>| if setting.crowded { simplified(&path, 0.3) } else { path };
        let path = drawn(points.iter().map(|(d, p)| (x.px(*d), y.px(*p))).collect()).into_iter();
        let band = |end: usize| curve.iter().map(move |p| (x.px(p.distance_m), y.px((variant.band)(p)[end])));
        let outline: Vec<(f64, f64)> = if variant.steps {
            corners(band(1)).into_iter().chain(corners(band(0)).into_iter().rev()).collect()
        } else {
            band(1).chain(band(0).rev()).collect()
        };
        let key = cell.outcome.key.short();
        chart.bands.push(Band {
            d: polyline(drawn(outline)) + "Z",
            tone: style.tone.clone(),
            series: Some(index),
            data: vec![("cell", key.clone())],
        });
        let list = |value: fn(&(f64, f64)) -> f64| {
            points.iter().map(|point| value(point).to_string()).collect::<Vec<_>>().join(" ")
        };
        let d = if variant.steps { stepped(path) } else { polyline(path) };
        let mut data = vec![("cell", key.clone()), ("variant", variant.name.to_owned())];
        if !setting.crowded {
            data.extend([("d", list(|p| p.0)), ("p", list(|p| p.1))]);
        }
        chart.lines.push(style.line(column, d, &text, data));
        let within: Vec<&LostPoint> = curve.iter().filter(|p| p.distance_m <= x.to).collect();
        for point in thinned(&within, index, if setting.crowded { 1 } else { 6 }) {
            chart.marks.push(mark(
                &style,
                (column, &key),
                point,
                variant,
                x.px(point.distance_m),
                y.px((variant.value)(point)),
            ));
        }
        keys.push(style.key(&column.label));
        told.push(text);
    }
    for outcome in setting.distinct(|outcome| tick_text(outcome.keyframes.distance_m)) {
        let spacing: f64 = outcome.parse().unwrap_or(0.0);
        if spacing <= x.to {
            chart.rules.push(Rule {
                x: x.px(spacing),
                text: format!("keyframes every {outcome} m"),
                before: spacing > 0.6 * x.to,
            });
        }
    }
    chart.desc = match setting.crowded {
        true => {
            format!("Variant {}, {} experiences; their numbers are in the table of cells.", variant.name, told.len())
        }
        false => format!("Variant {}. {}.", variant.name, told.join("; ")),
    };
    chart.add_legend(keys);
    chart
}

/// The curve up to the chart's end and to its first point at zero, after which it stays there.
fn drawn_part(curve: &[LostPoint], to_m: f64) -> &[LostPoint] {
    let over = |p: &LostPoint| {
        p.distance_m >= to_m
            || [p.survival_band[1], p.length_biased_band[1], p.per_gap_band[1]].iter().all(|high| *high <= 0.0)
    };
    let end = curve.iter().position(over).map_or(curve.len(), |last| last + 1);
    &curve[..end]
}

/// Up to `wanted` of the points, others for each line so that marks do not cover each other; all of a short curve.
fn thinned<'p>(points: &[&'p LostPoint], index: usize, wanted: usize) -> Vec<&'p LostPoint> {
    let every = if points.len() <= wanted + 2 { 1 } else { points.len().div_ceil(wanted) };
    points.iter().skip((index * 2) % every.max(1)).step_by(every).copied().collect()
}

fn mark(style: &Style, (column, cell): (&Column, &str), point: &LostPoint, variant: &Variant, x: f64, y: f64) -> Mark {
    let value = (variant.value)(point);
    let [low, high] = (variant.band)(point).map(wording::percent);
    Mark {
        d: mark_path(style.mark, x, y, 3.2),
        tone: style.tone.clone(),
        filled: style.filled,
        title: format!(
            "{}, d = {} m: {} (95 % band {low} to {high})",
            column.label,
            tick_text(point.distance_m),
            wording::percent(value)
        ),
        series: Some(style.series),
        data: vec![("cell", cell.to_owned()), ("d", point.distance_m.to_string()), ("p", value.to_string())],
    }
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

/// Each value holds until the next point.
fn stepped(points: impl Iterator<Item = (f64, f64)>) -> String {
    let mut d = String::new();
    for (x, y) in points {
        d.push_str(&if d.is_empty() { format!("M{x} {y}") } else { format!("H{x}V{y}") });
    }
    d
}
