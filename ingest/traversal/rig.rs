//! Whether a rig can be, whatever told of it: CameraInfo, a calibration file, or a folder's own.

use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use furrow_catalog::images::calibration::baseline::check_baseline;
use furrow_catalog::images::calibration::check::far_centre;
use furrow_catalog::images::calibration::square::squared;
use furrow_catalog::images::{Side, StereoCalibration};
use furrow_catalog::records::{Cameras, ViewsRecord};

/// The cameras as they enter the store: a pair whose baseline can be, seen through square pixels.
pub(crate) fn checked(views: ViewsRecord, notes: &Notes) -> Result<ViewsRecord, IngestError> {
    let Cameras::Pair(pair) = &views.calibration else { return Ok(views) };
    check_baseline(pair)?;
    let pair = square_pixels(pair, notes);
    Ok(ViewsRecord { calibration: Cameras::Pair(Box::new(pair)), ..views })
}

/// The pair seen through square pixels; noted where it was not before.
pub(crate) fn square_pixels(pair: &StereoCalibration, notes: &Notes) -> StereoCalibration {
    let Some(square) = squared(pair) else { return pair.clone() };
    let p = &pair.left.projection;
    notes.add(format!("P has fx {} and fy {}: rows were resampled, so that pixels are square", p[0], p[5]));
    square
}

/// Notes a principal point far from the middle in a calibration that a file tells.
pub(crate) fn note_far_centres(pair: &StereoCalibration, notes: &Notes) {
    for (side, camera) in [(Side::Left, &pair.left), (Side::Right, &pair.right)] {
        if let Some(odd) = far_centre(camera) {
            notes.add(format!("the {side} camera: {odd}"));
        }
    }
}
