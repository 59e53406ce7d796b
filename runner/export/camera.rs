//! Stored images as players take them: the file's own bytes, unrectified, and the camera that belongs to them.

use super::message::{point2, stamp};
use crate::RunError;
use foxglove::messages::{CameraCalibration, CompressedImage, Point2};
use furrow_catalog::images::header::Format;
use furrow_catalog::images::{ImageError, RawImage, Side, decode_colour, inspect, store_raw};
use furrow_catalog::{Objects, Views};
use furrow_model::{Distortion, ObjectId};

/// The left camera of a traversal or an experience.
pub(super) struct Camera {
    views: Views,
    /// The frame of reference that it is the origin of.
    frame: String,
}

/// A file's bytes and what they are: `jpeg` or `png`.
pub(super) struct Picture {
    bytes: Vec<u8>,
    format: &'static str,
}

impl Camera {
    pub fn load(objects: &Objects, calibration: ObjectId, frame: String) -> Result<Self, RunError> {
        Ok(Self { views: Views::load(objects, calibration)?, frame })
    }

    pub fn views(&self) -> &Views {
        &self.views
    }

    /// A stored image: its own bytes, or a PNG of its colours where a mosaic is stored, which players do not show.
    pub fn picture(&self, objects: &Objects, image: ObjectId) -> Result<Picture, RunError> {
        let wrong = |error: ImageError| RunError::Image { image, reason: error.to_string() };
        let mut bytes = objects.read(image)?;
        if let Some(pattern) = self.views.record().left_bayer {
            let colour = decode_colour(&bytes, Some(pattern)).map_err(wrong)?;
            let raw = RawImage {
                width: colour.width,
                height: colour.height,
                encoding: "rgb8",
                big_endian: false,
                step: 3 * colour.width,
                data: &colour.rgb,
            };
            bytes = store_raw(&raw).map_err(wrong)?.bytes;
        }
        let format = match inspect(&bytes).map_err(wrong)?.format {
            Format::Jpeg => "jpeg",
            Format::Png => "png",
        };
        Ok(Picture { bytes, format })
    }

    pub fn image(&self, stamp_ns: i64, picture: Picture) -> Result<CompressedImage, RunError> {
        Ok(CompressedImage {
            timestamp: Some(stamp(stamp_ns)?),
            frame_id: self.frame.clone(),
            data: picture.bytes.into(),
            format: picture.format.to_owned(),
        })
    }

    /// K, D and R of the stored image, P of the rectified one.
    pub fn calibration(&self, stamp_ns: i64) -> Result<CameraCalibration, RunError> {
        let (camera, is_rectified) = self.views.left_camera();
        let rig = self.views.rig();
        let projection = vec![rig.focal_px, 0.0, rig.cu_px, 0.0, 0.0, rig.focal_px, rig.cv_px, 0.0, 0.0, 0.0, 1.0, 0.0];
        let (mut d, mut k, mut r) = (camera.coefficients.clone(), camera.intrinsics, camera.rectification);
        if is_rectified {
            d.clear();
            k = [rig.focal_px, 0.0, rig.cu_px, 0.0, rig.focal_px, rig.cv_px, 0.0, 0.0, 1.0];
            r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        }
        let model = match camera.distortion {
            Distortion::Equidistant if !d.is_empty() => "kannala_brandt",
            Distortion::RadialTangential if d.len() > 5 => "rational_polynomial",
            _ => {
                d.resize(5, 0.0);
                "plumb_bob"
            }
        };
        Ok(CameraCalibration {
            timestamp: Some(stamp(stamp_ns)?),
            frame_id: self.frame.clone(),
            width: camera.width,
            height: camera.height,
            distortion_model: model.to_owned(),
            d,
            k: k.to_vec(),
            r: r.to_vec(),
            p: projection,
        })
    }

    /// Where the stored image shows a rectified pixel.
    pub fn point(&self, rectified_px: [f64; 2]) -> Option<Point2> {
        self.views.source_of(Side::Left, rectified_px).map(point2)
    }
}
