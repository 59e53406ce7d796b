//! Two cameras of calibration files as a pair, for the images that are there.

use super::camera_file::FileCamera;
use super::check::is_rectified;
use super::error::CalibrationFileError;
use super::lenses::bends_nothing;
use super::stereo::{StereoCalibration, fit_to_image};
use crate::images::rectify::align::align;
use furrow_model::{CameraCalibration, Distortion};

/// The images that a calibration is wanted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PairImages {
    /// Columns and rows of the left images.
    pub left: [u32; 2],
    /// Columns and rows of the right images.
    pub right: [u32; 2],
    /// Which cameras of a KITTI text took them: 0 and 1 are grey, 2 and 3 colour.
    pub kitti_cameras: [u8; 2],
    /// Whether they are known to be rectified, as by a topic's name.
    pub are_rectified: bool,
}

/// The calibration of a pair.
///
/// # Errors
/// Images of another shape than the calibration's; cameras of which neither R and P nor their places are known.
pub fn pair_of(
    mut cameras: [FileCamera; 2],
    images: Option<&PairImages>,
) -> Result<StereoCalibration, CalibrationFileError> {
    let mut are_rectified = images.is_some_and(|images| images.are_rectified);
    if let Some(images) = images {
        let sizes = [images.left, images.right];
        if cameras.iter().zip(sizes).all(|(camera, size)| is_of_rectified(camera, size)) {
            are_rectified = true;
            cameras.iter_mut().for_each(|camera| {
                [camera.camera.width, camera.camera.height] = camera.rectified_size.unwrap_or_default();
            });
        }
        for (camera, size) in cameras.iter_mut().zip(sizes) {
            camera.fit(size)?;
        }
    }
    for camera in &cameras {
        if [camera.camera.width, camera.camera.height] == [0, 0] {
            return Err(CalibrationFileError::NoSize { what: camera.what.clone() });
        }
    }
    let [left, right] = cameras;
    if !(left.is_aligned && right.is_aligned) {
        return aligned(&left, &right, are_rectified);
    }
    let stream_is_rectified = are_rectified || (is_rectified(&left.camera) && is_rectified(&right.camera));
    let plain = |camera: CameraCalibration| if stream_is_rectified { camera } else { without_empty_lens(camera) };
    Ok(StereoCalibration {
        left: plain(left.camera),
        right: plain(right.camera),
        rectified_size: left.rectified_size.map(|[columns, rows]| (columns, rows)),
        stream_is_rectified,
    })
}

/// A lens of zeros bends nothing: drivers write zeros for images that are free of distortion, whatever the model's
/// name. The camera of a rectified stream is left as it was recorded, since no pixel moves by it.
pub fn without_empty_lens(camera: CameraCalibration) -> CameraCalibration {
    if camera.distortion == Distortion::Equidistant && bends_nothing(&camera.coefficients) {
        return CameraCalibration { distortion: Distortion::RadialTangential, ..camera };
    }
    camera
}

/// Whether images of this size are the rectified ones that a camera's P is for, or those scaled, and surely not the
/// recorded ones.
fn is_of_rectified(camera: &FileCamera, size: [u32; 2]) -> bool {
    let recorded = [camera.camera.width, camera.camera.height];
    let scales = |[width, height]: [u32; 2]| {
        let of = CameraCalibration { width, height, ..camera.camera.clone() };
        fit_to_image(&of, size[0], size[1]).is_ok()
    };
    let is_exact = camera.rectified_size == Some(size) && recorded != size;
    is_exact || (camera.rectified_size.is_some_and(scales) && recorded != [0, 0] && !scales(recorded))
}

fn aligned(
    left: &FileCamera,
    right: &FileCamera,
    are_rectified: bool,
) -> Result<StereoCalibration, CalibrationFileError> {
    let what = || if left.what == right.what { left.what.clone() } else { format!("{}, {}", left.what, right.what) };
    let (Some(from_left), Some(from_right)) = (left.camera_from_body, right.camera_from_body) else {
        return Err(CalibrationFileError::NoExtrinsics { what: what() });
    };
    let [plain_left, plain_right] = [left, right].map(|camera| without_empty_lens(camera.camera.clone()));
    let aligned = align(&plain_left, &plain_right, &from_right.after(&from_left.inverse()))
        .map_err(|source| CalibrationFileError::Camera { what: what(), source: Box::new(source) })?;
    if are_rectified && !aligned.stream_is_rectified {
        return Err(CalibrationFileError::OfUnrectified { what: what() });
    }
    Ok(aligned)
}
