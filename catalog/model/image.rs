//! Images: grey and colour pixels, row by row.

/// An 8-bit grey image, row by row without padding. Pixel (0, 0) is the top left one, and its *centre* has the
/// coordinates (0, 0).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GreyImage {
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// `height * width` values.
    pub pixels: Vec<u8>,
}

impl GreyImage {
    /// Takes `pixels` as an image of `width` x `height`; `None` where the count does not fit.
    pub fn new(width: usize, height: usize, pixels: Vec<u8>) -> Option<Self> {
        (width.checked_mul(height)? == pixels.len()).then_some(Self { width, height, pixels })
    }

    /// The value at column `x` and row `y`; both must lie inside.
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> u8 {
        self.pixels[y * self.width + x]
    }

    /// Row `y`.
    #[inline]
    pub fn row(&self, y: usize) -> &[u8] {
        &self.pixels[y * self.width..(y + 1) * self.width]
    }
}

/// An 8-bit colour image, row by row without padding; each pixel is red, green, blue.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColourImage {
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// `height * width * 3` values.
    pub rgb: Vec<u8>,
}
