//! PNG through the `png` crate: its output depends on the pixels alone, and no header makes it allocate or read out of
//! bounds.

use crate::images::{ImageError, header::MAX_PIXELS};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Limits, Transformations};
use std::io::Cursor;

/// Pixels of a decoded PNG: 1 (grey), 2 (grey, alpha), 3 or 4 (red, green, blue, alpha) bytes each.
pub(crate) struct Decoded {
    pub channels: usize,
    pub pixels: Vec<u8>,
}

/// Encodes 8-bit pixels, fast rather than small.
pub(crate) fn encode(pixels: &[u8], width: usize, height: usize, colour: ColorType) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::with_capacity(pixels.len() / 2 + 1024);
    write(&mut bytes, pixels, width, height, colour).map_err(|error| ImageError::Damaged {
        format: "PNG",
        length: pixels.len(),
        fault: format!("it could not be encoded: {error}"),
    })?;
    Ok(bytes)
}

fn write(
    bytes: &mut Vec<u8>,
    pixels: &[u8],
    width: usize,
    height: usize,
    colour: ColorType,
) -> Result<(), png::EncodingError> {
    // The callers have checked the size: both fit 32 bits.
    let mut encoder = Encoder::new(bytes, width as u32, height as u32);
    encoder.set_color(colour);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()
}

/// Decodes a PNG whose header has been inspected. Palettes and low bit depths are expanded to 8 bits.
pub(crate) fn decode(bytes: &[u8]) -> Result<Decoded, ImageError> {
    read(bytes).map_err(|error| ImageError::Damaged { format: "PNG", length: bytes.len(), fault: error.to_string() })
}

fn read(bytes: &[u8]) -> Result<Decoded, png::DecodingError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 4 * MAX_PIXELS });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or(png::DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut pixels)?;
    pixels.truncate(frame.buffer_size());
    Ok(Decoded { channels: frame.color_type.samples(), pixels })
}
