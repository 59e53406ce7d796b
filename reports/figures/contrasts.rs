//! Whether one contender beats another: differences with whiskers around zero, a panel per measure, a row per contrast.

use super::Figure;
use crate::chart::{Chart, Line, Mark, Note, Tick, WIDTH};
use crate::data::Data;
use crate::legend::Key;
use crate::palette::Tone;
use crate::scale::{Scale, rounded, tick_text, ticks};
use crate::shape::mark_path;
use crate::wording;
use furrow_model::{Contrast, Difference, Verdict, signed};

const ROW: f64 = 34.0;
/// How far the axis goes beyond its last tick.
const ENDS: f64 = 1.06;
const BETTER: usize = 2;
const WORSE: usize = 4;
const OPEN: usize = 0;

/// A measure as it is drawn.
struct Measure {
    id: &'static str,
    title: &'static str,
    x_label: &'static str,
    of: fn(&Contrast) -> Option<(Difference, f64)>,
}

/// Counts are drawn as shares of the live frames, so that passes of other lengths stand beside each other.
const MEASURES: [Measure; 4] = [
    Measure {
        id: "right",
        title: "Right localisations: difference",
        x_label: "points of live frames; to the right is better",
        of: |contrast| Some((contrast.right?, 100.0 / f64::from(contrast.frames.max(1)))),
    },
    Measure {
        id: "good",
        title: "Good localisations: difference",
        x_label: "points of live frames; to the right is better",
        of: |contrast| Some((contrast.good, 100.0 / f64::from(contrast.frames.max(1)))),
    },
    Measure {
        id: "lost",
        title: "Lost: difference",
        x_label: "points of the route; to the left is better",
        of: |contrast| Some((contrast.lost_fraction, 100.0)),
    },
    Measure {
        id: "area",
        title: "Lost-distance area: difference",
        x_label: "metres; to the left is better",
        of: |contrast| Some((contrast.area_m, 1.0)),
    },
];

/// None where nothing was set against anything.
pub(crate) fn figure(contrasts: &[Contrast]) -> Option<Figure> {
    let truth = contrasts.iter().find_map(|contrast| contrast.truth.as_deref()).map(wording::shown);
    let judged = truth.map_or(String::new(), |truth| format!(" Right is what {truth} says is the right place."));
    (!contrasts.is_empty()).then(|| Figure {
        id: "contrasts-figure".to_owned(),
        title: "Differences between contenders on the same drive".to_owned(),
        caption: format!(
            "A row is one contender less another on the same live pass, or on all passes pooled where there are several (the table has each): \
             localisations as percentage points of the live frames, lost as points of the route, the area under the lost-distance curve in metres. Whiskers are 95 % \
             intervals of a bootstrap of moving blocks of 10 m that go around, the same blocks drawn for both, along the passes that were driven: they do \
             not cover the difference between one drive and the next, and each row stands for itself: of twenty rows without any difference one \
             is expected to look separable. Drives that come to less than 30 m have no interval: their whiskers span all that could be. Triangles are separable from zero: upright better, on the tip worse; rings are not.{judged}"
        ),
        panels: MEASURES.iter().filter_map(|measure| panel(measure, contrasts)).collect(),
        more: Vec::new(),
        data: data(contrasts),
    })
}

fn data(contrasts: &[Contrast]) -> Data {
    let mut data =
        Data::new(&["measure", "of", "over", "setting", "live", "frames", "difference", "low", "high", "verdict"]);
    for measure in &MEASURES {
        for (contrast, difference) in rows(measure, contrasts) {
            let [low, high] = difference.interval;
            let names = [&contrast.of, &contrast.over, &contrast.setting].map(|name| wording::shown(name).into());
            let [of, over, setting] = names;
            let (live, verdict) = (live(contrast, contrasts), difference.verdict.to_string());
            data.push(vec![
                measure.id.into(),
                of,
                over,
                setting,
                live.into(),
                contrast.frames.into(),
                difference.difference.into(),
                low.into(),
                high.into(),
                verdict.into(),
            ]);
        }
    }
    data
}

/// The contrasts a panel draws, in its unit: each pass alone only where it is not pooled with others.
fn rows<'c>(measure: &Measure, contrasts: &'c [Contrast]) -> Vec<(&'c Contrast, Difference)> {
    contrasts
        .iter()
        .filter(|contrast| contrast.live.len() > 1 || !pooled(contrast, contrasts))
        .filter_map(|contrast| (measure.of)(contrast).map(|(difference, unit)| (contrast, scaled(&difference, unit))))
        .collect()
}

