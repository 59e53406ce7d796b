//! Small JPEGs for reports.

use crate::images::{ColourImage, ImageError, threads::single_threaded};
use furrow_model::GreyImage;
use opencv::core::{Mat, MatTraitConst, Size, Vec3b, Vector};
use opencv::{imgcodecs, imgproc};

/// What a tile shows.
#[derive(Debug, Clone, Copy)]
pub enum Picture<'a> {
    /// A grey image.
    Grey(&'a GreyImage),
    /// A colour image.
    Colour(&'a ColourImage),
}

/// Encodes a picture as JPEG of `quality` (1 to 100), scaled down by area averaging to at most `max_width` columns.
///
/// # Errors
/// An empty picture or one whose pixels do not fill its size, and failures of the encoder.
pub fn encode_jpeg(picture: Picture<'_>, max_width: usize, quality: u8) -> Result<Vec<u8>, ImageError> {
    single_threaded();
    let (width, height) = match picture {
        Picture::Grey(image) => (image.width, image.height),
        Picture::Colour(image) => (image.width, image.height),
    };
    crate::images::header::check_size(width, height)?;
    let encode = || -> opencv::Result<Vec<u8>> {
        let full = blue_first(picture)?;
        let mut scaled = Mat::default();
        let tile = if width > max_width.max(1) {
            let columns = max_width.max(1);
            let rows = ((height * columns + width / 2) / width).max(1);
            let size = Size::new(columns as i32, rows as i32);
            imgproc::resize(&full, &mut scaled, size, 0.0, 0.0, imgproc::INTER_AREA)?;
            &scaled
        } else {
            &full
        };
        let parameters = Vector::from_slice(&[imgcodecs::IMWRITE_JPEG_QUALITY, i32::from(quality.clamp(1, 100))]);
        let mut bytes = Vector::<u8>::new();
        imgcodecs::imencode(".jpg", tile, &mut bytes, &parameters)?;
        Ok(bytes.as_slice().to_vec())
    };
    encode().map_err(|source| ImageError::OpenCv { doing: "encode a tile", source })
}

/// OpenCV's encoder takes blue first.
fn blue_first(picture: Picture<'_>) -> opencv::Result<Mat> {
    match picture {
        Picture::Grey(image) => {
            Mat::new_rows_cols_with_data(image.height as i32, image.width as i32, &image.pixels)?.try_clone()
        }
        Picture::Colour(image) => {
            let rgb = Mat::new_rows_cols_with_bytes::<Vec3b>(image.height as i32, image.width as i32, &image.rgb)?;
            let mut bgr = Mat::default();
            imgproc::cvt_color_def(&rgb, &mut bgr, imgproc::COLOR_RGB2BGR)?;
            Ok(bgr)
        }
    }
}
