//! KITTI's calibration texts: `calib_cam_to_cam.txt` of the raw recordings and `calib.txt` of the odometry benchmark.

use super::camera_file::FileCamera;
use super::error::CalibrationFileError;
use super::stereo::StereoCalibration;
use crate::images::matrix::IDENTITY;
use furrow_model::{CameraCalibration, Distortion};

/// Whether a text is one of KITTI's calibrations.
pub fn is_kitti(text: &str) -> bool {
    let is_odometry = |line: &str| {
        let named = line.strip_prefix('P').and_then(|rest| rest.split_once(':'));
        let numbers = named.filter(|(camera, _)| camera.parse::<u8>().is_ok()).map_or(line, |(_, numbers)| numbers);
        let words = numbers.split_whitespace();
        words.clone().count() == 12 && words.clone().all(|word| word.parse::<f64>().is_ok())
    };
    text.contains("P_rect_") || text.lines().map(str::trim).any(is_odometry)
}

/// The two `cameras` of either of KITTI's texts. `calib.txt` tells no size, and its images are rectified.
///
/// # Errors
/// Missing lines and lines of wrong length.
pub fn cameras(what: &str, text: &str, cameras: [u8; 2]) -> Result<[FileCamera; 2], CalibrationFileError> {
    let pair = if text.contains("P_rect_") {
        raw_calibration(what, text, cameras[0], cameras[1])?
    } else {
        odometry_calibration(what, text, cameras, [0, 0])?
    };
    let rectified_size = pair.rectified_size.map(|(columns, rows)| [columns, rows]);
    let camera =
        |camera| FileCamera { what: what.to_owned(), camera, is_aligned: true, rectified_size, camera_from_body: None };
    Ok([camera(pair.left), camera(pair.right)])
}

/// Reads two cameras of a `calib_cam_to_cam.txt`, e.g. 0 and 1 (grey) or 2 and 3 (colour), for **unrectified** images:
/// K, D, R_rect, P_rect and the size S; the rectified size is S_rect. `what` names the text in errors.
///
/// # Errors
/// Missing lines and lines of wrong length.
pub fn raw_calibration(what: &str, text: &str, left: u8, right: u8) -> Result<StereoCalibration, CalibrationFileError> {
    let lines = Lines { what, text };
    let [width, height] = lines.size(&format!("S_rect_{left:02}"))?;
    Ok(StereoCalibration {
        left: raw_camera(&lines, left)?,
        right: raw_camera(&lines, right)?,
        rectified_size: Some((width, height)),
        stream_is_rectified: false,
    })
}

fn raw_camera(lines: &Lines<'_>, camera: u8) -> Result<CameraCalibration, CalibrationFileError> {
    let [width, height] = lines.size(&format!("S_{camera:02}"))?;
    Ok(CameraCalibration {
        width,
        height,
        distortion: Distortion::RadialTangential,
        coefficients: lines.numbers::<5>(&format!("D_{camera:02}"))?.to_vec(),
        intrinsics: lines.numbers(&format!("K_{camera:02}"))?,
        rectification: lines.numbers(&format!("R_rect_{camera:02}"))?,
        projection: lines.numbers(&format!("P_rect_{camera:02}"))?,
    })
}

/// Reads the two cameras of a rectified KITTI odometry `calib.txt` for images of `width` x `height`: lines `P<left>:`
/// and `P<right>:`, or, without names, the first two lines of 12 numbers.
///
/// # Errors
/// Missing lines and lines of wrong length.
pub fn odometry_calibration(
    what: &str,
    text: &str,
    [left, right]: [u8; 2],
    [width, height]: [u32; 2],
) -> Result<StereoCalibration, CalibrationFileError> {
    let lines = Lines { what, text };
    let [left, right] = if text.contains(':') {
        [lines.numbers(&format!("P{left}"))?, lines.numbers(&format!("P{right}"))?]
    } else {
        let bare: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
        let [left, right, ..] = bare[..] else {
            return Err(CalibrationFileError::NotTwo { found: bare.len(), what: what.to_owned() });
        };
        [lines.parse("line 1", left)?, lines.parse("line 2", right)?]
    };
    let camera = |p: [f64; 12]| CameraCalibration {
        width,
        height,
        distortion: Distortion::RadialTangential,
        coefficients: Vec::new(),
        intrinsics: [p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]],
        rectification: IDENTITY,
        projection: p,
    };
    Ok(StereoCalibration { left: camera(left), right: camera(right), rectified_size: None, stream_is_rectified: true })
}

/// A text of lines `key: number number ...`.
struct Lines<'a> {
    what: &'a str,
    text: &'a str,
}

impl Lines<'_> {
    fn numbers<const COUNT: usize>(&self, key: &str) -> Result<[f64; COUNT], CalibrationFileError> {
        let value = self.text.lines().find_map(|line| line.trim().strip_prefix(key)?.trim_start().strip_prefix(':'));
        let missing = || CalibrationFileError::Missing { what: self.what.to_owned(), key: key.to_owned() };
        self.parse(key, value.ok_or_else(missing)?)
    }

    fn parse<const COUNT: usize>(&self, key: &str, value: &str) -> Result<[f64; COUNT], CalibrationFileError> {
        let numbers: Result<Vec<f64>, _> = value.split_whitespace().map(str::parse).collect();
        numbers.ok().and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| CalibrationFileError::Numbers {
            what: self.what.to_owned(),
            key: key.to_owned(),
            expected: format!("{COUNT} numbers"),
            found: value.trim().to_owned(),
        })
    }

    fn size(&self, key: &str) -> Result<[u32; 2], CalibrationFileError> {
        let numbers: [f64; 2] = self.numbers(key)?;
        if numbers.iter().all(|&value| value.fract() == 0.0 && (1.0..65_536.0).contains(&value)) {
            return Ok(numbers.map(|value| value as u32));
        }
        Err(CalibrationFileError::Numbers {
            what: self.what.to_owned(),
            key: key.to_owned(),
            expected: "whole columns and rows".to_owned(),
            found: format!("{numbers:?}"),
        })
    }
}