fn panel(measure: &Measure, contrasts: &[Contrast]) -> Option<Chart> {
    let rows = rows(measure, contrasts);
    let reach = |(_, d): &(&Contrast, Difference)| d.interval[0].abs().max(d.interval[1].abs());
    let most = rows.iter().map(reach).reduce(f64::max)?;
    let steps = ticks(most, 3);
    let top = steps.last().copied().unwrap_or(1.0);
    let mut chart = Chart::new(
        format!("contrasts-{}", measure.id),
        measure.title.to_owned(),
        &[],
        WIDTH,
        ROW * rows.len() as f64 + 8.0,
    );
    // The labels at both ends have room within the drawing.
    let end = top * ENDS;
    let x = Scale { from: -end, to: end, px_from: chart.plot.x, px_to: chart.plot.x + chart.plot.w };
    chart.x_range = Some([-end, end]);
    let both = steps.iter().skip(1).rev().map(|step| -step).chain(steps.iter().copied());
    chart.x_ticks = both.map(|value| Tick { at: x.px(value), text: tick(value), full: tick(value) }).collect();
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
    chart.desc = rows.iter().map(|(contrast, d)| told(contrast, d)).collect::<Vec<_>>().join("; ");
    chart.add_legend(vec![
        Key::new("better", Tone::plain(), None, Some(BETTER), true).of(BETTER),
        Key::new("worse", Tone::wrong(), None, Some(WORSE), true).of(WORSE),
        Key::new("not separable", Tone::ink(), None, Some(OPEN), false).of(OPEN),
    ]);
    Some(chart)
}

fn draw(chart: &mut Chart, x: Scale, y: f64, contrast: &Contrast, difference: &Difference) {
    let [low, high] = difference.interval;
    let (tone, shape) = match difference.verdict {
        Verdict::Better => (Tone::plain(), BETTER),
        Verdict::Worse => (Tone::wrong(), WORSE),
        Verdict::NotSeparable => (Tone::ink(), OPEN),
    };
    let full = title(contrast);
    let text = wording::fitted(&full, 11.0, chart.plot.w);
    chart.notes.push(Note { x: chart.plot.x, y: y - 9.0, text, full });
    chart.lines.push(Line {
        d: format!("M{} {y}H{}", x.px(low), x.px(high)),
        tone: tone.clone(),
        dash: "",
        width: 1.6,
        title: told(contrast, difference),
        series: Some(shape),
        data: vec![
            ("of", wording::shown(&contrast.of)),
            ("over", wording::shown(&contrast.over)),
            ("low", low.to_string()),
            ("high", high.to_string()),
        ],
    });
    chart.marks.push(Mark {
        d: mark_path(shape, x.px(difference.difference), rounded(y), 4.2),
        tone,
        filled: difference.verdict != Verdict::NotSeparable,
        title: told(contrast, difference),
        series: Some(shape),
        data: vec![("difference", difference.difference.to_string())],
    });
}

fn scaled(difference: &Difference, unit: f64) -> Difference {
    let [low, high] = difference.interval;
    let (of, over) = (difference.of * unit, difference.over * unit);
    Difference {
        of,
        over,
        difference: difference.difference * unit,
        interval: [low * unit, high * unit],
        verdict: difference.verdict,
    }
}

/// `children over 10:00`, and the setting where there are several.
fn title(contrast: &Contrast) -> String {
    let (of, over) = (wording::shown(&contrast.of), wording::shown(&contrast.over));
    match contrast.setting.as_str() {
        "" => format!("{of} over {over}"),
        setting => format!("{of} over {over} [{}]", wording::shown(setting)),
    }
}

/// Whether the same two contenders are also compared over several passes.
fn pooled(contrast: &Contrast, contrasts: &[Contrast]) -> bool {
    let what = |contrast: &Contrast| [&contrast.of, &contrast.over, &contrast.setting].map(String::clone);
    contrasts.iter().any(|other| other.live.len() > 1 && what(other) == what(contrast))
}

/// The live pass as people name it; the pass' id beside its slot where passes are pooled, since two may be of one slot.
pub(crate) fn live(contrast: &Contrast, contrasts: &[Contrast]) -> String {
    match contrast.live.as_slice() {
        [pass] if pooled(contrast, contrasts) => format!("{} ({})", pass.slot, pass.traversal.short()),
        [pass] => pass.slot.to_string(),
        passes => format!("{} passes pooled", passes.len()),
    }
}

fn told(contrast: &Contrast, difference: &Difference) -> String {
    let number = |value: f64| signed(value, 2);
    let [low, high] = difference.interval.map(number);
    let (difference, verdict) = (number(difference.difference), difference.verdict);
    format!("{}: {difference} (95 % interval {low} to {high}), {verdict}", title(contrast))
}

/// A tick with its sign, as its neighbours on the axis are written.
fn tick(value: f64) -> String {
    let text = tick_text(value.abs());
    match value {
        value if value < 0.0 => format!("\u{2212}{text}"),
        value if value > 0.0 => format!("+{text}"),
        _ => text,
    }
}
