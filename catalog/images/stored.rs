//! Images in the form in which they are stored.

use serde::{Deserialize, Serialize};

/// The colours of a Bayer mosaic's top left 2x2 pixels, by rows, as ROS names them (`bayer_rggb8` and so on).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BayerPattern {
    /// Red, green / green, blue.
    Rggb,
    /// Blue, green / green, red.
    Bggr,
    /// Green, blue / red, green.
    Gbrg,
    /// Green, red / blue, green.
    Grbg,
}

/// An image in the form in which it is stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredImage {
    /// A complete JPEG or PNG file.
    pub bytes: Vec<u8>,
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// Set where `bytes` is the grey picture of a mosaic: pass it to [`decode_grey`](crate::images::decode_grey) and
    /// [`decode_colour`](crate::images::decode_colour).
    pub bayer: Option<BayerPattern>,
}
