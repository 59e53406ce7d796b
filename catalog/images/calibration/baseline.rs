//! Whether the distance between two cameras can be, and what its unit seems to be where it cannot.

use super::error::CalibrationError;
use super::stereo::StereoCalibration;

/// Distances between the cameras of a rig, metres.
const POSSIBLE_M: std::ops::RangeInclusive<f64> = 0.01..=5.0;

/// Refuses a rig whose cameras are closer than 1 cm or farther apart than 5 m: P\[3\] then is in another unit than
/// pixel·metres, and every distance would be wrong.
///
/// # Errors
/// A baseline outside that range, with the units that P\[3\] may be in.
pub fn check_baseline(calibration: &StereoCalibration) -> Result<(), CalibrationError> {
    let (left, right) = (&calibration.left.projection, &calibration.right.projection);
    let across = left[3] - right[3];
    let baseline_m = across / left[0];
    // What is no length at all is refused by the rig's own check.
    if POSSIBLE_M.contains(&baseline_m) || !(baseline_m > 0.0 && left[0] > 0.0) {
        return Ok(());
    }
    let units = [
        (across, "the baseline itself in metres"),
        (across / 1000.0, "the baseline itself in millimetres"),
        (baseline_m / 1000.0, "-fx·B with B in millimetres"),
        (baseline_m / 100.0, "-fx·B with B in centimetres"),
        (baseline_m * 1000.0, "-fx·B divided by 1000"),
    ];
    let fitting = units.iter().filter(|(metres, _)| POSSIBLE_M.contains(metres));
    let seems: Vec<String> = fitting.map(|(metres, unit)| format!("{unit} ({} m)", rounded(*metres))).collect();
    let seems = if seems.is_empty() { "no unit that gives a rig".to_owned() } else { seems.join(", or ") };
    Err(CalibrationError::Baseline { baseline_m, p3: right[3], fx: left[0], seems })
}

/// Three digits that count.
fn rounded(metres: f64) -> String {
    let text = format!("{metres:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_model::{CameraCalibration, Distortion};

    fn said(p3: f64) -> String {
        let camera = |p3| CameraCalibration {
            width: 1226,
            height: 370,
            distortion: Distortion::RadialTangential,
            coefficients: Vec::new(),
            intrinsics: [707.0, 0.0, 601.0, 0.0, 707.0, 183.0, 0.0, 0.0, 1.0],
            rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            projection: [707.0, 0.0, 601.0, p3, 0.0, 707.0, 183.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        };
        let pair =
            StereoCalibration { left: camera(0.0), right: camera(p3), rectified_size: None, stream_is_rectified: true };
        check_baseline(&pair).map_or_else(|error| error.to_string(), |()| String::new())
    }

    #[test]
    fn the_unit_that_p3_seems_to_be_in_is_named() {
        for possible in [-7.1, -84.0, -379.8, -3534.0] {
            assert_eq!(said(possible), "", "{possible}");
        }
        assert!(said(-0.5372).contains("seems to be the baseline itself in metres (0.537 m)"));
        assert!(said(-0.3798).contains("-fx·B divided by 1000 (0.537 m)"));
        assert!(said(-379_814.5).contains("-fx·B with B in millimetres (0.537 m)"));
        assert!(said(-1e12).contains("no unit that gives a rig"));
        assert!(said(-1e-12).contains("no unit that gives a rig"));
    }
}
