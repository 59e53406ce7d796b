//! Good localisations over the slot of the experience, a line per live traversal (thesis Figs 7.23 and 7.24;
//! experiments X10, X11).

use super::arrange::{Column, Kind, Row, Setting};
use super::data::{Data, Value};
use super::figure::Figure;
use super::interval;
use crate::chart::elements::{Key, Line, Mark, Tick};
use crate::chart::palette::{Tone, Tones};
use crate::chart::scale::{Scale, rounded, tick_text, whole_ticks};
use crate::chart::shape::{DIAMOND, mark_path, polyline};
use crate::chart::{Chart, WIDTH};
use crate::wording;
use furrow_model::{Evaluation, Outcome, TimeSlot};

const SLANTED_ROOM: f64 = 30.0;

/// A place on the x axis.
#[derive(Clone, PartialEq)]
enum Category {
    Slot(TimeSlot),
    Collective(String),
}

impl Category {
    fn of(column: &Column) -> Self {
        match column.kind {
            Kind::Collective => Self::Collective(column.label.clone()),
            Kind::Recorded | Kind::Named => Self::Slot(column.slot),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Slot(slot) => slot.to_string(),
            Self::Collective(label) => label.clone(),
        }
    }
}

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Figure {
    Figure {
        id: format!("{name}-counts-figure"),
        title: "Good localisations by time of day".to_owned(),
        caption: format!(
            "Each line is one live traversal. Each mark counts the good localisations against one experience: live \
             frames whose returned place reached the threshold of {} inliers. Vertical bars are 95 % intervals \
             along this one road, which do not cover the variation between traversals; a traversal of less than 60 m \
             has none. Experiences are ordered by time of day, not spaced by it. Hollow marks are generated or \
             otherwise named experiences, at the slot that they stand for; diamonds are collectives.",
            setting.thresholds()
        ),
        panels: vec![chart(setting, name, tones)],
        more: Vec::new(),
        data: data(setting),
    }
}

fn data(setting: &Setting<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "slot", "good", "low", "high", "frames"]);
    for (row, column, cell) in setting.places() {
        let e = &cell.outcome.evaluation;
        let [low, high] = e.good_interval.map_or([Value::Missing, Value::Missing], |ends| ends.map(Value::from));
        let rest = vec![column.slot.to_string().into(), e.good.into(), low, high, e.frames.into()];
        data.push_cell((row, column, cell), rest);
    }
    data
}

fn chart(setting: &Setting<'_>, name: &str, tones: &Tones) -> Chart {
    let categories = categories(setting);
    let top = |evaluation: &Evaluation| evaluation.good_interval.map_or(evaluation.good, |ends| ends[1]);
    let most = setting.cells().map(|cell| top(&cell.outcome.evaluation)).max().unwrap_or(0);
    let ticks = whole_ticks(most, 5);
    let texts: Vec<String> = ticks.iter().map(|tick| tick_text(*tick)).collect();
    let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
    let width = WIDTH.max(80.0 + SLANTED_ROOM * categories.len() as f64);
    let title = "Good localisations by experience".to_owned();
    let mut chart = Chart::new(format!("{name}-counts"), title, &widest, width, 210.0);
    let y = chart.y_scale(ticks.last().copied().unwrap_or(1.0));
    let step = chart.plot.w / categories.len().max(1) as f64;
    let x: Vec<f64> = (0..categories.len()).map(|i| rounded(chart.plot.x + (i as f64 + 0.5) * step)).collect();
    let names: Vec<String> = categories.iter().map(Category::text).collect();
    chart.name_x_ticks(&x.iter().copied().zip(names.iter().map(String::as_str)).collect::<Vec<_>>());
    chart.y_ticks = ticks.iter().zip(texts).map(|(tick, text)| Tick::new(y.px(*tick), text)).collect();
    chart.y_label = "good localisations (frames)".to_owned();
    chart.x_label = "time slot of the experience".to_owned();
    if !setting.crowded {
        chart.desc = description(setting);
    }
    let at = |category: &Category| categories.iter().position(|other| other == category).map_or(0.0, |i| x[i]);
    for (i, row) in setting.rows.iter().enumerate() {
        draw_row(&mut chart, setting, (i, row), tones, &at, y);
    }
    chart.add_legend(legend(setting, tones));
    chart
}

