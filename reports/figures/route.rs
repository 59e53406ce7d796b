//! Where along the route the live pass knew its place: a lane per experience (thesis Figs 7.18 to 7.28; X8, X9, X13).

use super::{Figure, listed};
use crate::arrange::{Row, Setting};
use crate::chart::{Chart, Line, Mark, Tick, WIDTH};
use crate::data::Data;
use crate::events::{self, Accepted};
use crate::input::ReportError;
use crate::legend::Key;
use crate::palette::{Tone, Tones};
use crate::scale::{Scale, tick_text, ticks};
use crate::shape::{CROSS, mark_path};
use crate::wording;

const LANE: f64 = 24.0;
/// Dots nearer than this cover each other, in units.
const TOUCHING: f64 = 3.0;
/// Series of the legend.
const RIGHT: usize = 0;
const WRONG: usize = 1;

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Result<Figure, ReportError> {
    let panel = |(i, row): (usize, &Row<'_>)| chart(setting, row, format!("{name}-route{i}"), tones);
    let panels = setting.rows.iter().enumerate().map(panel).collect::<Result<Vec<_>, _>>()?;
    let truths =
        setting.distinct(|outcome| outcome.evaluation.ground_truth.as_ref().map(|truth| wording::shown(&truth.source)));
    let judged = match listed(truths.into_iter().flatten()) {
        none if none.is_empty() => "No ground truth says which of them are right.".to_owned(),
        sources => format!("Crosses are accepted but wrong, as judged by {sources}."),
    };
    let sources = setting.distinct(|outcome| wording::shown(&outcome.evaluation.distance_source));
    Ok(Figure {
        id: format!("{name}-route-figure"),
        title: "Points on the route".to_owned(),
        caption: format!(
            "A panel per live pass and a lane per experience, from the tables of events. Each dot is an accepted localisation, drawn where the \
             live pass was at the time; the rail runs from the first to the last frame offered. {judged} The horizontal position is as \
             uncertain as its source: {}.",
            listed(sources)
        ),
        panels,
        more: Vec::new(),
        data: data(setting)?,
    })
}

fn data(setting: &Setting<'_>) -> Result<Data, ReportError> {
    let mut data = Data::new(&["cell", "live", "experience", "travelled_m", "inliers", "right", "error_m"]);
    for (row, column, cell) in setting.places() {
        for point in events::accepted(cell)? {
            data.push(vec![
                cell.outcome.key.short().into(),
                row.label.clone().into(),
                column.label.clone().into(),
                point.travelled_m.into(),
                point.inliers.into(),
                point.correct.map(|right| if right { "yes" } else { "no" }).into(),
                point.error_m.into(),
            ]);
        }
    }
    Ok(data)
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, tones: &Tones) -> Result<Chart, ReportError> {
    let lanes: Vec<_> =
        setting.columns.iter().zip(&row.cells).filter_map(|(column, cell)| cell.map(|cell| (column, cell))).collect();
    let labels: Vec<&str> = lanes.iter().map(|(column, _)| column.label.as_str()).collect();
    let mut chart = Chart::new(
        id,
        format!("Live {}: where it knew its place", row.label),
        &labels,
        WIDTH,
        LANE * lanes.len() as f64,
    );
    chart.grid = (false, true);
    let mut end_m = lanes.iter().map(|(_, cell)| cell.outcome.evaluation.lost.route_m).fold(0.0, f64::max);
    let mut read = Vec::new();
    for (_, cell) in &lanes {
        let driven = events::driven_m(cell)?;
        end_m = driven.map_or(end_m, |(_, to)| end_m.max(to));
        read.push((driven, events::accepted(cell)?));
    }
    let x_ticks = ticks(end_m, 6);
    let x = chart.x_scale(x_ticks.last().copied().unwrap_or(1.0));
    chart.x_ticks = x_ticks
        .iter()
        .map(|tick| (x.px(*tick), tick_text(*tick)))
        .map(|(at, text)| Tick { at, full: text.clone(), text })
        .collect();
    chart.x_label = "distance travelled by the live pass (m)".to_owned();
    chart.y_label = "experience (down)".to_owned();
    let mut told = Vec::new();
    let mut any_wrong = false;
    for (i, ((column, cell), (driven, accepted))) in lanes.iter().zip(&read).enumerate() {
        let y = chart.plot.y + (i as f64 + 0.5) * LANE;
        let (wrong, others): (Vec<&Accepted>, Vec<&Accepted>) =
            accepted.iter().partition(|point| point.correct == Some(false));
        let text = format!(
            "{}: {} of {} frames accepted",
            column.label, cell.outcome.evaluation.good, cell.outcome.evaluation.frames
        );
        if let Some((from, to)) = driven {
            chart.lines.push(Line {
                d: format!("M{} {y}H{}", x.px(*from), x.px(*to)),
                tone: Tone { class: "rail".to_owned(), light: "#d3d8de".to_owned(), dark: String::new() },
                dash: "",
                width: 2.0,
                title: text.clone(),
                series: None,
                data: vec![("cell", cell.outcome.key.short())],
            });
        }
        let tone = if column.collective { Tone::ink() } else { tones.of(column.slot) };
        let mut data = vec![("cell", cell.outcome.key.short())];
        if !setting.crowded {
            data.push(("m", metres(&others)));
        }
        chart.lines.push(Line {
            d: if setting.crowded { runs(&others, x, y) } else { dots(&others, x, y) },
            tone,
            dash: "",
            width: 5.5,
            title: text.clone(),
            series: Some(RIGHT),
            data,
        });
        let key = cell.outcome.key.short();
        chart.marks.extend(wrong.iter().map(|point| cross(point, (&column.label, &key), x.px(point.travelled_m), y)));
        any_wrong |= !wrong.is_empty();
        told.push(if wrong.is_empty() { text } else { format!("{text}, {} of them wrong", wrong.len()) });
    }
    let names: Vec<(f64, &str)> =
        labels.iter().enumerate().map(|(i, label)| (chart.plot.y + (i as f64 + 0.5) * LANE, *label)).collect();
    chart.name_y_ticks(&names);
    chart.desc = if setting.crowded {
        "The table of cells has the numbers.".to_owned()
    } else {
        format!("{}.", told.join("; "))
    };
    let mut keys = vec![Key::new("accepted", Tone::ink(), None, Some(0), true).of(RIGHT)];
    if any_wrong {
        keys.push(Key::new("accepted but wrong", Tone::wrong(), None, Some(CROSS), false).of(WRONG));
    }
    chart.add_legend(keys);
    Ok(chart)
}

/// Dots as strokes of no length with round ends: one path for a lane.
fn dots(points: &[&Accepted], x: Scale, y: f64) -> String {
    points.iter().map(|point| format!("M{} {y}h0", x.px(point.travelled_m))).collect()
}

/// The same, where dots that cover each other are one stroke.
fn runs(points: &[&Accepted], x: Scale, y: f64) -> String {
    let mut runs: Vec<[f64; 2]> = Vec::new();
    for px in points.iter().map(|point| x.px(point.travelled_m)) {
        match runs.last_mut() {
            Some(run) if px - run[1] < TOUCHING => run[1] = px,
            _ => runs.push([px, px]),
        }
    }
    runs.iter().map(|[from, to]| format!("M{from} {y}H{to}")).collect()
}

fn metres(points: &[&Accepted]) -> String {
    points.iter().map(|point| tick_text(point.travelled_m)).collect::<Vec<_>>().join(" ")
}

fn cross(point: &Accepted, (label, cell): (&str, &str), x: f64, y: f64) -> Mark {
    let inliers = point.inliers.map(|inliers| format!(", {inliers} inliers")).unwrap_or_default();
    let off = point.error_m.map(|error| format!(", {error:.1} m off")).unwrap_or_default();
    Mark {
        d: mark_path(CROSS, x, y, 4.5),
        tone: Tone::wrong(),
        filled: false,
        title: format!("{label} at {:.1} m: accepted but wrong{off}{inliers}", point.travelled_m),
        series: Some(WRONG),
        data: vec![("cell", cell.to_owned()), ("m", tick_text(point.travelled_m)), ("wrong", "true".to_owned())],
    }
}
