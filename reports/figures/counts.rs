//! Good localisations over the slot of the experience, a line per live pass (thesis Figs 7.23 and 7.24; X10, X11).

use super::{Figure, thresholds};
use crate::arrange::{Kind, Row, Setting};
use crate::chart::{Chart, Line, Mark, Tick, WIDTH};
use crate::data::Data;
use crate::legend::Key;
use crate::palette::Tones;
use crate::scale::{Scale, rounded, tick_text, whole_ticks};
use crate::shape::{DIAMOND, mark_path, polyline};
use crate::wording;
use furrow_model::{Evaluation, Outcome, TimeSlot};

const SLANTED_ROOM: f64 = 30.0;

/// A place on the x axis.
#[derive(Clone, PartialEq)]
enum Category {
    Slot(TimeSlot),
    Collective(String),
}

pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Figure {
    let categories = categories(setting);
    let top = |evaluation: &Evaluation| evaluation.good.max(evaluation.good_interval[1]);
    let most = setting.cells().map(|cell| top(&cell.outcome.evaluation)).max().unwrap_or(0);
    let ticks = whole_ticks(most, 5);
    let texts: Vec<String> = ticks.iter().map(|tick| tick_text(*tick)).collect();
    let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
    let width = WIDTH.max(80.0 + SLANTED_ROOM * categories.len() as f64);
    let mut chart =
        Chart::new(format!("{name}-counts"), "Good localisations by experience".to_owned(), &widest, width, 210.0);
    let y = chart.y_scale(ticks.last().copied().unwrap_or(1.0));
    let step = chart.plot.w / categories.len().max(1) as f64;
    let x: Vec<f64> = (0..categories.len()).map(|i| rounded(chart.plot.x + (i as f64 + 0.5) * step)).collect();
    let names: Vec<String> = categories.iter().map(Category::text).collect();
    chart.name_x_ticks(&x.iter().copied().zip(names.iter().map(String::as_str)).collect::<Vec<_>>());
    chart.y_ticks = ticks
        .iter()
        .zip(&texts)
        .map(|(tick, text)| Tick { at: y.px(*tick), text: text.clone(), full: text.clone() })
        .collect();
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
    Figure {
        id: format!("{name}-counts-figure"),
        title: "Good localisations by time of day".to_owned(),
        caption: format!(
            "Each line is one live pass; each mark counts its good localisations against one experience: live frames whose returned place \
             reached the threshold of {} inliers. Counted from the outcomes of the cells; thin uprights are 95 % intervals of a circular moving-block \
             bootstrap along this one pass, which does not cover the difference between one drive and the next. Experiences are ordered by hour, not spaced by it. Hollow marks \
             are generated or otherwise named experiences, drawn at the slot that they stand for; diamonds are collectives.",
            thresholds(setting)
        ),
        panels: vec![chart],
        more: Vec::new(),
        data: data(setting),
    }
}

fn data(setting: &Setting<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "slot", "good", "low", "high", "frames"]);
    for (row, column, cell) in setting.places() {
        let e = &cell.outcome.evaluation;
        data.push(vec![
            cell.outcome.key.short().into(),
            row.label.clone().into(),
            column.label.clone().into(),
            column.slot.to_string().into(),
            e.good.into(),
            e.good_interval[0].into(),
            e.good_interval[1].into(),
            e.frames.into(),
        ]);
    }
    data
}

impl Category {
    fn text(&self) -> String {
        match self {
            Category::Slot(slot) => slot.to_string(),
            Category::Collective(label) => label.clone(),
        }
    }
}

fn categories(setting: &Setting<'_>) -> Vec<Category> {
    let mut found = Vec::new();
    for column in &setting.columns {
        let category = match column.kind {
            Kind::Collective => Category::Collective(column.label.clone()),
            _ => Category::Slot(column.slot),
        };
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
    let mut runs: Vec<Vec<(String, (f64, f64))>> = vec![Vec::new()];
    for (column, cell) in setting.columns.iter().zip(&row.cells) {
        let Some(cell) = cell else {
            if column.kind == Kind::Recorded {
                runs.push(Vec::new());
            }
            continue;
        };
        let good = cell.outcome.evaluation.good;
        let category = match column.kind {
            Kind::Collective => Category::Collective(column.label.clone()),
            _ => Category::Slot(column.slot),
        };
        let (px, py) = (at(&category), y.px(f64::from(good)));
        let mark = if column.kind == Kind::Collective { DIAMOND } else { tones.mark(row.slot) };
        if column.kind == Kind::Recorded
            && let Some(run) = runs.last_mut()
        {
            run.push((cell.outcome.key.short(), (px, py)));
        }
        let [low, high] = cell.outcome.evaluation.good_interval;
        chart.lines.push(Line {
            d: format!("M{px} {}V{}", rounded(y.px(f64::from(low))), rounded(y.px(f64::from(high)))),
            tone: tone.clone(),
            dash: "",
            width: 1.1,
            title: told(&row.label, &cell.outcome),
            series: Some(index),
            data: vec![("cell", cell.outcome.key.short()), ("low", low.to_string()), ("high", high.to_string())],
        });
        chart.marks.push(Mark {
            d: mark_path(mark, px, py, if column.kind == Kind::Collective { 5.0 } else { 4.2 }),
            tone: tone.clone(),
            filled: column.kind != Kind::Named,
            title: told(&row.label, &cell.outcome),
            series: Some(index),
            data: vec![("cell", cell.outcome.key.short()), ("good", good.to_string())],
        });
    }
    for run in runs.into_iter().filter(|run| run.len() > 1) {
        let title = format!("live {}", row.label);
        let (cells, points): (Vec<String>, Vec<(f64, f64)>) = run.into_iter().unzip();
        chart.lines.push(Line {
            d: polyline(points),
            tone: tone.clone(),
            dash: "",
            width: 2.0,
            title,
            series: Some(index),
            data: vec![("cells", cells.join(" "))],
        });
    }
}

fn told(live: &str, outcome: &Outcome) -> String {
    let (good, [low, high]) = (outcome.evaluation.good, outcome.evaluation.good_interval);
    let (name, frames) = (wording::shown(&outcome.experience), outcome.evaluation.frames);
    format!("live {live} against {name}: {good} good of {frames} frames (95 % interval {low} to {high})")
}

fn description(setting: &Setting<'_>) -> String {
    let row = |row: &Row<'_>| {
        let cells: Vec<String> = row.cells.iter().flatten().map(|cell| told(&row.label, &cell.outcome)).collect();
        cells.join("; ")
    };
    setting.rows.iter().map(row).collect::<Vec<_>>().join(". ")
}

fn legend(setting: &Setting<'_>, tones: &Tones) -> Vec<Key> {
    let live = |(index, row): (usize, &Row<'_>)| {
        let text = format!("live {}", row.label);
        Key::new(&text, tones.of(row.slot), Some(""), Some(tones.mark(row.slot)), true).of(index)
    };
    let mut keys: Vec<Key> = setting.rows.iter().enumerate().map(live).collect();
    let has = |kind: Kind| setting.columns.iter().any(|column| column.kind == kind);
    if has(Kind::Named) {
        keys.push(Key::new("generated, at its slot", crate::palette::Tone::ink(), None, Some(0), false));
    }
    if has(Kind::Collective) {
        keys.push(Key::new("collective", crate::palette::Tone::ink(), None, Some(DIAMOND), true));
    }
    keys
}
