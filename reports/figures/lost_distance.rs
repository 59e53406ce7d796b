//! Lost-distance curves (thesis Fig 6.3; experiments X8, X9, X12 to X15): a panel per live traversal, a line per
//! experience.

use super::arrange::{Row, Setting};
use super::data::{Data, Value};
use super::figure::Figure;
use super::lost_curve;
use super::variants::{VARIANTS, Variant};
use crate::chart::Chart;
use crate::chart::palette::Tones;
use crate::chart::scale::tick_text;
use crate::wording::listed;
use furrow_model::Outcome;

/// The first metres, in keyframe spacings.
const NEAR_IN_KEYFRAMES: f64 = 5.0;

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Figure {
    let [survival, others @ ..] = &VARIANTS;
    // A crowded page leaves the other variants to the figure's data.
    let more: &[Variant] = if setting.crowded { &[] } else { others };
    let panels = |variant: &Variant| -> Vec<Chart> {
        let rows = setting.rows.iter().enumerate();
        rows.flat_map(|(i, row)| charts(setting, row, &format!("{name}-lost{i}"), variant, tones)).collect()
    };
    let spacing = setting.distinct(|outcome| tick_text(outcome.keyframes.distance_m));
    Figure {
        id: format!("{name}-lost-figure"),
        title: "How far the robot travels without a localisation".to_owned(),
        caption: format!(
            "Lost-distance curves, variant survival: the value at d is the probability that, at a random metre of the \
             route, the robot has travelled more than d metres since its last localisation; at d = 0 it is the \
             fraction of the route travelled while lost. Lower is better. One panel per live traversal, one line per \
             experience; distances from {}. Shaded: 95 % band along this one road; it does not cover the variation \
             between traversals, and a traversal of less than 60 m has none. The dotted line marks the keyframe \
             spacing of {} m: lost stretches up to about that length are an effect of sub-sampling.",
            setting.distance_sources(),
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
        let curve = lost_curve::drawn_part(&cell.outcome.evaluation.lost.curve, f64::INFINITY);
        for variant in &VARIANTS {
            for point in curve {
                let band = (variant.band)(point);
                let [low, high] = band.map_or([Value::Missing, Value::Missing], |ends| ends.map(Value::from));
                let value = (variant.value)(point).into();
                let rest = vec![variant.name.into(), point.distance_m.into(), value, low, high];
                data.push_cell((row, column, cell), rest);
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
    let mut charts = vec![lost_curve::chart(setting, row, &id, whole.max(spacing), variant, tones)];
    if whole > 3.0 * near && near > 0.0 && !setting.crowded {
        let mut close = lost_curve::chart(setting, row, &format!("{id}-near"), near, variant, tones);
        close.set_title(&format!("{}, the first {} m", close.title, tick_text(near)));
        charts.push(close);
    }
    charts
}

/// The distance from which on nothing is left to draw.
fn reach_m(outcome: &Outcome) -> f64 {
    let lost = &outcome.evaluation.lost;
    let alive = lost.curve.iter().filter(|p| p.survival > 0.0);
    alive.map(|p| p.distance_m).fold(0.0, f64::max).max(lost.max_lost_m)
}
