//! Whether one contender beats another: differences with whiskers around zero, a panel per measure, a row per contrast.

use super::contrast_measures::{MEASURES, Measure, data, rows};
use super::contrast_rows::title;
use super::figure::Figure;
use crate::chart::elements::{Key, Line, Mark, Note, Tick};
use crate::chart::palette::Tone;
use crate::chart::scale::{Scale, rounded, tick_text, ticks};
use crate::chart::shape::{CROSS, mark_path};
use crate::chart::text::fitted;
use crate::chart::{Chart, WIDTH};
use crate::wording;
use furrow_model::metric::RIGHT;
use furrow_model::{Contrast, Difference, Verdict, chance, signed};

const ROW: f64 = 34.0;
/// How far the axis goes beyond its last tick.
const ENDS: f64 = 1.06;
const BETTER: usize = 2;
const WORSE: usize = 4;
const OPEN: usize = 0;
const SHORT: usize = CROSS;

/// None where the matrix asks for no contrast.
pub(super) fn figure(contrasts: &[Contrast]) -> Option<Figure> {
    let truth = contrasts.iter().find_map(|contrast| contrast.truth.as_deref()).map(wording::shown);
    let right = |truth| format!(" Right localisations are judged by {truth}; {RIGHT}.");
    let judged = truth.map_or(String::new(), right);
    (!contrasts.is_empty()).then(|| Figure {
        id: "contrasts-figure".to_owned(),
        title: "Differences between contenders on the same traversal".to_owned(),
        caption: format!(
            "Each row is one contender minus another on the same live traversal, or on all traversals pooled where \
             there are several (the table lists each): localisations as percentage points of the live frames, lost as \
             percentage points of the route, the area under the lost-distance curve in metres. Whiskers are 95 % \
             intervals by Student's t. Where several traversals are pooled they cover the variation between \
             traversals of these routes; of a single one they cover its road only, in stretches that the data says are \
             independent, of 10 m at least. A single traversal of less than 60 m has too little road for an interval: \
             a cross without whiskers. Triangles are separable from zero: pointing up better, pointing down worse; \
             rings are not. Of twenty rows without any difference one is expected to look separable: a hollow triangle \
             is not separable when corrected for the number of contrasts asked (Holm).{judged}"
        ),
        panels: MEASURES.iter().filter_map(|measure| panel(measure, contrasts)).collect(),
        more: Vec::new(),
        data: data(contrasts),
    })
}

fn panel(measure: &Measure, contrasts: &[Contrast]) -> Option<Chart> {
    let rows = rows(measure, contrasts);
    let reach = |(_, d): &(&Contrast, Difference)| {
        d.interval.unwrap_or_default().map(f64::abs).into_iter().fold(d.difference.abs(), f64::max)
    };
    let most = rows.iter().map(reach).reduce(f64::max)?;
    let steps = ticks(most, 3);
    let top = steps.last().copied().unwrap_or(1.0);
    let (id, height) = (format!("contrasts-{}", measure.id), ROW * rows.len() as f64 + 8.0);
    let mut chart = Chart::new(id, measure.title.to_owned(), &[], WIDTH, height);
    // The labels at both ends have room within the drawing.
    let end = top * ENDS;
    let x = Scale { from: -end, to: end, px_from: chart.plot.x, px_to: chart.plot.x + chart.plot.w };
    chart.x_range = Some([-end, end]);
    let both = steps.iter().skip(1).rev().map(|step| -step).chain(steps.iter().copied());
    chart.x_ticks = both.map(|value| Tick::new(x.px(value), signed_tick(value))).collect();
    chart.x_label = measure.x_label.to_owned();
    chart.grid = (false, true);
    let (zero, bottom) = (x.px(0.0), chart.plot.y + chart.plot.h);
    chart.lines.push(Line {
        d: format!("M{zero} {}V{bottom}", chart.plot.y),
        tone: Tone::ink(),
        dash: "",
        width: 1.0,
        title: "no difference".to_owned(),
        series: None,
        data: Vec::new(),
    });
    for (i, (contrast, difference)) in rows.iter().enumerate() {
        let y = chart.plot.y + ROW * (i as f64 + 0.5) + 12.0;
        draw(&mut chart, x, y, contrast, difference);
    }
    chart.desc = rows.iter().map(|(contrast, d)| row_text(contrast, d)).collect::<Vec<_>>().join("; ");
    let mut keys = vec![
        Key::new("better", Tone::plain(), None, Some(BETTER), true).switching(BETTER),
        Key::new("worse", Tone::wrong(), None, Some(WORSE), true).switching(WORSE),
        Key::new("not separable", Tone::ink(), None, Some(OPEN), false).switching(OPEN),
    ];
    if rows.iter().any(|(_, difference)| difference.interval.is_none()) {
        keys.push(Key::new("too little road", Tone::ink(), None, Some(SHORT), false).switching(SHORT));
    }
    chart.add_legend(keys);
    Some(chart)
}

fn draw(chart: &mut Chart, x: Scale, y: f64, contrast: &Contrast, difference: &Difference) {
    let (tone, shape) = match difference.verdict {
        Verdict::Better => (Tone::plain(), BETTER),
        Verdict::Worse => (Tone::wrong(), WORSE),
        Verdict::NotSeparable => (Tone::ink(), OPEN),
        Verdict::TooLittleRoad => (Tone::ink(), SHORT),
    };
    let full = title(contrast);
    let text = fitted(&full, 11.0, chart.plot.w);
    chart.notes.push(Note { x: chart.plot.x, y: y - 9.0, text, full });
    chart.lines.extend(difference.interval.map(|[low, high]| Line {
        d: format!("M{} {y}H{}", x.px(low), x.px(high)),
        tone: tone.clone(),
        dash: "",
        width: 1.6,
        title: row_text(contrast, difference),
        series: Some(shape),
        data: vec![
            ("of", wording::shown(&contrast.of)),
            ("over", wording::shown(&contrast.over)),
            ("low", low.to_string()),
            ("high", high.to_string()),
        ],
    }));
    chart.marks.push(Mark {
        d: mark_path(shape, x.px(difference.difference), rounded(y), 4.2),
        tone,
        filled: matches!(difference.verdict, Verdict::Better | Verdict::Worse) && !difference.falls_when_corrected(),
        title: row_text(contrast, difference),
        series: Some(shape),
        data: vec![("difference", difference.difference.to_string())],
    });
}

fn row_text(contrast: &Contrast, difference: &Difference) -> String {
    let number = |value: f64| signed(value, 2);
    let (title, value, verdict) = (title(contrast), number(difference.difference), difference.verdict);
    let Some([low, high]) = difference.interval.map(|interval| interval.map(number)) else {
        return format!("{title}: {value}, {verdict}");
    };
    let chances = difference.p.zip(difference.p_holm);
    let chances = chances.map_or(String::new(), |(p, holm)| format!(", p {}, Holm {}", chance(p), chance(holm)));
    format!("{title}: {value} (95 % interval {low} to {high}), {verdict}{chances}")
}

/// A tick with its sign, as its neighbours on the axis are written.
fn signed_tick(value: f64) -> String {
    let text = tick_text(value.abs());
    match value {
        value if value < 0.0 => format!("\u{2212}{text}"),
        value if value > 0.0 => format!("+{text}"),
        _ => text,
    }
}
