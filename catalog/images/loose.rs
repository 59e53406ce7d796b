//! Image files whose bytes are not kept as they are: PGM and PPM, and PNG of 16 bits. Their pixels are stored as those
//! of raw messages are.
//!
//! Netpbm: <https://netpbm.sourceforge.net/doc/pgm.html>, `P5` and `P6`. 16-bit values are big endian in both formats.

use super::encoding::is_deep_encoding;
use super::png_codec;
use super::raw_image::RawImage;
use crate::images::ImageError;
use crate::images::header::{check_size, inspect, is_deep_png, png_size};

/// The pixels of an image file that is not kept as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LoosePixels {
    width: usize,
    height: usize,
    encoding: &'static str,
    row_bytes: usize,
    data: Vec<u8>,
}

impl LoosePixels {
    /// The pixels of a file; `None` where its bytes are stored as they are, if they are an image at all.
    ///
    /// # Errors
    /// A file that is cut, damaged, too large, or of a variety of these formats that is not read.
    pub fn of_file(bytes: &[u8]) -> Result<Option<Self>, ImageError> {
        if is_deep_png(bytes) {
            let [width, height] = png_size(bytes);
            check_size(width, height)?;
            let decoded = png_codec::decode(bytes)?;
            return Self::of_png(bytes.len(), [width, height], decoded).map(Some);
        }
        Netpbm::read(bytes)?.map(|header| header.pixels(bytes)).transpose()
    }

    /// Columns and rows of an image file of any format that is read, by its header.
    ///
    /// # Errors
    /// As [`LoosePixels::of_file`] and [`inspect`].
    pub fn size_of_file(bytes: &[u8]) -> Result<(u32, u32), ImageError> {
        let (width, height) = match (is_deep_png(bytes), Netpbm::read(bytes)?) {
            (true, _) => png_size(bytes).into(),
            (false, Some(header)) => (header.width, header.height),
            (false, None) => inspect(bytes).map(|header| (header.width, header.height))?,
        };
        check_size(width, height)?;
        Ok((width as u32, height as u32))
    }

    /// Whether they have one channel.
    pub fn is_grey(&self) -> bool {
        matches!(self.encoding, "mono8" | "mono16")
    }

    /// Whether they have 16 bits, of which a camera may use only some.
    pub fn is_deep(&self) -> bool {
        is_deep_encoding(self.encoding)
    }

    /// As a raw message would bring them.
    pub fn as_raw(&self) -> RawImage<'_> {
        let Self { width, height, encoding, row_bytes, ref data } = *self;
        RawImage { width, height, step: row_bytes, encoding, big_endian: true, data }
    }

    fn of_png(length: usize, [width, height]: [usize; 2], decoded: png_codec::Decoded) -> Result<Self, ImageError> {
        let (values, channels) = (decoded.pixels, decoded.channels);
        if values.len() != width * height * channels * 2 {
            let fault = format!("its pixels do not fill {width} x {height}");
            return Err(ImageError::Damaged { format: "PNG", length, fault });
        }
        // Grey and alpha: the alpha is dropped here, since no raw message has such pixels.
        let (encoding, channels, data) = match channels {
            1 => ("mono16", 1, values),
            2 => ("mono16", 1, values.as_chunks::<4>().0.iter().flat_map(|pixel| [pixel[0], pixel[1]]).collect()),
            3 => ("rgb16", 3, values),
            _ => ("rgba16", 4, values),
        };
        Ok(Self { width, height, encoding, row_bytes: 2 * channels * width, data })
    }
}

/// What the header of a Netpbm file says.
#[derive(Debug, Clone, Copy)]
struct Netpbm {
    width: usize,
    height: usize,
    channels: usize,
    white: usize,
    /// Where its pixels begin.
    start: usize,
}

impl Netpbm {
    /// Reads the header; `None` where the file is of another format.
    fn read(bytes: &[u8]) -> Result<Option<Self>, ImageError> {
        let channels = match bytes {
            [b'P', b'5', next, ..] if next.is_ascii_whitespace() || *next == b'#' => 1,
            [b'P', b'6', next, ..] if next.is_ascii_whitespace() || *next == b'#' => 3,
            [b'P', kind @ b'1'..=b'7', next, ..] if next.is_ascii_whitespace() => {
                let found = format!("its kind is P{}", char::from(*kind));
                return Err(ImageError::Variety { format: "Netpbm file", found, expected: "P5 or P6" });
            }
            _ => return Ok(None),
        };
        let damaged = |fault: &str| {
            Err(ImageError::Damaged { format: "Netpbm file", length: bytes.len(), fault: fault.to_owned() })
        };
        let mut at = 2;
        let mut numbers = [0; 3];
        for number in &mut numbers {
            let Some(found) = next_number(bytes, &mut at) else {
                return damaged("its header is not width, height and white level");
            };
            *number = found;
        }
        let [width, height, white] = numbers;
        if !bytes.get(at).is_some_and(u8::is_ascii_whitespace) || !(1..=65_535).contains(&white) {
            return damaged("its header does not end with a white level of 1 to 65535 and a space");
        }
        check_size(width, height)?;
        Ok(Some(Self { width, height, channels, white, start: at + 1 }))
    }

    fn pixels(self, bytes: &[u8]) -> Result<LoosePixels, ImageError> {
        let Self { width, height, channels, white, start } = self;
        let value_bytes = if white > 255 { 2 } else { 1 };
        let row_bytes = width * channels * value_bytes;
        let (pixels, rest) = bytes[start..].split_at_checked(row_bytes * height).unwrap_or_default();
        if pixels.is_empty() || !rest.iter().all(u8::is_ascii_whitespace) {
            let fault = format!("expected {} bytes of pixels, found {}", row_bytes * height, bytes.len() - start);
            return Err(ImageError::Damaged { format: "Netpbm file", length: bytes.len(), fault });
        }
        let scaled = |value: &u8| ((usize::from(*value).min(white) * 255 + white / 2) / white) as u8;
        let data = if white < 255 { pixels.iter().map(scaled).collect() } else { pixels.to_vec() };
        let encoding = match (channels, value_bytes) {
            (1, 1) => "mono8",
            (1, _) => "mono16",
            (_, 1) => "rgb8",
            (_, _) => "rgb16",
        };
        Ok(LoosePixels { width, height, encoding, row_bytes, data })
    }
}

/// The next number of a header, behind spaces and comments.
fn next_number(bytes: &[u8], at: &mut usize) -> Option<usize> {
    loop {
        match bytes.get(*at)? {
            b'#' => *at += bytes[*at..].iter().position(|&byte| byte == b'\n')?,
            space if space.is_ascii_whitespace() => *at += 1,
            _ => break,
        }
    }
    let digits = bytes[*at..].iter().take(10).take_while(|byte| byte.is_ascii_digit()).count();
    let number = std::str::from_utf8(&bytes[*at..*at + digits]).ok()?.parse().ok()?;
    *at += digits;
    Some(number)
}
