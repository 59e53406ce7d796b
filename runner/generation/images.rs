//! Stored images in and out of generators.

use crate::RunError;
use furrow_catalog::Objects;
use furrow_catalog::images::{RawImage, decode_colour, store_raw};
use furrow_model::{ColourImage, ObjectId};

/// An image as it is stored.
pub(crate) fn lossless(image: &ColourImage) -> Result<Vec<u8>, furrow_catalog::images::ImageError> {
    let (width, height) = (image.width, image.height);
    let raw = RawImage { width, height, step: 3 * width, encoding: "rgb8", big_endian: false, data: &image.rgb };
    Ok(store_raw(&raw)?.bytes)
}

pub(crate) fn unusable(image: ObjectId, reason: impl ToString) -> RunError {
    RunError::Image { image, reason: reason.to_string() }
}

/// A left image as it is stored, neither rectified nor scaled.
pub(crate) fn stored_colour(
    objects: &Objects,
    image: ObjectId,
    calibration: ObjectId,
) -> Result<ColourImage, RunError> {
    let record: furrow_catalog::records::ViewsRecord = furrow_catalog::records::read(objects, calibration)?;
    decode_colour(&objects.read(image)?, record.left_bayer).map_err(|error| unusable(image, error))
}
