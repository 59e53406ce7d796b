//! Where along the route the live traversal was localised: a lane per experience (thesis Figs 7.18 to 7.28; experiments
//! X8, X9, X13).

use super::arrange::{Column, Row, Setting};
use super::data::Data;
use super::events::{EventRow, Events};
use super::figure::Figure;
use crate::chart::elements::{Key, Line, Mark};
use crate::chart::palette::{Tone, Tones};
use crate::chart::scale::{Scale, tick_text, ticks};
use crate::chart::shape::{CROSS, mark_path};
use crate::chart::{Chart, WIDTH, number_ticks};
use crate::error::ReportError;
use crate::input::CellInput;

const LANE: f64 = 24.0;
/// Dots nearer than this cover each other, in units.
const TOUCHING: f64 = 3.0;
/// Series of the legend.
const RIGHT: usize = 0;
const WRONG: usize = 1;

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Result<Figure, ReportError> {
    let panel = |(i, row): (usize, &Row<'_>)| chart(setting, row, format!("{name}-route{i}"), tones);
    let panels = setting.rows.iter().enumerate().map(panel).collect::<Result<Vec<_>, _>>()?;
    let judged = match setting.truths() {
        None => "No ground truth says which of them are right.".to_owned(),
        Some(truths) => format!("Crosses are accepted but wrong, according to {truths}."),
    };
    Ok(Figure {
        id: format!("{name}-route-figure"),
        title: "Localisations along the route".to_owned(),
        caption: format!(
            "One panel per live traversal, one lane per experience, from the tables of events. Each dot is an accepted \
             localisation, at the live traversal's position; the grey line runs from the first live frame to the last. \
             {judged} Positions are as accurate as their source: {}.",
            setting.distance_sources()
        ),
        panels,
        more: Vec::new(),
        data: data(setting)?,
    })
}

fn data(setting: &Setting<'_>) -> Result<Data, ReportError> {
    let mut data = Data::new(&["cell", "live", "experience", "travelled_m", "inliers", "right", "error_m"]);
    for (row, column, cell) in setting.places() {
        for point in Events::of(cell)?.accepted() {
            let right = point.correct.map(|right| if right { "yes" } else { "no" }).into();
            let rest = vec![point.travelled_m.into(), point.inliers.into(), right, point.error_m.into()];
            data.push_cell((row, column, cell), rest);
        }
    }
    Ok(data)
}

/// One experience's lane.
struct Lane<'a> {
    column: &'a Column,
    cell: &'a CellInput,
    events: Events,
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, tones: &Tones) -> Result<Chart, ReportError> {
    let mut lanes = Vec::new();
    for (column, cell) in setting.columns.iter().zip(&row.cells) {
        let Some(cell) = cell else { continue };
        lanes.push(Lane { column, cell, events: Events::of(cell)? });
    }
    let labels: Vec<&str> = lanes.iter().map(|lane| lane.column.label.as_str()).collect();
    let title = format!("Live {}: accepted localisations", row.label);
    let mut chart = Chart::new(id, title, &labels, WIDTH, LANE * lanes.len() as f64);
    chart.grid = (false, true);
    let ends = lanes.iter().filter_map(|lane| lane.events.travelled_range_m()).map(|(_, to)| to);
    let routes = lanes.iter().map(|lane| lane.cell.outcome.evaluation.lost.route_m);
    let x_ticks = ticks(routes.chain(ends).fold(0.0, f64::max), 6);
    let x = chart.x_scale(x_ticks.last().copied().unwrap_or(1.0));
    chart.x_ticks = number_ticks(x, x_ticks);
    chart.x_label = "distance travelled by the live traversal (m)".to_owned();
    chart.y_label = "experience (rows)".to_owned();
    let middle = |i: usize, chart: &Chart| chart.plot.y + (i as f64 + 0.5) * LANE;
    let (mut texts, mut any_wrong) = (Vec::new(), false);
    for (i, lane) in lanes.iter().enumerate() {
        let y = middle(i, &chart);
        let (text, wrong) = draw_lane(&mut chart, lane, (x, y), tones, setting.crowded);
        any_wrong |= wrong > 0;
        texts.push(if wrong == 0 { text } else { format!("{text}, {wrong} of them wrong") });
    }
    let names: Vec<(f64, &str)> = labels.iter().enumerate().map(|(i, label)| (middle(i, &chart), *label)).collect();
    chart.name_y_ticks(&names);
    chart.desc = if setting.crowded {
        "The table of cells has the numbers.".to_owned()
    } else {
        format!("{}.", texts.join("; "))
    };
    let mut keys = vec![Key::new("accepted", Tone::ink(), None, Some(0), true).switching(RIGHT)];
    if any_wrong {
        keys.push(Key::new("accepted but wrong", Tone::wrong(), None, Some(CROSS), false).switching(WRONG));
    }
    chart.add_legend(keys);
    Ok(chart)
}

/// Draws the rail, the dots and the crosses of a lane. Returns its text, and how many localisations are wrong.
fn draw_lane(
    chart: &mut Chart,
    lane: &Lane<'_>,
    (x, y): (Scale, f64),
    tones: &Tones,
    crowded: bool,
) -> (String, usize) {
    let (column, e, key) = (lane.column, &lane.cell.outcome.evaluation, lane.cell.outcome.key.short());
    let text = format!("{}: {} of {} frames accepted", column.label, e.good, e.frames);
    let (wrong, others): (Vec<EventRow<'_>>, Vec<EventRow<'_>>) =
        lane.events.accepted().partition(|point| point.correct == Some(false));
    let line = |d: String, tone: Tone, width: f64, series: Option<usize>, data: Vec<(&'static str, String)>| Line {
        d,
        tone,
        dash: "",
        width,
        title: text.clone(),
        series,
        data,
    };
    if let Some((from, to)) = lane.events.travelled_range_m() {
        let rail = format!("M{} {y}H{}", x.px(from), x.px(to));
        chart.lines.push(line(rail, Tone::rail(), 2.0, None, vec![("cell", key.clone())]));
    }
    let tone = if column.collective { Tone::ink() } else { tones.of(column.slot) };
    let mut data = vec![("cell", key.clone())];
    if !crowded {
        data.push(("m", metres(&others)));
    }
    let d = if crowded { strokes(&others, x, y) } else { dots(&others, x, y) };
    chart.lines.push(line(d, tone, 5.5, Some(RIGHT), data));
    chart.marks.extend(wrong.iter().map(|point| cross(point, (&column.label, &key), x.px(point.travelled_m), y)));
    (text, wrong.len())
}

/// Dots as strokes of no length with round ends: one path for a lane.
fn dots(points: &[EventRow<'_>], x: Scale, y: f64) -> String {
    points.iter().map(|point| format!("M{} {y}h0", x.px(point.travelled_m))).collect()
}

/// The same, where dots that cover each other are one stroke.
fn strokes(points: &[EventRow<'_>], x: Scale, y: f64) -> String {
    let mut strokes: Vec<[f64; 2]> = Vec::new();
    for px in points.iter().map(|point| x.px(point.travelled_m)) {
        match strokes.last_mut() {
            Some(stroke) if px - stroke[1] < TOUCHING => stroke[1] = px,
            _ => strokes.push([px, px]),
        }
    }
    strokes.iter().map(|[from, to]| format!("M{from} {y}H{to}")).collect()
}

fn metres(points: &[EventRow<'_>]) -> String {
    points.iter().map(|point| tick_text(point.travelled_m)).collect::<Vec<_>>().join(" ")
}

fn cross(point: &EventRow<'_>, (label, cell): (&str, &str), x: f64, y: f64) -> Mark {
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
