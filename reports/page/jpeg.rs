//! JPEG images inside a page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// An image as a `data:` address, and its size in pixels.
pub(super) struct Embedded {
    pub width: u32,
    pub height: u32,
    pub uri: String,
}

impl Embedded {
    /// `None` for bytes that are not a JPEG file with a size.
    pub fn of(jpeg: &[u8]) -> Option<Self> {
        let (width, height) = size(jpeg)?;
        Some(Self { width, height, uri: format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)) })
    }
}

/// Width and height in pixels, from the frame header (ITU-T T.81, B.2.2); `None` for bytes without one.
fn size(bytes: &[u8]) -> Option<(u32, u32)> {
    let mut rest = bytes.strip_prefix(&[0xff, 0xd8])?;
    loop {
        rest = rest.strip_prefix(&[0xff])?;
        let (&marker, after) = rest.split_first()?;
        match marker {
            0xff => continue,
            0x01 | 0xd0..=0xd8 => rest = after,
            _ => {
                let length = usize::from(u16::from_be_bytes([*after.first()?, *after.get(1)?]));
                let segment = after.get(2..length)?;
                let frame_header = matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc);
                if frame_header {
                    let pair = |i: usize| Some(u32::from(u16::from_be_bytes([*segment.get(i)?, *segment.get(i + 1)?])));
                    return pair(3).zip(pair(1)).filter(|(width, height)| *width > 0 && *height > 0);
                }
                rest = after.get(length..)?;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_header_is_found_behind_other_segments() {
        // SOI, APP0 of 4 bytes, fill byte, SOF2 with precision 8, height 360, width 640.
        let file = [0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xff, 0xc2, 0, 8, 8, 1, 0x68, 2, 0x80, 1];
        assert_eq!(size(&file), Some((640, 360)));
        for cut in 0..file.len() - 1 {
            assert_eq!(size(&file[..cut]), None, "{cut}");
        }
        assert_eq!(size(b"\x89PNG\r\n"), None);
    }
}
