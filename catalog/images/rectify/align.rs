//! R and P for two cameras of which only the lenses and their places on the rig are known, as Kalibr and EuRoC tell
//! them.
//!
//! Both cameras are turned by half of their relative rotation, so that they look the same way, and then together by the
//! smallest rotation that lays the baseline along x: Bouguet's method, as in OpenCV's `stereoRectify`, in closed form
//! and plain `f64`, so that every machine gets the same bits. The focal length stays that of the recorded images; the
//! rectified image is the largest part of a recorded one's size that both cameras see.

use super::lens::Lens;
use super::pose::{Pose, rotated, transposed};
use crate::images::calibration::check::{check_camera, is_rectified};
use crate::images::calibration::error::CalibrationError;
use crate::images::calibration::stereo::StereoCalibration;
use crate::images::matrix::product;
use crate::images::rectify::extent::sees;
use crate::images::side::Side;
use furrow_model::CameraCalibration;

/// Visibility is looked at on every fourth row and column.
const CELL_PX: u32 = 4;
/// A row or column at the edge stays where no more of it than one part in so many is unseen.
const UNSEEN_PART: usize = 50;

/// The calibration of a pair whose right camera sits at `right_from_left`. R and P of the cameras are not looked at.
/// Where the cameras turn out to be rectified already, no pixel will be moved.
///
/// # Errors
/// Lenses that cannot be; cameras one above or behind the other, exchanged, or without a common view.
pub fn align(
    left: &CameraCalibration,
    right: &CameraCalibration,
    right_from_left: &Pose,
) -> Result<StereoCalibration, CalibrationError> {
    for (side, camera) in [(Side::Left, left), (Side::Right, right)] {
        check_camera(side, &as_it_is(camera))?;
    }
    let half = half_rotation(&right_from_left.rotation);
    let towards_left = rotated(&transposed(&half), right_from_left.translation);
    let baseline_m = towards_left.iter().map(|value| value * value).sum::<f64>().sqrt();
    let turn = onto_x(towards_left, baseline_m)?;
    let rotations = [product(&turn, &half), product(&turn, &transposed(&half))];

    let (kl, kr) = (&left.intrinsics, &right.intrinsics);
    let focal = (kl[0] + kl[4] + kr[0] + kr[4]) / 4.0;
    let centre = |k: &[f64; 9], rotation: &[f64; 9]| {
        let [x, y, z] = rotated(rotation, [0.0, 0.0, 1.0]);
        [k[2] - focal * x / z, k[5] - focal * y / z]
    };
    let [l, r] = [centre(kl, &rotations[0]), centre(kr, &rotations[1])];
    let centre = [(l[0] + r[0]) / 2.0, (l[1] + r[1]) / 2.0];
    let mut aligned = StereoCalibration {
        left: seen_through(left, rotations[0], focal, centre, 0.0),
        right: seen_through(right, rotations[1], focal, centre, -focal * baseline_m),
        rectified_size: None,
        stream_is_rectified: false,
    };
    aligned.stream_is_rectified = is_rectified(&aligned.left) && is_rectified(&aligned.right);
    if !aligned.stream_is_rectified {
        let [x, y, columns, rows] = common_view(&aligned.left, &aligned.right)?;
        for camera in [&mut aligned.left, &mut aligned.right] {
            camera.projection[2] -= f64::from(x);
            camera.projection[6] -= f64::from(y);
        }
        aligned.rectified_size = Some((columns, rows));
    }
    Ok(aligned)
}

/// The camera with R that does nothing and P of its own focal length, to check the rest of its numbers.
fn as_it_is(camera: &CameraCalibration) -> CameraCalibration {
    let k = &camera.intrinsics;
    seen_through(camera, Pose::IDENTITY.rotation, k[0], [k[2], k[5]], 0.0)
}

fn seen_through(
    camera: &CameraCalibration,
    rectification: [f64; 9],
    focal: f64,
    [cu, cv]: [f64; 2],
    p3: f64,
) -> CameraCalibration {
    let projection = [focal, 0.0, cu, p3, 0.0, focal, cv, 0.0, 0.0, 0.0, 1.0, 0.0];
    CameraCalibration { rectification, projection, ..camera.clone() }
}

