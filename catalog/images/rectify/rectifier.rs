//! Rectification: recorded images become those of the rig.

use super::extent;
use super::lens::Lens;
use super::rig::rig_of;
use crate::images::calibration::check::{check_camera, is_rectified};
use crate::images::calibration::error::CalibrationError;
use crate::images::calibration::stereo::StereoCalibration;
use crate::images::error::ImageError;
use crate::images::header::check_size;
use crate::images::side::Side;
use crate::images::threads::single_threaded;
use furrow_model::{CameraCalibration, ColourImage, GreyImage, StereoRig};
use opencv::core::{CV_16SC2, Mat};
use opencv::imgproc;

/// Where the map points for pixels that no source pixel shows: outside every image, so that the border's 0 results.
const NOWHERE_PX: f32 = -16.0;

/// Turns recorded images into rectified ones. Built once per calibration; may be shared between threads.
pub struct Rectifier {
    record: StereoCalibration,
    rig: StereoRig,
    /// `None` where the stream is rectified already.
    warp: Option<[Warp; 2]>,
}

/// One camera's map.
struct Warp {
    lens: Lens,
    /// Whole source pixels (x, y), `CV_16SC2`.
    whole: Mat,
    /// Fractions in 1/32 px, 32 * y + x, `CV_16UC1`.
    fraction: Mat,
}

impl Rectifier {
    /// For images as the cameras took them, or, where [`is_rectified`] says so of both, rectified ones. The size
    /// of a rectified image is chosen by [`extent::choose`].
    ///
    /// # Errors
    /// Calibrations that are missing or give no rectified pair.
    pub fn new(left: &CameraCalibration, right: &CameraCalibration) -> Result<Self, CalibrationError> {
        Self::from_record(&StereoCalibration {
            left: left.clone(),
            right: right.clone(),
            rectified_size: None,
            stream_is_rectified: is_rectified(left) && is_rectified(right),
        })
    }

    /// For topics whose images are rectified though their `CameraInfo` tells of the raw camera, as ROS' `image_rect`
    /// topics do: trusts P and moves no pixel.
    ///
    /// # Errors
    /// As [`Rectifier::new`], and image sizes that differ.
    pub fn for_rectified_topic(left: &CameraCalibration, right: &CameraCalibration) -> Result<Self, CalibrationError> {
        Self::from_record(&StereoCalibration {
            left: left.clone(),
            right: right.clone(),
            rectified_size: None,
            stream_is_rectified: true,
        })
    }

    /// Builds the rectifier of a record, e.g. of a stored one or of a calibration file. An explicit rectified size is
    /// kept; in a stream that is rectified already, it is the size of its images.
    ///
    /// # Errors
    /// As [`Rectifier::new`].
    pub fn from_record(record: &StereoCalibration) -> Result<Self, CalibrationError> {
        let StereoCalibration { left, right, .. } = record;
        check_camera(Side::Left, left)?;
        check_camera(Side::Right, right)?;
        if record.stream_is_rectified {
            return Self::without_warp(record);
        }
        let lenses = [Lens::new(Side::Left, left)?, Lens::new(Side::Right, right)?];
        let (width, height) = match record.rectified_size {
            Some(size) => checked_size(size)?,
            None => extent::choose(&lenses, left, right)?,
        };
        let rig = rig_of(left, right, width, height)?;
        let [left_lens, right_lens] = lenses;
        let warp = Some([Warp::new(left_lens, width, height)?, Warp::new(right_lens, width, height)?]);
        Ok(Self { record: StereoCalibration { rectified_size: Some((width, height)), ..record.clone() }, rig, warp })
    }

    fn without_warp(record: &StereoCalibration) -> Result<Self, CalibrationError> {
        let StereoCalibration { left, right, .. } = record;
        let sides = [("the image's columns", left.width, right.width), ("the image's rows", left.height, right.height)];
        if let Some((what, left, right)) = sides.into_iter().find(|(_, left, right)| left != right) {
            let expected = "equal sizes of rectified images";
            return Err(CalibrationError::NoPair { what, left: left.into(), right: right.into(), expected });
        }
        let (width, height) = checked_size(record.rectified_size.unwrap_or((left.width, left.height)))?;
        let rig = rig_of(left, right, width, height)?;
        Ok(Self {
            record: StereoCalibration { rectified_size: Some((width, height)), ..record.clone() },
            rig,
            warp: None,
        })
    }

    /// The record from which [`Rectifier::from_record`] rebuilds this rectifier, its rectified size filled in.
    pub fn record(&self) -> &StereoCalibration {
        &self.record
    }

    /// The rig that rectified images show the world through.
    pub fn rig(&self) -> StereoRig {
        self.rig
    }

    /// Whether images pass unchanged.
    pub fn is_identity(&self) -> bool {
        self.warp.is_none()
    }

