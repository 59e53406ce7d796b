//! Whether a camera's calibration stays the same through a recording.

use super::camera_infos::RecordedInfo;
use furrow_model::CameraCalibration;

/// Focal lengths and principal points that move by less than this share of the focal length are the same: a quarter of
/// a pixel on a usual camera.
const SAME_SHARE: f64 = 5e-4;
/// Rotations and coefficients that differ by less than this are the same.
const SAME: f64 = 1e-3;

/// The first calibrated CameraInfo of one topic.
#[derive(Default)]
pub(super) struct InfoWatch {
    first: Option<RecordedInfo>,
}

impl InfoWatch {
    /// Looks at the next message's. The cameras of drivers that send zeros first, or between, are not calibrated: those
    /// are passed over.
    ///
    /// # Errors
    /// What it tells now, and what it told first.
    pub(super) fn look(&mut self, info: RecordedInfo) -> Result<(), String> {
        if !info.is_calibrated() {
            return Ok(());
        }
        let Some(first) = &self.first else {
            self.first = Some(info);
            return Ok(());
        };
        if is_same(first, &info) { Ok(()) } else { Err(format!("{}, before {}", told(&info), told(first))) }
    }
}

fn told(info: &RecordedInfo) -> String {
    let CameraCalibration { width, height, projection: p, .. } = &info.sensor;
    format!("{width} x {height} with fx {:.2}, cx {:.2}, P[3] {:.3}", p[0], p[2], p[3])
}

fn is_same(a: &RecordedInfo, b: &RecordedInfo) -> bool {
    let (l, r) = (&a.sensor, &b.sensor);
    if a.part != b.part || (l.width, l.height) != (r.width, r.height) || l.distortion != r.distortion {
        return false;
    }
    let close = |x: &[f64], y: &[f64], within: f64| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= within);
    let within = SAME_SHARE * l.projection[0].abs();
    let bends = |camera: &CameraCalibration| {
        let mut all = camera.coefficients.clone();
        all.resize(14, 0.0);
        all
    };
    close(&l.intrinsics, &r.intrinsics, within)
        && close(&l.projection[..3], &r.projection[..3], within)
        && close(&l.projection[4..], &r.projection[4..], within)
        && (l.projection[3] - r.projection[3]).abs() <= SAME * l.projection[3].abs().max(within)
        && close(&l.rectification, &r.rectification, SAME)
        && close(&bends(l), &bends(r), SAME)
}
