//! `sensor_msgs/Image`: raw pixels, stored losslessly.

use crate::images::{BayerPattern, ImageError, StoredImage, header::check_size, png_codec};
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

/// Stores raw pixels as PNG: grey, or red-green-blue. A mosaic is stored as grey with its pattern kept beside, so that no colour is
/// invented in the archive. The alpha channel is dropped, and of 16-bit pixels only the upper 8 bits are kept: these two are the
/// losses. Equal pixels give equal bytes, whatever the step, and colour orders agree: an `rgb8` and a `bgr8` image of one scene are
/// the same object.
///
/// # Errors
/// An encoding outside [`readable_encodings`], an empty or oversized image, a step shorter than a row, data that is not
/// `height * step` long.
pub fn store_raw(image: &RawImage<'_>) -> Result<StoredImage, ImageError> {
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
    let bytes = png_codec::encode(&pixels, image.width, image.height, colour_type)?;
    Ok(StoredImage { bytes, width: image.width, height: image.height, bayer })
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

fn reordered(rows: &[&[u8]], size: usize, [r, g, b]: [usize; 3]) -> Vec<u8> {
    let mut pixels = Vec::with_capacity(rows.iter().map(|row| row.len() / size * 3).sum());
    for row in rows {
        pixels.extend(row.chunks_exact(size).flat_map(|pixel| [pixel[r], pixel[g], pixel[b]]));
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
