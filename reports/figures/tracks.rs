//! Trajectories by odometry, beside the ground truth.

use super::data::Data;
use super::figure::Figure;
use crate::chart::elements::{Key, Line};
use crate::chart::palette::Tone;
use crate::chart::scale::{rounded, tick_text, ticks};
use crate::chart::shape::polyline;
use crate::chart::{Chart, WIDTH, number_ticks};
use crate::input::TrackInput;
use crate::wording::{self, listed};
use std::collections::BTreeSet;

/// Series of the legend.
const TRUTH: usize = 0;
const ODOMETRY: usize = 1;
const DASH: &str = "6 4";
/// A plot's height at most and at least, in units.
const HIGH: f64 = 380.0;
const LOW: f64 = 60.0;

/// None where no traversal has a ground truth.
pub(super) fn figure(tracks: &[TrackInput]) -> Option<Figure> {
    if tracks.is_empty() {
        return None;
    }
    let mut data = Data::new(&["pass", "frame", "true_east_m", "true_north_m", "odometry_east_m", "odometry_north_m"]);
    for track in tracks {
        for (i, (truth, odometry)) in (0_u32..).zip(track.truth_m.iter().zip(&track.odometry_m)) {
            let name = wording::shown(&track.name);
            data.push(vec![
                name.into(),
                i.into(),
                truth[0].into(),
                truth[1].into(),
                odometry[0].into(),
                odometry[1].into(),
            ]);
        }
    }
    let sources: BTreeSet<String> = tracks.iter().map(|track| wording::shown(&track.source)).collect();
    Some(Figure {
        id: "tracks-figure".to_owned(),
        title: "Trajectories by odometry and ground truth".to_owned(),
        caption: format!(
            "One panel per live traversal, seen from above, both axes to the same scale. The odometry chain is aligned \
             with the ground truth ({}) by the rotation and translation of least squares; the error is the root mean \
             square of the horizontal distances that remain. Single traversals, without uncertainty.",
            listed(sources)
        ),
        panels: tracks.iter().enumerate().map(|(i, track)| panel(i, track)).collect(),
        more: Vec::new(),
        data,
    })
}

fn panel(index: usize, track: &TrackInput) -> Chart {
    let points = || track.truth_m.iter().chain(&track.odometry_m);
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| points().map(|p| p[axis]).reduce(pick).unwrap_or(0.0);
    let (west, south) = (bound(0, f64::min), bound(1, f64::min));
    let (wide_m, high_m) = ((bound(0, f64::max) - west).max(1.0), (bound(1, f64::max) - south).max(1.0));
    let (id, title) = (format!("tracks-{index}"), wording::shown(&track.name));
    let widest = [tick_text(high_m.ceil())];
    let empty = |height| Chart::new(id.clone(), title.clone(), &[widest[0].as_str()], WIDTH, height);
    let room = empty(0.0).plot.w;
    let m_per_unit = (wide_m / room).max(high_m / HIGH);
    let mut chart = empty(rounded((high_m / m_per_unit).max(LOW)));
    let (x, y) = (chart.x_scale(room * m_per_unit), chart.y_scale(chart.plot.h * m_per_unit));
    let along = |to: f64, count: usize| ticks(to, count).into_iter().filter(move |tick| *tick <= to);
    chart.x_ticks = number_ticks(x, along(x.to, 6));
    chart.y_ticks = number_ticks(y, along(y.to, if chart.plot.h > 150.0 { 5 } else { 2 }));
    chart.grid = (true, true);
    (chart.x_label, chart.y_label) = ("east of the westernmost point (m)".to_owned(), "north (m)".to_owned());
    chart.desc = format!(
        "{:.1} m by odometry; after alignment its positions are {:.2} m (root mean square) from the true ones.",
        track.length_m, track.rms_m
    );
    let line = |points: &[[f64; 2]], tone: Tone, dash, name: &str, series| Line {
        d: polyline(points.iter().map(|p| (x.px(p[0] - west), y.px(p[1] - south)))),
        tone,
        dash,
        width: 2.0,
        title: format!("{name}: {}", chart.desc),
        series: Some(series),
        data: Vec::new(),
    };
    let lines = vec![
        line(&track.truth_m, Tone::ink(), DASH, "ground truth", TRUTH),
        line(&track.odometry_m, Tone::plain(), "", "odometry", ODOMETRY),
    ];
    chart.lines = lines;
    let odometry = format!("odometry, RMS error {:.2} m over {:.0} m", track.rms_m, track.length_m);
    chart.add_legend(vec![
        Key::new("ground truth", Tone::ink(), Some(DASH), None, true).switching(TRUTH),
        Key::new(&odometry, Tone::plain(), Some(""), None, true).switching(ODOMETRY),
    ]);
    chart
}
