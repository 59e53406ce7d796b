//! How large a rectified image should be.
//!
//! `CameraInfo` does not say. The rectified image keeps P's principal point, so it begins at (0, 0); what is free is
//! where it ends. Beyond the recorded image there is only black, whose edge would be a feature that travels with the
//! robot: so the image ends where nearly every pixel is still seen by both cameras.

use super::lens::Lens;
use crate::images::calibration::error::CalibrationError;
use furrow_model::CameraCalibration;

/// Visibility is sampled on every fourth row and column; the chosen size is a multiple of this, or the recorded size.
const CELL_PX: usize = 4;
/// A pixel outside costs as much as so many inside gain. The first is "nearly none outside"; the second serves
/// calibrations that keep the whole field of view between black corners (OpenCV's alpha = 1), where the first would
/// leave next to nothing.
const COSTS: [i64; 2] = [19, 1];

/// The size (columns, rows) of the rectified images: from (0, 0), never larger than either recorded image, chosen to
/// maximise seen minus 19 times unseen pixels. Where that keeps under half of what both cameras see, black corners are
/// accepted: seen minus unseen.
///
/// # Errors
/// Where under 5 % of the recorded image's extent is seen by both cameras.
pub fn choose(
    lenses: &[Lens; 2],
    left: &CameraCalibration,
    right: &CameraCalibration,
) -> Result<(u32, u32), CalibrationError> {
    let width = left.width.min(right.width);
    let height = left.height.min(right.height);
    let seen = Seen::sample(lenses, [left, right], width as usize, height as usize);
    let all = seen.inside(seen.columns, seen.rows);
    let cells = (seen.columns * seen.rows) as i64;
    if all * 20 < cells {
        return Err(CalibrationError::NoOverlap { percent_seen: all as f64 * 100.0 / cells as f64, width, height });
    }
    let sizes = COSTS.map(|cost| seen.best(cost));
    let [strict, lenient] = sizes;
    let (columns, rows) = if seen.inside(strict.0, strict.1) * 2 >= all { strict } else { lenient };
    Ok((width.min((columns * CELL_PX) as u32), height.min((rows * CELL_PX) as u32)))
}

/// Counts of seen cells in every rectangle from (0, 0).
struct Seen {
    columns: usize,
    rows: usize,
    /// `(rows + 1) * (columns + 1)` sums.
    sums: Vec<i64>,
}

impl Seen {
    fn sample(lenses: &[Lens; 2], cameras: [&CameraCalibration; 2], width: usize, height: usize) -> Self {
        let (columns, rows) = (width.div_ceil(CELL_PX), height.div_ceil(CELL_PX));
        let mut sums = vec![0; (columns + 1) * (rows + 1)];
        for row in 0..rows {
            let v = (row * CELL_PX + CELL_PX - 1).min(height - 1) as f64;
            let mut in_row = 0;
            for column in 0..columns {
                let u = (column * CELL_PX + CELL_PX - 1).min(width - 1) as f64;
                in_row += i64::from(lenses.iter().zip(cameras).all(|(lens, camera)| sees(lens, camera, u, v)));
                sums[(row + 1) * (columns + 1) + column + 1] = sums[row * (columns + 1) + column + 1] + in_row;
            }
        }
        Self { columns, rows, sums }
    }

    fn inside(&self, columns: usize, rows: usize) -> i64 {
        self.sums[rows * (self.columns + 1) + columns]
    }

    /// The first of the rectangles with the largest gain.
    fn best(&self, cost: i64) -> (usize, usize) {
        let mut best = (i64::MIN, (1, 1));
        for rows in 1..=self.rows {
            for columns in 1..=self.columns {
                let inside = self.inside(columns, rows);
                let gain = inside - cost * ((columns * rows) as i64 - inside);
                if gain > best.0 {
                    best = (gain, (columns, rows));
                }
            }
        }
        best.1
    }
}

/// Whether a camera sees what the rectified pixel (u, v) shows.
pub(crate) fn sees(lens: &Lens, camera: &CameraCalibration, u: f64, v: f64) -> bool {
    lens.source_of(u, v).is_some_and(|[x, y]| {
        (0.0..=f64::from(camera.width - 1)).contains(&x) && (0.0..=f64::from(camera.height - 1)).contains(&y)
    })
}
