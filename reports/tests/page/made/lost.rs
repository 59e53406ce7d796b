//! Lost stretches and their curves, by hand.

use super::frame::{Frame, STEP_M, accepted};
use furrow_model::{LostDistance, LostPoint, LostStretch};

/// Lost stretches by hand, from the frames' positions.
pub fn lost(frames: &[Frame]) -> LostDistance {
    let route_m = (frames.len().max(1) - 1) as f64 * STEP_M;
    let mut stretches_m = Vec::new();
    let mut since: Option<f64> = Some(0.0);
    let mut failed = false;
    for (i, frame) in frames.iter().enumerate() {
        let at = i as f64 * STEP_M;
        if accepted(frame) {
            if failed {
                stretches_m.push(at - since.unwrap());
            }
            (since, failed) = (Some(at), false);
        } else {
            failed = true;
        }
    }
    if failed {
        stretches_m.push(route_m - since.unwrap());
    }
    from_stretches(route_m, &stretches_m, &(0..=200).map(|i| f64::from(i) * 0.5).collect::<Vec<_>>())
}

/// The curves of given stretches, laid end to end; the bands are made up.
pub fn from_stretches(route_m: f64, stretches_m: &[f64], grid: &[f64]) -> LostDistance {
    let total: f64 = stretches_m.iter().sum();
    let band = |value: f64| Some([(value * 0.8 - 0.01).max(0.0), (value * 1.2 + 0.01).min(1.0)]);
    let point = |d: &f64| {
        let survival = stretches_m.iter().map(|g| (g - d).max(0.0)).sum::<f64>() / route_m;
        let longer: Vec<f64> = stretches_m.iter().copied().filter(|g| g > d).collect();
        let length_biased = longer.iter().sum::<f64>() / route_m;
        let per_gap = if stretches_m.is_empty() { 0.0 } else { longer.len() as f64 / stretches_m.len() as f64 };
        LostPoint {
            distance_m: *d,
            survival,
            survival_band: band(survival),
            length_biased,
            length_biased_band: band(length_biased),
            per_gap,
            per_gap_band: band(per_gap),
        }
    };
    let mut from_m = 0.0;
    let stretches = stretches_m.iter().map(|length_m| {
        let stretch = LostStretch { from_m, to_m: from_m + length_m, censored: false };
        from_m = stretch.to_m;
        stretch
    });
    LostDistance {
        route_m,
        stretches: stretches.collect(),
        lost_fraction: total / route_m,
        max_lost_m: stretches_m.iter().copied().fold(0.0, f64::max),
        mean_lost_m: if stretches_m.is_empty() { 0.0 } else { total / stretches_m.len() as f64 },
        area_m: stretches_m.iter().map(|g| g * g).sum::<f64>() / (2.0 * route_m),
        curve: grid.iter().map(point).collect(),
    }
}
