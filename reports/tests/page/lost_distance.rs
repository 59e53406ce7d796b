//! Lost-distance curves, read back through their own scales and data.

use crate::made::{self, cell, input, live_frames, member};
use crate::read::{attribute, between, keep, row_value};
use furrow_reports::page;

/// Thesis Fig 6.3 in numbers: d, then robots A and B in survival, length-biased and per gap.
const FIG_6_3: [[f64; 7]; 5] = [
    [0.0, 0.50, 0.50, 0.5, 0.5, 1.0, 1.0],
    [5.0, 0.25, 0.45, 0.5, 0.5, 1.0, 1.0],
    [10.0, 0.0, 0.40, 0.0, 0.5, 0.0, 1.0],
    [25.0, 0.0, 0.25, 0.0, 0.5, 0.0, 1.0],
    [50.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

#[test]
fn figure_6_3_is_drawn_as_in_the_thesis() {
    let mut cells: Vec<_> = ["10:00", "14:00"]
        .into_iter()
        .enumerate()
        .map(|(i, at)| cell(i, "08:00", at, vec![member(at, i)], &live_frames(0.0, 1, false)))
        .collect();
    for (robot, cell) in cells.iter_mut().enumerate() {
        let stretches: &[f64] = if robot == 0 { &[10.0; 5] } else { &[50.0] };
        let lost = &mut cell.outcome.evaluation.lost;
        *lost = made::from_stretches(100.0, stretches, &[]);
        lost.curve = FIG_6_3
            .iter()
            .map(|row| furrow_model::LostPoint {
                distance_m: row[0],
                survival: row[1 + robot],
                survival_band: Some([0.5 * row[1 + robot], row[1 + robot]]),
                length_biased: row[3 + robot],
                length_biased_band: Some([0.5 * row[3 + robot], row[3 + robot]]),
                per_gap: row[5 + robot],
                per_gap_band: Some([0.5 * row[5 + robot], row[5 + robot]]),
            })
            .collect();
    }
    let html = page(&input(cells.clone(), Vec::new())).unwrap();
    keep("figure_6_3.html", &html);
    for (robot, cell) in cells.iter().enumerate() {
        for (nth, variant) in ["survival", "length-biased", "per gap"].into_iter().enumerate() {
            let id = format!("data-cell=\"{}\" data-variant=\"{variant}\"", cell.outcome.key.short());
            let line = html.split(&id).nth(1).unwrap();
            let numbers = |name: &str| -> Vec<f64> {
                attribute(line, name).split(' ').map(|number| number.parse().unwrap()).collect()
            };
            // Robot A is never lost for more than 10 m: its lines end there, at zero.
            let rows = if robot == 0 { &FIG_6_3[..3] } else { &FIG_6_3[..] };
            let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
            assert_eq!(numbers("data-d"), column(0));
            assert_eq!(numbers("data-p"), column(1 + 2 * nth + robot), "{variant} of robot {robot}");
        }
        let drawn = drawn_points(&html, &cell.outcome.key.short());
        for (row, (d, p)) in FIG_6_3.iter().zip(drawn) {
            assert!((d - row[0]).abs() < 0.01 && (p - row[1 + robot]).abs() < 1e-4, "{row:?}: drawn at {d}, {p}");
        }
    }
    assert_eq!(row_value(&html, &cells[0].outcome, "max_lost_m"), "10");
    assert_eq!(row_value(&html, &cells[1].outcome, "max_lost_m"), "50");
    assert!(html.contains("keyframes every 2 m"));
}

/// The survival line's corners, read back through the chart's own ticks.
fn drawn_points(html: &str, cell: &str) -> Vec<(f64, f64)> {
    let chart = html
        .split("<svg ")
        .find(|svg| svg.contains(&format!("data-cell=\"{cell}\" data-variant=\"survival\"")))
        .unwrap();
    let line = chart.split("<path ").find(|path| path.contains(&format!("data-cell=\"{cell}\" data-variant"))).unwrap();
    let axis = |text: &str, anchor: &str| -> f64 {
        let tick = chart
            .split("<text ")
            .find(|t| t.contains(anchor) && t.split('>').nth(1).is_some_and(|t| t.starts_with(&format!("{text}<"))))
            .unwrap();
        let name = if anchor.contains("middle") { "x" } else { "y" };
        between(&format!(" {tick}"), &format!(" {name}=\""), "\"").parse().unwrap()
    };
    let (x0, x50) = (axis("0", "middle"), axis("50", "middle"));
    let (y0, y1) = (axis("0", "\"end\""), axis("1", "\"end\""));
    let d = between(line, " d=\"M", "\"");
    let point = |pair: &str| {
        let (x, y) = pair.split_once(' ').unwrap();
        // Tick texts stand 4 units below their tick; that cancels here.
        ((x.parse::<f64>().unwrap() - x0) / (x50 - x0) * 50.0, (y.parse::<f64>().unwrap() + 4.0 - y0) / (y1 - y0))
    };
    d.split('L').map(point).collect()
}
