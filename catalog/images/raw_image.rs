//! A raw image as its message describes it.

use crate::images::ImageError;

/// A raw image as its message describes it. Nothing about it is trusted.
#[derive(Debug, Clone, Copy)]
pub struct RawImage<'a> {
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// Bytes from one row to the next.
    pub step: usize,
    /// As ROS names it; the names that are read are in [`readable_encodings`](super::encoding::readable_encodings).
    pub encoding: &'a str,
    /// The byte order of 16-bit pixels.
    pub big_endian: bool,
    /// `height * step` bytes; the last row's padding may be missing.
    pub data: &'a [u8],
}

impl<'a> RawImage<'a> {
    /// The rows of `row_bytes` each, without their padding.
    pub(crate) fn rows(&self, row_bytes: usize) -> Result<Vec<&'a [u8]>, ImageError> {
        let encoding = || self.encoding.to_owned();
        if self.step < row_bytes {
            return Err(ImageError::Step {
                encoding: encoding(),
                width: self.width,
                expected: row_bytes,
                found: self.step,
            });
        }
        let wrong_length = |expected| ImageError::Length {
            encoding: encoding(),
            width: self.width,
            height: self.height,
            step: self.step,
            expected,
            found: self.data.len(),
        };
        if self.step == 0 {
            return Err(wrong_length(0));
        }
        let expected = self.step.checked_mul(self.height).ok_or_else(|| wrong_length(usize::MAX))?;
        if self.data.len() > expected || self.data.len() < expected - self.step + row_bytes {
            return Err(wrong_length(expected));
        }
        Ok(self.data.chunks(self.step).map(|row| &row[..row_bytes]).collect())
    }
}
