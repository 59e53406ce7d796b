//! `sensor_msgs/Image`: raw pixels, stored losslessly.

use crate::images::decode::{demosaic, grey_of, luma_of};
use crate::images::{BayerPattern, ImageError, StoredImage, header::check_size, png_codec};
use furrow_model::GreyImage;
use std::borrow::Cow;

/// A raw image as its message describes it. Nothing about it is trusted.
#[derive(Debug, Clone, Copy)]
pub struct RawImage<'a> {
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// Bytes from one row to the next.
    pub step: usize,
    /// As ROS names it; the names that are read are in [`readable_encodings`].
    pub encoding: &'a str,
    /// The byte order of 16-bit pixels.
    pub big_endian: bool,
    /// `height * step` bytes; the last row's padding may be missing.
    pub data: &'a [u8],
}

/// How the bytes of a pixel become those that are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    Grey,
    Mosaic(BayerPattern),
    /// The upper 8 bits of 16.
    GreyTop,
    /// Offsets of red, green and blue in a pixel of `size` bytes.
    Colour {
        size: usize,
        rgb: [usize; 3],
    },
}

const RGB: Layout = Layout::Colour { size: 3, rgb: [0, 1, 2] };
const BGR: Layout = Layout::Colour { size: 3, rgb: [2, 1, 0] };
const RGBA: Layout = Layout::Colour { size: 4, rgb: [0, 1, 2] };
const BGRA: Layout = Layout::Colour { size: 4, rgb: [2, 1, 0] };

/// ROS encodings and their layouts. `8UC3` and `8UC4` are blue first, as `cv_bridge` has them.
const LAYOUTS: [(&str, Layout); 14] = [
    ("mono8", Layout::Grey),
    ("8UC1", Layout::Grey),
    ("mono16", Layout::GreyTop),
    ("16UC1", Layout::GreyTop),
    ("rgb8", RGB),
    ("bgr8", BGR),
    ("8UC3", BGR),
    ("rgba8", RGBA),
    ("bgra8", BGRA),
    ("8UC4", BGRA),
    ("bayer_rggb8", Layout::Mosaic(BayerPattern::Rggb)),
    ("bayer_bggr8", Layout::Mosaic(BayerPattern::Bggr)),
    ("bayer_gbrg8", Layout::Mosaic(BayerPattern::Gbrg)),
    ("bayer_grbg8", Layout::Mosaic(BayerPattern::Grbg)),
];

/// The encodings that [`store_raw`] reads.
pub fn readable_encodings() -> impl Iterator<Item = &'static str> {
    LAYOUTS.iter().map(|(name, _)| *name)
}

/// Stores raw pixels as PNG; see [`RawPixels`].
///
/// # Errors
/// Those of [`RawPixels::of`].
pub fn store_raw(image: &RawImage<'_>) -> Result<StoredImage, ImageError> {
    RawPixels::of(image)?.store()
}

/// The pixels of a raw image as they are stored: grey, or red-green-blue. A mosaic is stored as grey with its pattern
/// kept beside, so that no colour is invented in the archive. The alpha channel is dropped, and of 16-bit pixels only
/// the upper 8 bits are kept: these two are the losses. Equal pixels give equal bytes, whatever the step, and colour
/// orders agree: an `rgb8` and a `bgr8` image of one scene are the same object.
pub struct RawPixels<'a> {
    width: usize,
    height: usize,
    pixels: Cow<'a, [u8]>,
    colour_type: png::ColorType,
    bayer: Option<BayerPattern>,
}

impl<'a> RawPixels<'a> {
    /// Checks and arranges what a message brought.
    ///
    /// # Errors
    /// An encoding outside [`readable_encodings`], an empty or oversized image, a step shorter than a row, data that is
    /// not `height * step` long.
    pub fn of(image: &RawImage<'a>) -> Result<Self, ImageError> {
        let layout = layout_of(image.encoding)?;
        check_size(image.width, image.height)?;
        let rows = checked_rows(image, layout)?;
        let (pixels, colour_type, bayer) = match layout {
            Layout::Grey => (joined(image, &rows), png::ColorType::Grayscale, None),
            Layout::Mosaic(pattern) => (joined(image, &rows), png::ColorType::Grayscale, Some(pattern)),
            Layout::GreyTop => (top_bytes(&rows, image.big_endian).into(), png::ColorType::Grayscale, None),
            RGB => (joined(image, &rows), png::ColorType::Rgb, None),
            Layout::Colour { size, rgb } => (reordered(&rows, size, rgb).into(), png::ColorType::Rgb, None),
        };
        Ok(Self { width: image.width, height: image.height, pixels, colour_type, bayer })
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

fn top_bytes(rows: &[&[u8]], big_endian: bool) -> Vec<u8> {
    let top = usize::from(!big_endian);
    rows.iter().flat_map(|row| row.chunks_exact(2).map(|pixel| pixel[top])).collect()
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

fn layout_of(encoding: &str) -> Result<Layout, ImageError> {
    LAYOUTS.iter().find(|(name, _)| *name == encoding).map(|(_, layout)| *layout).ok_or_else(|| ImageError::Encoding {
        encoding: encoding.to_owned(),
        readable: readable_encodings().collect::<Vec<_>>().join(", "),
    })
}

/// The rows without their padding.
fn checked_rows<'a>(image: &RawImage<'a>, layout: Layout) -> Result<Vec<&'a [u8]>, ImageError> {
    let pixel_bytes = match layout {
        Layout::Grey | Layout::Mosaic(_) => 1,
        Layout::GreyTop => 2,
        Layout::Colour { size, .. } => size,
    };
    let row_bytes = image.width * pixel_bytes;
    let encoding = || image.encoding.to_owned();
    if image.step < row_bytes {
        return Err(ImageError::Step {
            encoding: encoding(),
            width: image.width,
            expected: row_bytes,
            found: image.step,
        });
    }
    let wrong_length = |expected| ImageError::Length {
        encoding: encoding(),
        width: image.width,
        height: image.height,
        step: image.step,
        expected,
        found: image.data.len(),
    };
    let expected = image.step.checked_mul(image.height).ok_or_else(|| wrong_length(usize::MAX))?;
    if image.data.len() > expected || image.data.len() < expected - image.step + row_bytes {
        return Err(wrong_length(expected));
    }
    Ok(image.data.chunks(image.step).map(|row| &row[..row_bytes]).collect())
}
