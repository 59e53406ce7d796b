//! Precision against recall over all thresholds: a panel per live traversal, a line per experience.

use super::arrange::{Column, Row, Setting};
use super::data::Data;
use super::figure::Figure;
use super::style::Style;
use crate::chart::elements::Mark;
use crate::chart::palette::Tones;
use crate::chart::scale::Scale;
use crate::chart::shape::{mark_path, polyline, simplified};
use crate::chart::text::spaced;
use crate::chart::{Chart, WIDTH, number_ticks};
use crate::wording;
use furrow_model::metric::RIGHT;
use furrow_model::{GroundTruthScore, Outcome};

/// None where nothing is judged.
pub(super) fn figure(setting: &Setting<'_>, name: &str, tones: &Tones) -> Option<Figure> {
    let panel = |(i, row): (usize, &Row<'_>)| chart(setting, row, format!("{name}-precision{i}"), tones);
    setting.truths().map(|truths| Figure {
        id: format!("{name}-precision-figure"),
        title: "Precision and recall at other thresholds".to_owned(),
        caption: format!(
            "Precision against recall as the threshold falls from the highest number of inliers to zero: each frame's \
             verified candidate with most inliers, judged by {truths}; {RIGHT}. Recall is relative to the frames \
             that have a mapped place. The mark is the threshold in use; AP is the area under the curve. Counts of these \
             traversals, without uncertainty."
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
            let rest = vec![point.inliers.into(), point.recall.into(), point.precision.into()];
            data.push_cell((row, column, cell), rest);
        }
    }
    data
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, tones: &Tones) -> Chart {
    let mut chart = Chart::new(id, format!("Live {}: precision and recall", row.label), &["100"], WIDTH, 210.0);
    let (x, y) = (chart.x_scale(1.0), chart.y_scale(1.0));
    let quarters = || (0..5).map(|i| f64::from(i) / 4.0);
    (chart.x_ticks, chart.y_ticks) = (number_ticks(x, quarters()), number_ticks(y, quarters()));
    (chart.x_label, chart.y_label) = ("recall".to_owned(), "precision".to_owned());
    let (mut texts, mut keys) = (Vec::new(), Vec::new());
    for (index, (column, cell)) in setting.columns.iter().zip(&row.cells).enumerate() {
        let judged = cell.and_then(|cell| Some((&cell.outcome, cell.outcome.evaluation.ground_truth.as_ref()?)));
        let Some((outcome, truth)) = judged else { continue };
        let style = Style::of(column, index, setting, tones);
        let text = format!("{}: AP {}", column.label, wording::percent(truth.average_precision));
        let curve = &truth.precision_recall;
        let points: Vec<(f64, f64)> = curve.iter().map(|p| (x.px(p.recall), y.px(p.precision))).collect();
        let points = if setting.crowded { simplified(&points, 0.3) } else { points };
        let mut data = vec![("cell", outcome.key.short())];
        if !setting.crowded {
            data.push(("recall", spaced(curve.iter().map(|p| p.recall))));
            data.push(("inliers", spaced(curve.iter().map(|p| f64::from(p.inliers)))));
            data.push(("precision", spaced(curve.iter().map(|p| p.precision))));
        }
        chart.lines.push(style.line(column, polyline(points), &text, data));
        chart.marks.extend(mark(column, (outcome, truth), &style, (x, y)));
        keys.push(style.key(&text));
        texts.push(text);
    }
    chart.desc = if setting.crowded {
        "The table of cells has the numbers.".to_owned()
    } else {
        format!("{}.", texts.join("; "))
    };
    chart.add_legend(keys);
    chart
}

/// The threshold in use; none where no candidate reached it.
fn mark(
    column: &Column,
    (outcome, truth): (&Outcome, &GroundTruthScore),
    style: &Style,
    (x, y): (Scale, Scale),
) -> Option<Mark> {
    let threshold = outcome.threshold_inliers;
    let at = truth.precision_recall.iter().rev().find(|point| point.inliers >= threshold)?;
    let (precision, recall) = (wording::percent(at.precision), wording::percent(at.recall));
    Some(Mark {
        d: mark_path(style.mark, x.px(at.recall), y.px(at.precision), 4.2),
        tone: style.tone.clone(),
        filled: style.filled,
        title: format!("{}, {threshold} inliers: precision {precision}, recall {recall}", column.label),
        series: Some(style.series),
        data: vec![
            ("cell", outcome.key.short()),
            ("recall", at.recall.to_string()),
            ("precision", at.precision.to_string()),
        ],
    })
}
