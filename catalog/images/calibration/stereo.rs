//! The stored record of a stereo pair's calibration.

use super::error::CalibrationError;
use furrow_model::CameraCalibration;
use serde::{Deserialize, Serialize};

/// All that is needed to rectify a recording's images again, the same way: stored as an object beside them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StereoCalibration {
    /// The left camera as recorded.
    pub left: CameraCalibration,
    /// The right camera as recorded.
    pub right: CameraCalibration,
    /// Columns and rows of a rectified image; `None` lets [`extent`](crate::images::rectify::extent) choose, or takes
    /// the recorded size where the stream is rectified already.
    pub rectified_size: Option<(u32, u32)>,
    /// True where the recorded images are rectified already: P is trusted, and no pixel is moved.
    pub stream_is_rectified: bool,
}

impl StereoCalibration {
    /// The same pair for recorded images of another resolution; see [`fit_to_image`]. An explicit rectified size scales
    /// along.
    ///
    /// # Errors
    /// Where the shape differs.
    pub fn fit_to_images(&self, width: u32, height: u32) -> Result<Self, CalibrationError> {
        let scaled = |size: u32, to: u32, from: u32| (u64::from(size) * u64::from(to) / u64::from(from.max(1))) as u32;
        Ok(Self {
            left: fit_to_image(&self.left, width, height)?,
            right: fit_to_image(&self.right, width, height)?,
            rectified_size: self.rectified_size.map(|(columns, rows)| {
                (scaled(columns, width, self.left.width), scaled(rows, height, self.left.height))
            }),
            stream_is_rectified: self.stream_is_rectified,
        })
    }
}

/// The calibration of the same camera for images of another resolution (binned or scaled): focal lengths scale, and so
/// do principal points about the image's corner, which lies at (-0.5, -0.5) because pixel centres have whole
/// coordinates.
///
/// # Errors
/// Where the shape differs by more than a pixel's rounding: the image is then cropped, and K says nothing about where.
pub fn fit_to_image(
    calibration: &CameraCalibration,
    width: u32,
    height: u32,
) -> Result<CameraCalibration, CalibrationError> {
    let scale_x = f64::from(width) / f64::from(calibration.width);
    let scale_y = f64::from(height) / f64::from(calibration.height);
    let rounding = 1.0 / f64::from(width.min(height).max(1));
    if !(scale_x > 0.0 && scale_y > 0.0 && (scale_x / scale_y - 1.0).abs() <= rounding) {
        return Err(CalibrationError::Shape {
            width: calibration.width,
            height: calibration.height,
            to_width: width,
            to_height: height,
        });
    }
    let mut scaled = CameraCalibration { width, height, ..calibration.clone() };
    scale_rows::<3>(&mut scaled.intrinsics, scale_x, scale_y);
    scale_rows::<4>(&mut scaled.projection, scale_x, scale_y);
    Ok(scaled)
}

/// Scales the first two rows of a camera matrix with `COLUMNS` columns: u' + 0.5 = s (u + 0.5).
fn scale_rows<const COLUMNS: usize>(matrix: &mut [f64], scale_x: f64, scale_y: f64) {
    for (row, scale) in [scale_x, scale_y].into_iter().enumerate() {
        let row = &mut matrix[row * COLUMNS..(row + 1) * COLUMNS];
        row.iter_mut().for_each(|value| *value *= scale);
        row[2] += 0.5 * scale - 0.5;
    }
}
