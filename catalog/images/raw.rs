//! `sensor_msgs/Image`: raw pixels, stored losslessly.

use super::encoding::{Layout, layout_of};
use super::raw_image::RawImage;
use super::yuv::{packed_rgb, planar_rgb};
use crate::images::decode::{demosaic, grey_of, luma_of};
use crate::images::{BayerPattern, Depth, ImageError, StoredImage, header::check_size, png_codec};
use furrow_model::GreyImage;
use std::borrow::Cow;

/// Stores raw pixels as PNG; see [`RawPixels`].
///
/// # Errors
/// Those of [`RawPixels::of`].
pub fn store_raw(image: &RawImage<'_>) -> Result<StoredImage, ImageError> {
    RawPixels::of(image)?.store()
}

/// The pixels of a raw image as they are stored: grey, or red-green-blue. A mosaic is stored as grey with its pattern
/// kept beside, so that no colour is invented in the archive. The losses: the alpha channel is dropped, of 16-bit
/// values the upper 8 of the bits in use are kept, and luma with colour differences becomes red, green and blue. Equal
/// pixels give equal bytes, whatever the step, and colour orders agree: an `rgb8` and a `bgr8` image of one scene are
/// the same object.
pub struct RawPixels<'a> {
    width: usize,
    height: usize,
    pixels: Cow<'a, [u8]>,
    colour_type: png::ColorType,
    bayer: Option<BayerPattern>,
}

impl<'a> RawPixels<'a> {
    /// Checks and arranges what a message brought; of 16-bit values the upper 8 bits.
    ///
    /// # Errors
    /// An encoding outside [`readable_encodings`](super::encoding::readable_encodings), an empty or oversized image, a
    /// step shorter than a row, data that is not `height * step` long.
    pub fn of(image: &RawImage<'a>) -> Result<Self, ImageError> {
        Self::of_depth(image, Depth::FULL)
    }

    /// As [`RawPixels::of`], with 16-bit values scaled by the bits that their recording uses.
    ///
    /// # Errors
    /// Those of [`RawPixels::of`].
    pub fn of_depth(image: &RawImage<'a>, depth: Depth) -> Result<Self, ImageError> {
        let layout = layout_of(image.encoding)?;
        check_size(image.width, image.height)?;
        let (width, height) = (image.width, image.height);
        let rows = |row_bytes| image.rows(row_bytes);
        let one_channel = |bytes| match bytes {
            1 => rows(width).map(|rows| joined(image, &rows)),
            _ => rows(2 * width).map(|rows| narrowed(&rows, image.big_endian, depth).into()),
        };
        let (grey, rgb) = (png::ColorType::Grayscale, png::ColorType::Rgb);
        let (pixels, colour_type, bayer) = match layout {
            Layout::Grey { bytes } => (one_channel(bytes)?, grey, None),
            Layout::Mosaic { pattern, bytes } => (one_channel(bytes)?, grey, Some(pattern)),
            Layout::Colour { channels: 3, bytes: 1, rgb: [0, 1, 2] } => (joined(image, &rows(3 * width)?), rgb, None),
            Layout::Colour { channels, bytes: 1, rgb: order } => {
                (reordered(&rows(channels * width)?, channels, order).into(), rgb, None)
            }
            Layout::Colour { channels, rgb: order, .. } => {
                let values = narrowed(&rows(2 * channels * width)?, image.big_endian, depth);
                (reordered(&[&values], channels, order).into(), rgb, None)
            }
            Layout::Packed(packed) => (packed_rgb(&rows(4 * width.div_ceil(2))?, width, packed).into(), rgb, None),
            Layout::Planes(planes) => (planar_rgb(image, planes)?.into(), rgb, None),
        };
        Ok(Self { width, height, pixels, colour_type, bayer })
    }

    /// As a PNG file.
    ///
    /// # Errors
    /// Where the encoder fails.
    pub fn store(&self) -> Result<StoredImage, ImageError> {
        let bytes = png_codec::encode(&self.pixels, self.width, self.height, self.colour_type)?;
        Ok(StoredImage { bytes, width: self.width, height: self.height, bayer: self.bayer })
    }

    /// As grey: exactly what [`decode_grey`](crate::images::decode_grey) makes of the stored file.
    ///
    /// # Errors
    /// A mosaic too small to have colours.
    pub fn grey(&self, bayer: Option<BayerPattern>) -> Result<GreyImage, ImageError> {
        let pixels = match self.colour_type {
            png::ColorType::Grayscale => self.pixels[..self.width * self.height].to_vec(),
            _ => luma_of(&self.pixels),
        };
        let image = GreyImage { width: self.width, height: self.height, pixels };
        match bayer {
            None => Ok(image),
            Some(pattern) => Ok(grey_of(&demosaic(image, pattern)?)),
        }
    }
}

/// The rows end to end; borrowed where the message has no padding.
fn joined<'a>(image: &RawImage<'a>, rows: &[&'a [u8]]) -> Cow<'a, [u8]> {
    let unpadded = rows.first().is_some_and(|row| row.len() == image.step);
    if unpadded { Cow::Borrowed(image.data) } else { Cow::Owned(rows.concat()) }
}

/// Values of two bytes as one each.
fn narrowed(rows: &[&[u8]], big_endian: bool, depth: Depth) -> Vec<u8> {
    if depth == Depth::FULL {
        let top = usize::from(!big_endian);
        return rows.iter().flat_map(|row| row.as_chunks::<2>().0.iter().map(|value| value[top])).collect();
    }
    let value = if big_endian { u16::from_be_bytes } else { u16::from_le_bytes };
    rows.iter().flat_map(|row| row.as_chunks::<2>().0.iter().map(|bytes| depth.narrow(value(*bytes)))).collect()
}

fn reordered(rows: &[&[u8]], size: usize, rgb: [usize; 3]) -> Vec<u8> {
    match size {
        3 => reordered_of::<3>(rows, rgb),
        _ => reordered_of::<4>(rows, rgb),
    }
}

/// Red, green and blue of pixels of `SIZE` bytes.
fn reordered_of<const SIZE: usize>(rows: &[&[u8]], [r, g, b]: [usize; 3]) -> Vec<u8> {
    let row_bytes = rows.first().map_or(0, |row| row.len() / SIZE * 3);
    let mut pixels = vec![0; rows.len() * row_bytes];
    for (row, out) in rows.iter().zip(pixels.chunks_exact_mut(row_bytes.max(1))) {
        for (pixel, out) in row.as_chunks::<SIZE>().0.iter().zip(out.as_chunks_mut::<3>().0) {
            *out = [pixel[r], pixel[g], pixel[b]];
        }
    }
    pixels
}
