//! Precision against recall over all thresholds (SPEC 4.2): a panel per live pass, a line per experience.

use super::style::Style;
use super::{Figure, listed};
use crate::arrange::{Row, Setting};
use crate::chart::{Chart, Mark, Tick, WIDTH};
use crate::data::Data;
use crate::palette::Tones;
use crate::scale::tick_text;
use crate::shape::{mark_path, polyline, simplified};
use crate::wording;
use furrow_model::{GroundTruthScore, PrecisionRecall};

/// None where nothing is judged.
pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Option<Figure> {
    let truths: Vec<String> = setting
        .distinct(|outcome| outcome.evaluation.ground_truth.as_ref().map(|truth| wording::shown(&truth.source)))
        .into_iter()
        .flatten()
        .collect();
    let panel = |(i, row): (usize, &Row<'_>)| chart(setting, row, format!("{name}-precision{i}"), tones);
    (!truths.is_empty()).then(|| Figure {
        id: format!("{name}-precision-figure"),
        title: "What another threshold would give".to_owned(),
        caption: format!(
            "Precision against recall as the threshold of inliers falls from the highest number that occurs to none: each frame's verified \
             candidate with most inliers, judged by {}. Recall counts frames that have a mapped place. The mark stands at the threshold in \
             use; AP is the area under the line. Counts of these passes, without uncertainty.",
            listed(truths)
        ),
        panels: setting.rows.iter().enumerate().map(panel).collect(),
        more: Vec::new(),
        data: data(setting),
    })
}

fn data(setting: &Setting<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "inliers", "recall", "precision"]);
    for (row, column, cell) in setting.places() {
        let curve = cell.outcome.evaluation.ground_truth.iter().flat_map(|truth| &truth.precision_recall);
        for point in curve {
            data.push(vec![
                cell.outcome.key.short().into(),
                row.label.clone().into(),
                column.label.clone().into(),
                point.inliers.into(),
                point.recall.into(),
                point.precision.into(),
            ]);
        }
    }
    data
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, tones: &Tones) -> Chart {
    let mut chart = Chart::new(id, format!("Live {}: precision and recall", row.label), &["100"], WIDTH, 210.0);
    let (x, y) = (chart.x_scale(1.0), chart.y_scale(1.0));
    let quarters = || (0..5).map(|i| f64::from(i) / 4.0);
    let tick = |at: f64, value: f64| Tick { at, full: tick_text(value), text: tick_text(value) };
    chart.x_ticks = quarters().map(|value| tick(x.px(value), value)).collect();
    chart.y_ticks = quarters().map(|value| tick(y.px(value), value)).collect();
    chart.x_label = "recall".to_owned();
    chart.y_label = "precision".to_owned();
    let (mut told, mut keys) = (Vec::new(), Vec::new());
    for (index, (column, cell)) in setting.columns.iter().zip(&row.cells).enumerate() {
        let judged = cell.and_then(|cell| Some((cell, cell.outcome.evaluation.ground_truth.as_ref()?)));
        let Some((cell, truth)) = judged else { continue };
        let style = Style::of(column, index, setting, tones);
        let text = format!("{}: AP {}", column.label, wording::percent(truth.average_precision));
        let points: Vec<(f64, f64)> =
            truth.precision_recall.iter().map(|p| (x.px(p.recall), y.px(p.precision))).collect();
        let points = if setting.crowded { simplified(&points, 0.3) } else { points };
        let mut data = vec![("cell", cell.outcome.key.short())];
        if !setting.crowded {
            data.push(("recall", list(truth, |p| p.recall)));
            data.push(("inliers", list(truth, |p| f64::from(p.inliers))));
            data.push(("precision", list(truth, |p| p.precision)));
        }
        chart.lines.push(style.line(column, polyline(points), &text, data));
        let threshold = cell.outcome.threshold_inliers;
        if let Some(at) = truth.precision_recall.iter().rev().find(|point| point.inliers >= threshold) {
            let (precision, recall) = (wording::percent(at.precision), wording::percent(at.recall));
            chart.marks.push(Mark {
                d: mark_path(style.mark, x.px(at.recall), y.px(at.precision), 4.2),
                tone: style.tone.clone(),
                filled: style.filled,
                title: format!("{}, {threshold} inliers: precision {precision}, recall {recall}", column.label),
                series: Some(style.series),
                data: vec![
                    ("cell", cell.outcome.key.short()),
                    ("recall", at.recall.to_string()),
                    ("precision", at.precision.to_string()),
                ],
            });
        }
        keys.push(style.key(&text));
        told.push(text);
    }
    chart.desc = if setting.crowded {
        "The table of cells has the numbers.".to_owned()
    } else {
        format!("{}.", told.join("; "))
    };
    chart.add_legend(keys);
    chart
}

fn list(truth: &GroundTruthScore, value: fn(&PrecisionRecall) -> f64) -> String {
    truth.precision_recall.iter().map(|point| value(point).to_string()).collect::<Vec<_>>().join(" ")
}
