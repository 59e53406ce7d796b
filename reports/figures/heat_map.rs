//! Counts of good localisations, live traversal by experience (experiment X10 in full).

use super::arrange::{Kind, Setting};
use super::data::Data;
use super::figure::Figure;
use crate::chart::elements::Patch;
use crate::chart::palette::Tone;
use crate::chart::scale::rounded;
use crate::chart::{Chart, WIDTH};
use crate::wording;

const ROW: f64 = 34.0;
const NARROWEST: f64 = 36.0;

pub(super) fn figure(setting: &Setting<'_>, name: &str) -> Figure {
    let labels: Vec<&str> = setting.rows.iter().map(|row| row.label.as_str()).collect();
    let width = WIDTH.max(90.0 + NARROWEST * setting.columns.len() as f64);
    let mut chart = Chart::new(
        format!("{name}-heat"),
        "Live traversal by experience".to_owned(),
        &labels,
        width,
        ROW * labels.len() as f64,
    );
    chart.grid = (false, false);
    chart.y_label = "live traversal (rows), good localisations in each cell".to_owned();
    chart.x_label = "experience".to_owned();
    let step = chart.plot.w / setting.columns.len().max(1) as f64;
    let left = |i: usize| rounded(chart.plot.x + i as f64 * step);
    let names: Vec<(f64, &str)> = setting
        .columns
        .iter()
        .enumerate()
        .map(|(i, column)| (rounded(left(i) + step / 2.0), column.label.as_str()))
        .collect();
    let rows: Vec<(f64, &str)> =
        labels.iter().enumerate().map(|(i, label)| (chart.plot.y + (i as f64 + 0.5) * ROW, *label)).collect();
    let most = setting.cells().map(|cell| cell.outcome.evaluation.good).max().unwrap_or(0).max(1);
    let mut patches = Vec::new();
    for (i, row) in setting.rows.iter().enumerate() {
        for (j, (column, cell)) in setting.columns.iter().zip(&row.cells).enumerate() {
            let good = cell.map(|cell| cell.outcome.evaluation.good);
            let patch = Patch {
                x: left(j) + 1.0,
                y: chart.plot.y + i as f64 * ROW + 1.0,
                w: rounded(step - 2.0),
                h: ROW - 2.0,
                tone: Tone::plain(),
                opacity: good.map_or(0.0, |good| rounded(0.07 + 0.93 * f64::from(good) / f64::from(most))),
                hollow: false,
                text: good.map_or_else(|| "·".to_owned(), |good| good.to_string()),
                title: match cell {
                    Some(cell) => format!(
                        "live {} against {}: {} good of {} frames",
                        row.label, column.label, cell.outcome.evaluation.good, cell.outcome.evaluation.frames
                    ),
                    None => format!("live {} against {}: no outcome", row.label, column.label),
                },
                series: None,
                data: cell
                    .map(|cell| ("cell", cell.outcome.key.short()))
                    .into_iter()
                    .chain(good.map(|good| ("good", good.to_string())))
                    .collect(),
            };
            if column.kind == Kind::Recorded && column.slot == row.slot {
                let frame =
                    Patch { hollow: true, tone: Tone::ink(), text: String::new(), data: Vec::new(), ..patch.clone() };
                patches.push(patch);
                patches.push(frame);
            } else {
                patches.push(patch);
            }
        }
    }
    chart.name_x_ticks(&names);
    chart.name_y_ticks(&rows);
    let texts: Vec<&str> = patches.iter().filter(|patch| !patch.hollow).map(|patch| patch.title.as_str()).collect();
    if !setting.crowded {
        chart.desc = wording::shown(&texts.join("; "));
    }
    chart.patches = patches;
    Figure {
        id: format!("{name}-heat-figure"),
        title: "Every live traversal against every experience".to_owned(),
        caption: format!(
            "The number of good localisations in each cell (at least {} inliers); a stronger colour means more. A \
             frame marks the experience recorded at the live traversal's own slot; a dot marks a cell without an \
             outcome. The same counts as in the previous figure, exact for these traversals.",
            setting.thresholds()
        ),
        panels: vec![chart],
        more: Vec::new(),
        data: data(setting),
    }
}

fn data(setting: &Setting<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "good", "frames"]);
    for (row, column, cell) in setting.places() {
        let e = &cell.outcome.evaluation;
        data.push_cell((row, column, cell), vec![e.good.into(), e.frames.into()]);
    }
    data
}
