//! What a JPEG or PNG says of itself, read from its markers without decoding.
//!
//! JPEG: ITU-T T.81, annex B. PNG: W3C PNG specification, section 11.2.1 (IHDR).

use crate::images::ImageError;

/// The longest side of an image that is read, in pixels.
pub const MAX_SIDE_PX: usize = 12_000;
/// The most pixels of an image that is read: a file that claims more is refused before memory is asked for.
pub const MAX_PIXELS: usize = 100_000_000;

const PNG_SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a];

/// The file formats that are kept as they were recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Baseline or progressive, 8 bit, grey or colour.
    Jpeg,
    /// 1 to 8 bit, grey, colour or palette.
    Png,
}

/// What an image file claims to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Its format.
    pub format: Format,
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// Whether it has colours.
    pub colour: bool,
}

/// Reads the header of a JPEG or PNG file, in the time of one pass over the bytes.
///
/// # Errors
/// Other formats, varieties that are not read (16 bit, CMYK, lossless or arithmetic JPEG), sizes beyond the limits, and
/// a JPEG without an end: the decoder would silently fill the missing part with grey.
pub fn inspect(bytes: &[u8]) -> Result<Header, ImageError> {
    let header = if bytes.starts_with(&[0xff, 0xd8]) {
        inspect_jpeg(bytes)?
    } else if bytes.starts_with(&PNG_SIGNATURE) {
        inspect_png(bytes)?
    } else {
        let first: Vec<String> = bytes.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        return Err(ImageError::UnknownFormat { length: bytes.len(), first: first.join(" ") });
    };
    check_size(header.width, header.height)?;
    Ok(header)
}

/// Refuses empty images and those beyond [`MAX_SIDE_PX`] or [`MAX_PIXELS`].
pub(crate) fn check_size(width: usize, height: usize) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Empty { width, height });
    }
    if width > MAX_SIDE_PX || height > MAX_SIDE_PX || width * height > MAX_PIXELS {
        return Err(ImageError::TooLarge { width, height });
    }
    Ok(())
}

/// Whether a file is a PNG of 16 bits per channel, which is not kept as it is.
pub(crate) fn is_deep_png(bytes: &[u8]) -> bool {
    bytes.starts_with(&PNG_SIGNATURE) && bytes.get(12..16) == Some(b"IHDR") && bytes.len() > 28 && bytes[24] == 16
}

/// Columns and rows of a PNG that is as long as its header.
pub(crate) fn png_size(bytes: &[u8]) -> [usize; 2] {
    [16, 20].map(|at| bytes[at..at + 4].iter().fold(0, |number, &byte| number << 8 | usize::from(byte)))
}

fn inspect_png(bytes: &[u8]) -> Result<Header, ImageError> {
    let damaged = |fault: &str| ImageError::Damaged { format: "PNG", length: bytes.len(), fault: fault.to_owned() };
    let Some(([chunk @ .., _compression, _filter, _interlace], _)) = bytes.split_first_chunk::<29>() else {
        return Err(damaged("it stops inside its header"));
    };
    if chunk[8..16] != *b"\0\0\0\x0dIHDR" {
        return Err(damaged("it does not begin with an IHDR chunk of 13 bytes"));
    }
    let number = |at: usize| u32::from_be_bytes([chunk[at], chunk[at + 1], chunk[at + 2], chunk[at + 3]]) as usize;
    let (depth, colour_type) = (chunk[24], chunk[25]);
    if !matches!(depth, 1 | 2 | 4 | 8) {
        return Err(ImageError::Variety {
            format: "PNG",
            found: format!("it has {depth} bits per channel"),
            expected: "at most 8",
        });
    }
    Ok(Header { format: Format::Png, width: number(16), height: number(20), colour: colour_type & 2 != 0 })
}

fn inspect_jpeg(bytes: &[u8]) -> Result<Header, ImageError> {
    let damaged = |fault: String| ImageError::Damaged { format: "JPEG", length: bytes.len(), fault };
    let cut = || damaged("it stops before its end marker: the recording was cut or bytes are lost".to_owned());
    let mut header = None;
    let mut at = 2;
    loop {
        let marker = match bytes.get(at..at + 2).ok_or_else(cut)? {
            [0xff, 0xff] => {
                at += 1;
                continue;
            }
            [0xff, marker] => *marker,
            _ => return Err(damaged(format!("no marker where one must be, at byte {at}"))),
        };
        at += 2;
        if marker == 0xd9 {
            return header.ok_or_else(|| damaged("it ends without a picture".to_owned()));
        }
        if matches!(marker, 0x01 | 0xd0..=0xd7) {
            continue;
        }
        let length = match bytes.get(at..at + 2).ok_or_else(cut)? {
            [high, low] => usize::from(u16::from_be_bytes([*high, *low])),
            _ => return Err(cut()),
        };
        let segment = bytes.get(at + 2..at + length.max(2)).ok_or_else(cut)?;
        at += length.max(2);
        match marker {
            0xc4 | 0xc8 | 0xcc => {}
            0xc0..=0xcf => header = Some(frame_header(marker, segment).ok_or_else(cut)??),
            0xda => at = end_of_scan(bytes, at).ok_or_else(cut)?,
            _ => {}
        }
    }
}

/// The frame header SOFn (T.81, B.2.2); `None` where it is too short.
fn frame_header(marker: u8, segment: &[u8]) -> Option<Result<Header, ImageError>> {
    let [depth, y1, y0, x1, x0, components, ..] = *segment else { return None };
    let refused = |found: String, expected| Err(ImageError::Variety { format: "JPEG", found, expected });
    Some(if marker > 0xc2 {
        refused(format!("its coding process is SOF{}", marker - 0xc0), "baseline or progressive (SOF0 to SOF2)")
    } else if depth != 8 {
        refused(format!("it has {depth} bits per channel"), "8")
    } else if !matches!(components, 1 | 3) {
        refused(format!("it has {components} channels"), "1 or 3")
    } else {
        let [width, height] = [[x1, x0], [y1, y0]].map(|pair| usize::from(u16::from_be_bytes(pair)));
        Ok(Header { format: Format::Jpeg, width, height, colour: components == 3 })
    })
}

/// The position of the first marker after the entropy-coded data that begins at `at`; `None` where there is none.
fn end_of_scan(bytes: &[u8], mut at: usize) -> Option<usize> {
    loop {
        at += bytes.get(at..)?.iter().position(|&byte| byte == 0xff)?;
        match bytes.get(at + 1)? {
            0x00 | 0xd0..=0xd7 => at += 2,
            0xff => at += 1,
            _ => return Some(at),
        }
    }
}
