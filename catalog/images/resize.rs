//! Colour images of another size.

use crate::images::{ColourImage, ImageError, threads::single_threaded};
use opencv::core::{Mat, MatTraitConstManual, Size, Vec3b};
use opencv::imgproc;

/// The image at `width` x `height`: areas averaged where it shrinks, bicubic where it grows.
///
/// # Errors
/// An empty or oversized result, pixels that do not fill the image, and failures of OpenCV.
pub fn resized(image: &ColourImage, width: usize, height: usize) -> Result<ColourImage, ImageError> {
    single_threaded();
    crate::images::header::check_size(width, height)?;
    crate::images::header::check_size(image.width, image.height)?;
    if (width, height) == (image.width, image.height) {
        return Ok(image.clone());
    }
    let resize = || -> opencv::Result<Vec<u8>> {
        let source = Mat::new_rows_cols_with_bytes::<Vec3b>(image.height as i32, image.width as i32, &image.rgb)?;
        let shrinks = width * height < image.width * image.height;
        let how = if shrinks { imgproc::INTER_AREA } else { imgproc::INTER_CUBIC };
        let mut target = Mat::default();
        imgproc::resize(&source, &mut target, Size::new(width as i32, height as i32), 0.0, 0.0, how)?;
        Ok(target.data_bytes()?.to_vec())
    };
    let rgb = resize().map_err(|source| ImageError::OpenCv { doing: "resize an image", source })?;
    Ok(ColourImage { width, height, rgb })
}
