//! The calibration of a recording's pair from its CameraInfo.

use crate::message::{CameraInfo, MessageError, PartCalibration, SensorPart};
use crate::traversal::notes::Notes;
use crate::traversal::rig::square_pixels;
use furrow_catalog::images::calibration::check::{check_camera, far_centre, is_rectified};
use furrow_catalog::images::calibration::pair_file::without_empty_lens;
use furrow_catalog::images::{CalibrationError, Rectifier, Side, StereoCalibration};
use furrow_model::CameraCalibration;

/// What a CameraInfo message tells of its camera.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RecordedInfo {
    /// The whole sensor, unbinned.
    pub(super) sensor: CameraCalibration,
    /// What of it the images show.
    pub(super) part: SensorPart,
}

/// Why CameraInfo gives no calibration of a pair.
pub(super) enum InfoError {
    /// The numbers of a camera, or of the two.
    Calibration(CalibrationError),
    /// The images are not those that CameraInfo tells of.
    Images(String),
}

impl From<CalibrationError> for InfoError {
    fn from(error: CalibrationError) -> Self {
        Self::Calibration(error)
    }
}

impl RecordedInfo {
    /// What a message tells.
    pub(super) fn of(info: &CameraInfo<'_>) -> Result<Self, MessageError> {
        Ok(Self { sensor: info.calibration()?, part: SensorPart::of(info) })
    }

    /// Whether the camera is calibrated at all: drivers send zeros until the calibration is loaded.
    pub(super) fn is_calibrated(&self) -> bool {
        let CameraCalibration { intrinsics, rectification, projection, .. } = &self.sensor;
        [&intrinsics[..], &rectification[..], &projection[..]].iter().all(|m| m.iter().any(|&value| value != 0.0))
    }
}

/// The images of a pair.
pub(super) struct InfoImages<'a> {
    /// Columns and rows of the left and of the right ones.
    pub(super) sizes: [[u32; 2]; 2],
    /// Whether their topics' names say that they are rectified.
    pub(super) are_rectified: bool,
    /// Whether their topics' names say that they are raw.
    pub(super) are_raw: bool,
    /// The topics of their CameraInfo.
    pub(super) topics: [&'a str; 2],
}

/// The calibration of a pair's images by its two CameraInfo.
///
/// # Errors
/// Cameras that are not calibrated or make no rectified pair; images of another size than CameraInfo's.
pub(super) fn pair_calibration(
    infos: &[RecordedInfo; 2],
    images: &InfoImages<'_>,
    notes: &Notes,
) -> Result<StereoCalibration, InfoError> {
    let sides = [Side::Left, Side::Right];
    for (info, side) in infos.iter().zip(sides) {
        if !info.is_calibrated() {
            check_camera(side, &info.sensor)?;
        }
    }
    let part = |side: Side| {
        let at = side as usize;
        let part = infos[at].part.calibration(&infos[at].sensor, images.sizes[at]);
        part.map_err(|said| InfoError::Images(format!("the CameraInfo on {} does not fit: {said}", images.topics[at])))
    };
    let mut parts = [part(Side::Left)?, part(Side::Right)?];
    for (part, topic) in parts.iter().zip(images.topics) {
        note(part, topic, notes);
    }
    check_scales(&parts, images)?;
    if !images.are_rectified {
        share_the_view(&mut parts);
    }
    let [left, right] = parts.map(|part| part.calibration);
    let mut pair = StereoCalibration { left, right, rectified_size: None, stream_is_rectified: images.are_rectified };
    pair.stream_is_rectified |= is_rectified(&pair.left) && is_rectified(&pair.right);
    if pair.stream_is_rectified && images.are_raw {
        notes.add(format!(
            "the images' topics are named raw, but {} and {} tell of rectified images, free of distortion: they were taken \
             as rectified; name other topics with --left-info and --right-info where they are not",
            images.topics[0], images.topics[1]
        ));
    }
    if !pair.stream_is_rectified {
        pair.left = without_empty_lens(pair.left);
        pair.right = without_empty_lens(pair.right);
    }
    let pair = Rectifier::from_record(&square_pixels(&pair, notes))?.record().clone();
    let [width, height] = images.sizes[0];
    if [pair.left.width, pair.left.height] == [width, height] {
        return Ok(pair);
    }
    Ok(pair.fit_to_images(width, height)?)
}

fn note(part: &PartCalibration, topic: &str, notes: &Notes) {
    if let Some(note) = &part.note {
        notes.add(format!("{topic}: {note}"));
    }
    if let Some(odd) = far_centre(&part.calibration).filter(|_| !part.is_central) {
        notes.add(format!("{topic}: {odd}"));
    }
}

/// P of raw images is free to choose: where left and right are cut at unlike places, both are seen from the corner that
/// both show.
fn share_the_view(parts: &mut [PartCalibration; 2]) {
    let [left, right] = [parts[0].offset, parts[1].offset];
    for part in parts {
        for (axis, at) in [(0, 2), (1, 6)] {
            let corner = left[axis].max(right[axis]);
            part.calibration.projection[at] -= f64::from(corner - part.offset[axis]);
        }
    }
}

/// Left and right images must be of one size, or each of its calibration's own.
fn check_scales(parts: &[PartCalibration; 2], images: &InfoImages<'_>) -> Result<(), InfoError> {
    let [left, right] = images.sizes;
    let is_own = parts
        .iter()
        .zip(images.sizes)
        .all(|(part, [width, height])| (part.calibration.width, part.calibration.height) == (width, height));
    let [l, r] = [&parts[0].calibration, &parts[1].calibration];
    let are_alike = (l.width, l.height) == (r.width, r.height);
    if left == right && are_alike || is_own && !images.are_rectified {
        return Ok(());
    }
    Err(InfoError::Images(format!(
        "the left images are {} x {}, calibrated as {} x {}, the right ones {} x {}, calibrated as {} x {}: expected both \
         at one scale; record both at one resolution",
        left[0], left[1], l.width, l.height, right[0], right[1], r.width, r.height
    )))
}
