//! A camera's calibration.

use super::cursor::{Cursor, MessageError};
use super::header::Header;
use crate::recording::Encoding;
use furrow_catalog::images::calibration::lenses::{KNOWN_MODELS, distortion_named};
use furrow_model::{CameraCalibration, Distortion};

/// `sensor_msgs/CameraInfo`.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraInfo<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// Rows of the full image.
    pub height: u32,
    /// Columns of the full image.
    pub width: u32,
    /// The lens model's name, as `plumb_bob`.
    pub distortion_model: &'a str,
    /// Its coefficients.
    pub d: Vec<f64>,
    /// 3x3 by rows, pixels.
    pub k: [f64; 9],
    /// 3x3 by rows: rectified frame from camera frame.
    pub r: [f64; 9],
    /// 3x4 by rows, pixels; the right camera's `p[3]` is -fx * baseline.
    pub p: [f64; 12],
    /// Pixels that were binned into one, by columns and rows; 0 means 1.
    pub binning: [u32; 2],
    /// The part of the full image that is recorded: x offset, y offset, height, width, pixels; all zero means
    /// everything.
    pub region: [u32; 4],
}

impl<'a> CameraInfo<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "sensor_msgs/CameraInfo";

    /// Decodes a message.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        let info = Self {
            header: Header::read(&mut cursor, encoding)?,
            height: cursor.u32("height")?,
            width: cursor.u32("width")?,
            distortion_model: cursor.text("distortion_model")?,
            d: cursor.f64_list("D")?,
            k: cursor.f64s("K")?,
            r: cursor.f64s("R")?,
            p: cursor.f64s("P")?,
            binning: [cursor.u32("binning_x")?, cursor.u32("binning_y")?],
            region: [cursor.u32("roi")?, cursor.u32("roi")?, cursor.u32("roi")?, cursor.u32("roi")?],
        };
        let _do_rectify = cursor.u8("roi.do_rectify")?;
        Ok(info)
    }

    /// The calibration of the whole sensor as furrow keeps it. A lens whose coefficients are all zero bends nothing,
    /// whatever its model's name.
    ///
    /// # Errors
    /// A lens model that is not known, or one whose coefficients are too few or too many.
    pub fn calibration(&self) -> Result<CameraCalibration, MessageError> {
        let wrong_value = |field, found, expected| MessageError::Value { message: Self::TYPE, field, found, expected };
        let name = self.distortion_model;
        let distortion = distortion_named(name, &self.d)
            .ok_or_else(|| wrong_value("distortion_model", format!("'{name}'"), KNOWN_MODELS))?;
        // Some drivers fill the coefficients up with zeros.
        let used = self.d.iter().rposition(|&coefficient| coefficient != 0.0).map_or(0, |last| last + 1);
        let (counts, expected): (&[usize], _) = match distortion {
            Distortion::Equidistant => (&[0, 4], "4"),
            // The thin prism and the tilt are the rational model's.
            _ if name.to_ascii_lowercase().contains("rational") => (&[0, 4, 5, 8, 12, 14], "4, 5, 8, 12 or 14"),
            _ => (&[0, 4, 5, 8], "4, 5 or 8 (12 or 14 for rational_polynomial)"),
        };
        let Some(&count) = counts.iter().find(|&&count| count >= used) else {
            return Err(wrong_value(
                "D",
                format!("{} coefficients, {used} up to the last that is not 0", self.d.len()),
                expected,
            ));
        };
        let mut coefficients = self.d.clone();
        coefficients.resize(count, 0.0);
        Ok(CameraCalibration {
            width: self.width,
            height: self.height,
            distortion,
            coefficients,
            intrinsics: self.k,
            rectification: self.r,
            projection: self.p,
        })
    }
}
