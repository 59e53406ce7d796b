//! The names of raw pixel formats, and where a pixel's parts lie in its bytes.

use crate::images::{BayerPattern, ImageError};

/// How the bytes of a raw image become those that are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// One channel of so many bytes.
    Grey { bytes: usize },
    /// One channel of so many bytes behind a mosaic of colour filters.
    Mosaic { pattern: BayerPattern, bytes: usize },
    /// `channels` values of so many bytes; which of them are red, green and blue.
    Colour { channels: usize, bytes: usize, rgb: [usize; 3] },
    /// Two pixels in four bytes, with one pair of colour differences.
    Packed(Packed),
    /// A plane of luma, then colour differences.
    Planes(Planes),
}

/// Where luma and colour differences stand in the four bytes of two pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Packed {
    pub luma: [usize; 2],
    pub u: usize,
    pub v: usize,
}

/// How the colour differences follow the plane of luma.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Planes {
    /// U and V alternate in one plane; else they have a plane each.
    pub interleaved: bool,
    /// Whether U comes before V.
    pub u_first: bool,
    /// How many columns, and how many rows, share a colour.
    pub shared: [usize; 2],
}

const fn grey(bytes: usize) -> Layout {
    Layout::Grey { bytes }
}

const fn mosaic(pattern: BayerPattern, bytes: usize) -> Layout {
    Layout::Mosaic { pattern, bytes }
}

const fn colour(channels: usize, bytes: usize, rgb: [usize; 3]) -> Layout {
    Layout::Colour { channels, bytes, rgb }
}

const fn planes(interleaved: bool, u_first: bool, shared: [usize; 2]) -> Layout {
    Layout::Planes(Planes { interleaved, u_first, shared })
}

const RGB: [usize; 3] = [0, 1, 2];
const BGR: [usize; 3] = [2, 1, 0];
const UYVY: Layout = Layout::Packed(Packed { luma: [1, 3], u: 0, v: 2 });
const YUYV: Layout = Layout::Packed(Packed { luma: [0, 2], u: 1, v: 3 });

/// ROS encodings and their layouts. Those that name only a number of channels (`8UC3`, `16UC4`) are blue first, as
/// `cv_bridge` has them; `yuv422` is UYVY, as `sensor_msgs` says. The planar names are those of drivers of video.
const LAYOUTS: [(&str, Layout); 38] = [
    ("mono8", grey(1)),
    ("8UC1", grey(1)),
    ("mono16", grey(2)),
    ("16UC1", grey(2)),
    ("rgb8", colour(3, 1, RGB)),
    ("bgr8", colour(3, 1, BGR)),
    ("8UC3", colour(3, 1, BGR)),
    ("rgba8", colour(4, 1, RGB)),
    ("bgra8", colour(4, 1, BGR)),
    ("8UC4", colour(4, 1, BGR)),
    ("rgb16", colour(3, 2, RGB)),
    ("bgr16", colour(3, 2, BGR)),
    ("16UC3", colour(3, 2, BGR)),
    ("rgba16", colour(4, 2, RGB)),
    ("bgra16", colour(4, 2, BGR)),
    ("16UC4", colour(4, 2, BGR)),
    ("bayer_rggb8", mosaic(BayerPattern::Rggb, 1)),
    ("bayer_bggr8", mosaic(BayerPattern::Bggr, 1)),
    ("bayer_gbrg8", mosaic(BayerPattern::Gbrg, 1)),
    ("bayer_grbg8", mosaic(BayerPattern::Grbg, 1)),
    ("bayer_rggb16", mosaic(BayerPattern::Rggb, 2)),
    ("bayer_bggr16", mosaic(BayerPattern::Bggr, 2)),
    ("bayer_gbrg16", mosaic(BayerPattern::Gbrg, 2)),
    ("bayer_grbg16", mosaic(BayerPattern::Grbg, 2)),
    ("yuv422", UYVY),
    ("uyvy", UYVY),
    ("yuv422_yuy2", YUYV),
    ("yuyv", YUYV),
    ("yuy2", YUYV),
    ("nv12", planes(true, true, [2, 2])),
    ("nv21", planes(true, false, [2, 2])),
    ("nv16", planes(true, true, [2, 1])),
    ("nv24", planes(true, true, [1, 1])),
    ("i420", planes(false, true, [2, 2])),
    ("yuv420", planes(false, true, [2, 2])),
    ("yuv420p", planes(false, true, [2, 2])),
    ("iyuv", planes(false, true, [2, 2])),
    ("yv12", planes(false, false, [2, 2])),
];

/// The encodings that [`store_raw`](crate::images::store_raw) reads.
pub fn readable_encodings() -> impl Iterator<Item = &'static str> {
    LAYOUTS.iter().map(|(name, _)| *name)
}

/// The layout of an encoding.
pub(crate) fn layout_of(encoding: &str) -> Result<Layout, ImageError> {
    LAYOUTS.iter().find(|(name, _)| *name == encoding).map(|(_, layout)| *layout).ok_or_else(|| ImageError::Encoding {
        encoding: encoding.to_owned(),
        readable: readable_encodings().collect::<Vec<_>>().join(", "),
    })
}

/// The mosaic of an encoding; `None` where it is none, or no encoding that is read.
pub fn mosaic_of_encoding(encoding: &str) -> Option<BayerPattern> {
    match layout_of(encoding) {
        Ok(Layout::Mosaic { pattern, .. }) => Some(pattern),
        _ => None,
    }
}

/// Whether an encoding has two bytes for each value, of which a camera may use only some.
pub fn is_deep_encoding(encoding: &str) -> bool {
    use Layout::{Colour, Grey, Mosaic};
    matches!(layout_of(encoding), Ok(Grey { bytes: 2 } | Mosaic { bytes: 2, .. } | Colour { bytes: 2, .. }))
}