/// The rotation about the same axis by half the angle, which is less than half a turn.
fn half_rotation(r: &[f64; 9]) -> [f64; 9] {
    // The quaternion (w, x, y, z) of r, up to its length: exact for rotations under a half turn, which a pair's are.
    let [w, x, y, z] = [1.0 + r[0] + r[4] + r[8], r[7] - r[5], r[2] - r[6], r[3] - r[1]];
    let length = (w * w + x * x + y * y + z * z).sqrt();
    // Adding the identity's quaternion halves the angle.
    let [w, x, y, z] = [w / length + 1.0, x / length, y / length, z / length];
    let length = (w * w + x * x + y * y + z * z).sqrt();
    let [w, x, y, z] = [w / length, x / length, y / length, z / length];
    [
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

/// The smallest rotation that lays `towards_left` of length `length` along -x.
fn onto_x(towards_left: [f64; 3], length: f64) -> Result<[f64; 9], CalibrationError> {
    let [x, y, z] = towards_left;
    let no_pair =
        |what, value: f64, expected| Err(CalibrationError::NoPair { what, left: 0.0, right: value, expected });
    if !(length.is_finite() && length > 0.0) {
        return no_pair("the distance between the cameras in metres", length, "two places");
    }
    if y.abs() >= x.abs() || z.abs() >= x.abs() {
        let expected = "cameras side by side, not one above or behind the other";
        return no_pair("the largest offset to the side in metres", -x, expected);
    }
    if x > 0.0 {
        let expected = "the right camera's place to the right of the left one's: name the left camera first";
        return no_pair("the place along the image's columns in metres", -x, expected);
    }
    // Rodrigues' formula for the axis u x (-1, 0, 0) = (0, -uz, uy) and the cosine -ux.
    let [ux, uy, uz] = [x / length, y / length, z / length];
    let [vy, vz] = [0.0 - uz, uy];
    let scale = 1.0 / (1.0 - ux);
    Ok([
        1.0 - (vy * vy + vz * vz) * scale,
        0.0 - vz,
        vy,
        vz,
        1.0 - vz * vz * scale,
        vy * vz * scale,
        0.0 - vy,
        vy * vz * scale,
        1.0 - vy * vy * scale,
    ])
}

/// The part (first column, first row, columns, rows) of an image of the smaller recorded size that both cameras see.
fn common_view(left: &CameraCalibration, right: &CameraCalibration) -> Result<[u32; 4], CalibrationError> {
    let lenses = [Lens::new(Side::Left, left)?, Lens::new(Side::Right, right)?];
    let (width, height) = (left.width.min(right.width), left.height.min(right.height));
    let columns: Vec<u32> = (0..width).step_by(CELL_PX as usize).chain([width - 1]).collect();
    let rows: Vec<u32> = (0..height).step_by(CELL_PX as usize).chain([height - 1]).collect();
    let seen_at = |u: u32, v: u32| {
        lenses.iter().zip([left, right]).all(|(lens, camera)| sees(lens, camera, f64::from(u), f64::from(v)))
    };
    let seen: Vec<Vec<bool>> = rows.iter().map(|&v| columns.iter().map(|&u| seen_at(u, v)).collect()).collect();
    let [mut top, mut bottom, mut first, mut last] = [0, rows.len() - 1, 0, columns.len() - 1];
    let few = |unseen: usize, of: usize| unseen * UNSEEN_PART <= of;
    loop {
        let (down, across) = (bottom - top + 1, last - first + 1);
        let in_row = |row: usize| (first..=last).filter(|&column| !seen[row][column]).count() * down;
        let in_column = |column: usize| (top..=bottom).filter(|&row| !seen[row][column]).count() * across;
        // Shares of unseen cells, all over the same denominator.
        let edges = [in_row(top), in_row(bottom), in_column(first), in_column(last)];
        let worst = (0..4).max_by_key(|&edge| (edges[edge], std::cmp::Reverse(edge))).unwrap_or_default();
        if few(edges[worst], down * across) {
            break;
        }
        if down <= 2 || across <= 2 {
            let count = seen.iter().flatten().filter(|&&seen| seen).count();
            let percent_seen = count as f64 * 100.0 / (rows.len() * columns.len()) as f64;
            return Err(CalibrationError::NoOverlap { percent_seen, width, height });
        }
        match worst {
            0 => top += 1,
            1 => bottom -= 1,
            2 => first += 1,
            _ => last -= 1,
        }
    }
    let [x, y] = [columns[first], rows[top]];
    Ok([x, y, columns[last] - x + 1, rows[bottom] - y + 1])
}