    /// The recorded pixel (x, y) that the rectified pixel (u, v) shows, in pixels; see [`Lens::source_of`].
    pub fn source_of(&self, side: Side, u_px: f64, v_px: f64) -> Option<[f64; 2]> {
        match &self.warp {
            None => Some([u_px, v_px]),
            Some(warp) => warp[side as usize].lens.source_of(u_px, v_px),
        }
    }

    /// Rectifies a grey image: bilinear in steps of 1/32 px, 0 outside the recorded image.
    ///
    /// # Errors
    /// An image of another size than the calibration's.
    pub fn rectify_grey(&self, side: Side, image: GreyImage) -> Result<GreyImage, ImageError> {
        self.check_size(side, image.width, image.height)?;
        let Some(warp) = &self.warp else { return Ok(image) };
        let (width, height) = (self.rig.width as usize, self.rig.height as usize);
        let mut pixels = vec![0u8; width * height];
        let mut remap = || -> opencv::Result<()> {
            let source = Mat::new_rows_cols_with_data(image.height as i32, image.width as i32, &image.pixels)?;
            let mut target = Mat::new_rows_cols_with_data_mut(height as i32, width as i32, &mut pixels)?;
            warp[side as usize].apply(&source, &mut target)
        };
        remap().map_err(|source| ImageError::OpenCv { doing: "rectify a grey image", source })?;
        Ok(GreyImage { width, height, pixels })
    }

    /// Rectifies a colour image, channel by channel as [`Rectifier::rectify_grey`] does.
    ///
    /// # Errors
    /// An image of another size than the calibration's.
    pub fn rectify_colour(&self, side: Side, image: &ColourImage) -> Result<ColourImage, ImageError> {
        self.check_size(side, image.width, image.height)?;
        let Some(warp) = &self.warp else { return Ok(image.clone()) };
        let (width, height) = (self.rig.width as usize, self.rig.height as usize);
        let mut rgb = vec![0u8; width * height * 3];
        let mut remap = || -> opencv::Result<()> {
            type Pixel = opencv::core::Vec3b;
            let source = Mat::new_rows_cols_with_bytes::<Pixel>(image.height as i32, image.width as i32, &image.rgb)?;
            let mut target = Mat::new_rows_cols_with_bytes_mut::<Pixel>(height as i32, width as i32, &mut rgb)?;
            warp[side as usize].apply(&source, &mut target)
        };
        remap().map_err(|source| ImageError::OpenCv { doing: "rectify a colour image", source })?;
        Ok(ColourImage { width, height, rgb })
    }

    fn check_size(&self, side: Side, found_width: usize, found_height: usize) -> Result<(), ImageError> {
        let (width, height) = match (&self.warp, side) {
            (None, _) => (self.rig.width, self.rig.height),
            (Some(_), Side::Left) => (self.record.left.width, self.record.left.height),
            (Some(_), Side::Right) => (self.record.right.width, self.record.right.height),
        };
        if (found_width, found_height) == (width as usize, height as usize) {
            return Ok(());
        }
        Err(ImageError::NotOfTheCalibration { side, found_width, found_height, width, height })
    }
}

impl Warp {
    fn new(lens: Lens, width: u32, height: u32) -> Result<Self, CalibrationError> {
        single_threaded();
        let convert = || -> opencv::Result<Self> {
            let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (f64::from(u), f64::from(v))));
            let (x, y): (Vec<f32>, Vec<f32>) = pixels
                .map(|(u, v)| lens.source_of(u, v).map_or((NOWHERE_PX, NOWHERE_PX), |[x, y]| (x as f32, y as f32)))
                .unzip();
            let x = Mat::new_rows_cols_with_data(height as i32, width as i32, &x)?;
            let y = Mat::new_rows_cols_with_data(height as i32, width as i32, &y)?;
            let (mut whole, mut fraction) = (Mat::default(), Mat::default());
            imgproc::convert_maps(&x, &y, &mut whole, &mut fraction, CV_16SC2, false)?;
            Ok(Self { lens: lens.clone(), whole, fraction })
        };
        convert().map_err(|source| CalibrationError::OpenCv { doing: "prepare a rectification map", source })
    }

    fn apply(
        &self,
        source: &impl opencv::core::ToInputArray,
        target: &mut impl opencv::core::ToOutputArray,
    ) -> opencv::Result<()> {
        imgproc::remap_def(source, target, &self.whole, &self.fraction, imgproc::INTER_LINEAR)
    }
}

fn checked_size((width, height): (u32, u32)) -> Result<(u32, u32), CalibrationError> {
    match check_size(width as usize, height as usize) {
        Ok(()) => Ok((width, height)),
        Err(_) => Err(CalibrationError::BadValue {
            side: Side::Left,
            what: "rectified size",
            found: format!("{width} x {height}"),
            expected: "1 to 12000 pixels a side, at most 100 million in all".to_owned(),
        }),
    }
}
