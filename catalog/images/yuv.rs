//! Luma and colour differences into red, green and blue.
//!
//! ITU-R BT.601 over the full range, as JPEG has it (JFIF 1.02): no level of luma is clipped, so that the grey of a
//! pixel without colour is its luma. A camera that uses only 16 to 235 gives a flatter picture with the same features.

use super::encoding::{Packed, Planes};
use super::raw_image::RawImage;
use crate::images::ImageError;

/// Red, green and blue, in 16-bit fixed point.
fn rgb_of(luma: u8, u: u8, v: u8) -> [u8; 3] {
    let (y, u, v) = (i32::from(luma) << 16, i32::from(u) - 128, i32::from(v) - 128);
    let byte = |value: i32| ((value + (1 << 15)) >> 16).clamp(0, 255) as u8;
    [byte(y + 91_881 * v), byte(y - 22_554 * u - 46_802 * v), byte(y + 116_130 * u)]
}

/// Rows of pixel pairs. An odd last column is the first pixel of a pair.
pub(super) fn packed_rgb(rows: &[&[u8]], width: usize, packed: Packed) -> Vec<u8> {
    let mut rgb = Vec::with_capacity(rows.len() * width * 3);
    for row in rows {
        for column in 0..width {
            let pair = &row[column / 2 * 4..];
            rgb.extend(rgb_of(pair[packed.luma[column % 2]], pair[packed.u], pair[packed.v]));
        }
    }
    rgb
}

/// A plane in a message: where it begins, and its bytes from row to row.
#[derive(Debug, Clone, Copy)]
struct Plane {
    start: usize,
    stride: usize,
}

/// The planes of a message, whose size has been checked, into pixels.
///
/// # Errors
/// Rows shorter than their pixels, and data that are neither planes end to end nor planes with rows of the message's
/// step.
pub(super) fn planar_rgb(image: &RawImage<'_>, planes: Planes) -> Result<Vec<u8>, ImageError> {
    let (width, height) = (image.width, image.height);
    let encoding = || image.encoding.to_owned();
    if image.step < width {
        return Err(ImageError::Step { encoding: encoding(), width, expected: width, found: image.step });
    }
    let colours = [width.div_ceil(planes.shared[0]), height.div_ceil(planes.shared[1])];
    // One plane with two bytes a colour, or two planes with one.
    let row_bytes = if planes.interleaved { 2 * colours[0] } else { colours[0] };
    let rows = if planes.interleaved { colours[1] } else { 2 * colours[1] };
    let padded_row = if planes.interleaved {
        image.step.saturating_mul(2) / planes.shared[0]
    } else {
        image.step / planes.shared[0]
    };
    let end_to_end = width * height + row_bytes * rows;
    let length = |row: usize| image.step.checked_mul(height)?.checked_add(row.checked_mul(rows)?);
    let (step, colour_step) = match image.data.len() {
        found if found == end_to_end => (width, row_bytes),
        found if padded_row >= row_bytes && length(padded_row) == Some(found) => (image.step, padded_row),
        found => {
            let expected = end_to_end;
            return Err(ImageError::Length { encoding: encoding(), width, height, step: image.step, expected, found });
        }
    };
    let first = Plane { start: step * height, stride: colour_step };
    let second = if planes.interleaved {
        Plane { start: first.start + 1, ..first }
    } else {
        Plane { start: first.start + colour_step * colours[1], ..first }
    };
    let [u, v] = if planes.u_first { [first, second] } else { [second, first] };
    let pixel_bytes = if planes.interleaved { 2 } else { 1 };
    let mut rgb = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        for x in 0..width {
            let colour = |plane: Plane| {
                let at = plane.start + y / planes.shared[1] * plane.stride + x / planes.shared[0] * pixel_bytes;
                image.data[at]
            };
            rgb.extend(rgb_of(image.data[y * step + x], colour(u), colour(v)));
        }
    }
    Ok(rgb)
}
