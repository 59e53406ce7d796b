//! Images as they were recorded.

use super::cursor::{Cursor, MessageError};
use super::header::Header;
use crate::recording::Encoding;

/// `sensor_msgs/Image`: raw pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// Rows.
    pub height: u32,
    /// Columns.
    pub width: u32,
    /// The pixel format's name, as `mono8`, `bgr8`, `bayer_rggb8`.
    pub encoding: &'a str,
    /// Whether pixels of several bytes are big endian.
    pub is_bigendian: bool,
    /// Bytes from one row to the next.
    pub step: u32,
    /// The bytes as they came; [`Image::rows`] checks their length.
    pub data: &'a [u8],
}

impl<'a> Image<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "sensor_msgs/Image";

    /// Decodes a message; pixels stay where they are.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        Ok(Self {
            header: Header::read(&mut cursor, encoding)?,
            height: cursor.u32("height")?,
            width: cursor.u32("width")?,
            encoding: cursor.text("encoding")?,
            is_bigendian: cursor.u8("is_bigendian")? != 0,
            step: cursor.u32("step")?,
            data: cursor.byte_list("data")?,
        })
    }

    /// The rows, `height * step` bytes; an error where the message has fewer.
    pub fn rows(&self) -> Result<&'a [u8], MessageError> {
        let wanted = u64::from(self.height) * u64::from(self.step);
        let rows = usize::try_from(wanted).ok().and_then(|wanted| self.data.get(..wanted));
        rows.ok_or_else(|| MessageError::Value {
            message: Self::TYPE,
            field: "data",
            found: format!("{} bytes", self.data.len()),
            expected: "height * step bytes",
        })
    }
}

/// `sensor_msgs/CompressedImage`: a JPEG or PNG file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CompressedImage<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// What the publisher says of it, as `jpeg` or `bgr8; jpeg compressed bgr8`.
    pub format: &'a str,
    /// The file's bytes.
    pub data: &'a [u8],
}

impl<'a> CompressedImage<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "sensor_msgs/CompressedImage";

    /// Decodes a message; the file's bytes stay where they are.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        Ok(Self {
            header: Header::read(&mut cursor, encoding)?,
            format: cursor.text("format")?,
            data: cursor.byte_list("data")?,
        })
    }
}