fn categories(setting: &Setting<'_>) -> Vec<Category> {
    let mut found = Vec::new();
    for category in setting.columns.iter().map(Category::of) {
        if !found.contains(&category) {
            found.push(category);
        }
    }
    found
}

fn draw_row(
    chart: &mut Chart,
    setting: &Setting<'_>,
    (index, row): (usize, &Row<'_>),
    tones: &Tones,
    at: &dyn Fn(&Category) -> f64,
    y: Scale,
) {
    let tone = tones.of(row.slot);
    // Recorded experiences are joined by a line, broken where a cell is missing.
    let mut joined: Vec<Vec<(String, (f64, f64))>> = vec![Vec::new()];
    for (column, cell) in setting.columns.iter().zip(&row.cells) {
        let Some(cell) = cell else {
            if column.kind == Kind::Recorded {
                joined.push(Vec::new());
            }
            continue;
        };
        let (key, good) = (cell.outcome.key.short(), cell.outcome.evaluation.good);
        let (px, py) = (at(&Category::of(column)), y.px(f64::from(good)));
        if column.kind == Kind::Recorded
            && let Some(points) = joined.last_mut()
        {
            points.push((key.clone(), (px, py)));
        }
        let bounds = cell.outcome.evaluation.good_interval.map(|ends| ends.map(f64::from));
        let title = cell_text(&row.label, &cell.outcome);
        let bar = |bounds| interval::upright((px, y), bounds, &tone, &title, (index, key.clone()));
        chart.lines.extend(bounds.map(bar));
        let (mark, size) = match column.kind {
            Kind::Collective => (DIAMOND, 5.0),
            Kind::Recorded | Kind::Named => (tones.mark(row.slot), 4.2),
        };
        chart.marks.push(Mark {
            d: mark_path(mark, px, py, size),
            tone: tone.clone(),
            filled: column.kind != Kind::Named,
            title,
            series: Some(index),
            data: vec![("cell", key), ("good", good.to_string())],
        });
    }
    for points in joined.into_iter().filter(|points| points.len() > 1) {
        let (cells, points): (Vec<String>, Vec<(f64, f64)>) = points.into_iter().unzip();
        chart.lines.push(Line {
            d: polyline(points),
            tone: tone.clone(),
            dash: "",
            width: 2.0,
            title: format!("live {}", row.label),
            series: Some(index),
            data: vec![("cells", cells.join(" "))],
        });
    }
}

fn cell_text(live: &str, outcome: &Outcome) -> String {
    let (good, frames) = (outcome.evaluation.good, outcome.evaluation.frames);
    let name = wording::shown(&outcome.experience);
    let interval = outcome.evaluation.good_interval;
    let interval = interval.map_or(String::new(), |[low, high]| format!(" (95 % interval {low} to {high})"));
    format!("live {live} against {name}: {good} good of {frames} frames{interval}")
}

fn description(setting: &Setting<'_>) -> String {
    let row = |row: &Row<'_>| {
        let cells: Vec<String> = row.cells.iter().flatten().map(|cell| cell_text(&row.label, &cell.outcome)).collect();
        cells.join("; ")
    };
    setting.rows.iter().map(row).collect::<Vec<_>>().join(". ")
}

fn legend(setting: &Setting<'_>, tones: &Tones) -> Vec<Key> {
    let live = |(index, row): (usize, &Row<'_>)| {
        let text = format!("live {}", row.label);
        Key::new(&text, tones.of(row.slot), Some(""), Some(tones.mark(row.slot)), true).switching(index)
    };
    let mut keys: Vec<Key> = setting.rows.iter().enumerate().map(live).collect();
    let has = |kind: Kind| setting.columns.iter().any(|column| column.kind == kind);
    if has(Kind::Named) {
        keys.push(Key::new("generated, at its slot", Tone::ink(), None, Some(0), false));
    }
    if has(Kind::Collective) {
        keys.push(Key::new("collective", Tone::ink(), None, Some(DIAMOND), true));
    }
    keys
}
