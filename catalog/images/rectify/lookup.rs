//! Tables that say, pixel by pixel, where an undistorted image comes from in the recorded one, as the Oxford RobotCar
//! dataset brings them: doubles, little-endian, first the source column of every pixel by rows, then the source row.

use crate::images::error::ImageError;
use crate::images::threads::single_threaded;
use furrow_model::ColourImage;
use opencv::core::{CV_16SC2, Mat, Vec3b};
use opencv::imgproc;
use std::fs;
use std::path::Path;

/// Farther than this outside an image nothing is shown, whatever the table says.
const OUTSIDE_PX: f64 = 16.0;

/// A table, ready for images of one size.
#[derive(Debug)]
pub struct LookupTable {
    size: [u32; 2],
    /// Whole source pixels (x, y), `CV_16SC2`.
    whole: Mat,
    /// Fractions in 1/32 px, 32 * y + x, `CV_16UC1`.
    fraction: Mat,
}

impl LookupTable {
    /// Reads the table of images of `size` (columns, rows).
    ///
    /// # Errors
    /// What is wrong with the file, in words: it cannot be read, or is a table of images of another size.
    pub fn read(path: &Path, size: [u32; 2]) -> Result<Self, String> {
        let pixels = size[0] as usize * size[1] as usize;
        let found = fs::metadata(path).map_err(|error| error.to_string())?.len();
        let expected = 16 * pixels as u64;
        if found != expected {
            let [columns, rows] = size;
            return Err(format!(
                "expected {expected} bytes, two doubles for each pixel of {columns} x {rows}, found {found}: is it the \
                 table of this camera, and whole?"
            ));
        }
        let bytes = fs::read(path).map_err(|error| error.to_string())?;
        let values: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        let (x, y) = values.split_at_checked(pixels).unwrap_or_default();
        Self::new(size, x, y).map_err(|error| error.to_string())
    }

    fn new(size: [u32; 2], x: &[f64], y: &[f64]) -> opencv::Result<Self> {
        single_threaded();
        let [columns, rows] = size;
        let map = |values: &[f64], side: u32| -> Vec<f32> {
            let beyond = f64::from(side) + OUTSIDE_PX;
            let shown = |value: &f64| if value.is_finite() { value.clamp(-OUTSIDE_PX, beyond) } else { -OUTSIDE_PX };
            values.iter().map(|value| shown(value) as f32).collect()
        };
        let (x, y) = (map(x, columns), map(y, rows));
        let x = Mat::new_rows_cols_with_data(rows as i32, columns as i32, &x)?;
        let y = Mat::new_rows_cols_with_data(rows as i32, columns as i32, &y)?;
        let (mut whole, mut fraction) = (Mat::default(), Mat::default());
        imgproc::convert_maps(&x, &y, &mut whole, &mut fraction, CV_16SC2, false)?;
        Ok(Self { size, whole, fraction })
    }

    /// The undistorted image: bilinear in steps of 1/32 px, black outside of the recorded one.
    ///
    /// # Errors
    /// An image of another size.
    pub fn apply(&self, image: &ColourImage) -> Result<ColourImage, ImageError> {
        let [columns, rows] = self.size.map(|side| side as usize);
        if (image.width, image.height) != (columns, rows) {
            let fault =
                format!("{} x {} pixels, the lens's table is for {columns} x {rows}", image.width, image.height);
            return Err(ImageError::Message { fault });
        }
        let mut rgb = vec![0u8; columns * rows * 3];
        let mut remap = || -> opencv::Result<()> {
            let source = Mat::new_rows_cols_with_bytes::<Vec3b>(rows as i32, columns as i32, &image.rgb)?;
            let mut target = Mat::new_rows_cols_with_bytes_mut::<Vec3b>(rows as i32, columns as i32, &mut rgb)?;
            imgproc::remap_def(&source, &mut target, &self.whole, &self.fraction, imgproc::INTER_LINEAR)
        };
        remap().map_err(|source| ImageError::OpenCv { doing: "undistort an image by its table", source })?;
        Ok(ColourImage { width: columns, height: rows, rgb })
    }
}
