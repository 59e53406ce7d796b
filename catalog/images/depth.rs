//! How much of 16-bit pixels a recording uses.

use super::encoding::{Layout, layout_of};
use super::raw_image::RawImage;

/// How many bits of its 16-bit pixels a recording uses, counted from the lowest: cameras of 10, 12 and 14 bits put
/// their values there as they are. Stored are 8 bits; all images of a recording are scaled alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Depth {
    bits: u32,
}

/// Values from here on need 16 bits.
const NEEDS_ALL: u16 = 1 << 14;

impl Depth {
    /// All 16 bits, of which the upper 8 are stored.
    pub const FULL: Self = Self { bits: 16 };

    /// The bits in use.
    pub fn bits(self) -> u32 {
        self.bits
    }

    /// The 8 bits that are stored of a pixel. A value above the range is white.
    pub(crate) fn narrow(self, value: u16) -> u8 {
        (value >> (self.bits - 8)).min(255) as u8
    }
}

/// The 16-bit pixels that were seen of a recording, to find out its depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SeenPixels {
    /// Every bit that was set anywhere.
    bits: u16,
}

impl SeenPixels {
    /// Adds an image, without its rows' padding; one that cannot be read, or has other pixels, adds nothing.
    pub fn add_image(&mut self, image: &RawImage<'_>) {
        let channels = match layout_of(image.encoding) {
            Ok(Layout::Grey { bytes: 2 } | Layout::Mosaic { bytes: 2, .. }) => 1,
            Ok(Layout::Colour { channels, bytes: 2, .. }) => channels,
            _ => return,
        };
        let row_bytes = image.width.checked_mul(2 * channels);
        for row in row_bytes.and_then(|row_bytes| image.rows(row_bytes).ok()).into_iter().flatten() {
            self.add(row, image.big_endian);
        }
    }

    /// Adds pixels of two bytes each.
    fn add(&mut self, pixels: &[u8], big_endian: bool) {
        let value = if big_endian { u16::from_be_bytes } else { u16::from_le_bytes };
        self.bits |= pixels.as_chunks::<2>().0.iter().fold(0, |bits, &pixel| bits | value(pixel));
    }

    /// Whether more pixels cannot change the depth any more.
    pub fn is_decided(self) -> bool {
        self.bits >= NEEDS_ALL
    }

    /// The least of 8, 10, 12, 14 and 16 bits that holds all that was seen. Pixels whose lower byte is always zero are
    /// 8-bit ones in the upper byte, however dark.
    pub fn depth(self) -> Depth {
        let in_upper_byte = self.bits & 0xff == 0;
        let used = u16::BITS - self.bits.leading_zeros();
        if in_upper_byte || self.is_decided() { Depth::FULL } else { Depth { bits: used.next_multiple_of(2).max(8) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth_of(values: &[u16]) -> u32 {
        let mut seen = SeenPixels::default();
        values.iter().for_each(|value| seen.add(&value.to_be_bytes(), true));
        let mut little = SeenPixels::default();
        little.add(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>(), false);
        assert_eq!(seen, little, "byte orders");
        seen.depth().bits()
    }

    #[test]
    fn the_brightest_pixel_tells_the_depth() {
        for bits in 1..=16_u32 {
            let brightest = ((1_u32 << bits) - 1) as u16;
            let expected = [8, 10, 12, 14, 16].into_iter().find(|depth| bits <= *depth);
            assert_eq!(Some(depth_of(&[0, 1, brightest / 2, brightest])), expected, "{bits} bits");
        }
        // Eight bits shifted up are the full range, in the dark too; shifted up by less, they are 10 or 12 bits.
        assert_eq!(depth_of(&[0x0100, 0x2f00]), 16);
        assert_eq!((depth_of(&[255 << 2]), depth_of(&[200 << 4])), (10, 12));
        assert_eq!(depth_of(&[]), 16);
    }

    #[test]
    fn narrow_keeps_the_order_and_never_wraps() {
        for bits in [8, 10, 12, 14, 16] {
            let depth = Depth { bits };
            let greys: Vec<u8> = (0..=u16::MAX).map(|value| depth.narrow(value)).collect();
            assert!(greys.is_sorted(), "{bits}");
            let white = ((1_u32 << bits) - 1) as usize;
            assert_eq!((greys[0], greys[white], greys[usize::from(u16::MAX)]), (0, 255, 255), "{bits}");
        }
        assert!((0..=u16::MAX).all(|value| Depth::FULL.narrow(value) == value.to_be_bytes()[0]));
    }
}
