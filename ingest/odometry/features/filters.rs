//! Integer filters of the matching image: half resolution, 5x5 Sobel, and the blob and corner masks (Geiger et al.
//! 2011, Fig. 2).
//!
//! All of it is `u8` and `i16` arithmetic over whole rows, written so that the compiler vectorises each loop. The
//! results are integers, so they are equal on every machine.

use super::filter_rows::{ColumnSums, MASK_RADIUS};
use furrow_model::GreyImage;

/// The responses of all four masks over one image, row by row, `width` x `height` values each.
pub(crate) struct Responses {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 5x5 Sobel along the columns' direction (d/du), 128 = flat, saturating.
    pub sobel_u: Vec<u8>,
    /// 5x5 Sobel along the rows' direction (d/dv), 128 = flat, saturating.
    pub sobel_v: Vec<u8>,
    /// Blob mask: positive where the centre is brighter than its surroundings; at most 16 * 255.
    pub blob: Vec<i16>,
    /// Checkerboard (corner) mask; at most 8 * 255.
    pub corner: Vec<i16>,
}

/// Half the resolution: each pixel is the rounded mean of a 2x2 block, so its centre lies at (2u + 0.5, 2v + 0.5).
pub(crate) fn halve(image: &GreyImage) -> GreyImage {
    let (width, height) = (image.width / 2, image.height / 2);
    let mut pixels = vec![0; width * height];
    for (v, out) in pixels.chunks_exact_mut(width.max(1)).enumerate() {
        let (upper, lower) = (image.row(2 * v), image.row(2 * v + 1));
        for ((value, a), b) in out.iter_mut().zip(upper.chunks_exact(2)).zip(lower.chunks_exact(2)) {
            *value = ((u16::from(a[0]) + u16::from(a[1]) + u16::from(b[0]) + u16::from(b[1]) + 2) >> 2) as u8;
        }
    }
    GreyImage { width, height, pixels }
}

/// Applies the four masks to `image`. Pixels nearer to the border than [`MASK_RADIUS`] have no response.
pub(crate) fn apply_masks(image: &GreyImage) -> Responses {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        return unsafe { apply_masks_avx2(image) };
    }
    apply_masks_portable(image)
}

/// The same code, compiled for registers of twice the width.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn apply_masks_avx2(image: &GreyImage) -> Responses {
    apply_masks_portable(image)
}

#[inline(always)]
fn apply_masks_portable(image: &GreyImage) -> Responses {
    let (width, height) = (image.width, image.height);
    let area = width * height;
    let mut out = Responses {
        width,
        height,
        sobel_u: vec![128; area],
        sobel_v: vec![128; area],
        blob: vec![0; area],
        corner: vec![0; area],
    };
    if width <= 2 * MASK_RADIUS || height <= 2 * MASK_RADIUS {
        return out;
    }
    let mut columns = ColumnSums::new(width);
    for v in MASK_RADIUS..height - MASK_RADIUS {
        columns.gather(std::array::from_fn(|i| image.row(v + i - MASK_RADIUS)));
        let inner = v * width + MASK_RADIUS..(v + 1) * width - MASK_RADIUS;
        columns.sobel_u(&mut out.sobel_u[inner.clone()]);
        columns.sobel_v(&mut out.sobel_v[inner.clone()]);
        columns.blob(image.row(v), &mut out.blob[inner.clone()]);
        columns.corner(&mut out.corner[inner]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::noise_image;

    /// The masks as the paper prints them.
    const BLOB: [[i32; 5]; 5] =
        [[-1, -1, -1, -1, -1], [-1, 1, 1, 1, -1], [-1, 1, 8, 1, -1], [-1, 1, 1, 1, -1], [-1, -1, -1, -1, -1]];
    const CORNER: [[i32; 5]; 5] =
        [[-1, -1, 0, 1, 1], [-1, -1, 0, 1, 1], [0, 0, 0, 0, 0], [1, 1, 0, -1, -1], [1, 1, 0, -1, -1]];

    fn correlate(image: &GreyImage, mask: &[[i32; 5]; 5], u: usize, v: usize) -> i32 {
        let at = |i: usize, j: usize| i32::from(image.at(u + j - 2, v + i - 2)) * mask[i][j];
        (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).map(|(i, j)| at(i, j)).sum()
    }

    #[test]
    fn masks_equal_plain_correlation() {
        let image = noise_image(37, 21, 7);
        let found = apply_masks(&image);
        let smooth = [1, 4, 6, 4, 1];
        let slope = [-1, -2, 0, 2, 1];
        let sobel_u: [[i32; 5]; 5] = std::array::from_fn(|i| std::array::from_fn(|j| smooth[i] * slope[j]));
        let sobel_v: [[i32; 5]; 5] = std::array::from_fn(|i| std::array::from_fn(|j| slope[i] * smooth[j]));
        for v in 2..19 {
            for u in 2..35 {
                let i = v * 37 + u;
                assert_eq!(i32::from(found.blob[i]), correlate(&image, &BLOB, u, v));
                assert_eq!(i32::from(found.corner[i]), correlate(&image, &CORNER, u, v));
                let byte = |sum: i32| (sum.div_euclid(32) + 128).clamp(0, 255) as u8;
                assert_eq!(found.sobel_u[i], byte(correlate(&image, &sobel_u, u, v)));
                assert_eq!(found.sobel_v[i], byte(correlate(&image, &sobel_v, u, v)));
            }
        }
    }

    #[test]
    fn halving_takes_means() {
        let image = GreyImage::new(5, 3, vec![1, 2, 10, 10, 99, 3, 4, 10, 11, 99, 0, 0, 0, 0, 0]).unwrap();
        assert_eq!(halve(&image), GreyImage::new(2, 1, vec![3, 10]).unwrap());
    }

    #[test]
    fn images_smaller_than_a_mask_have_no_response() {
        for (width, height) in [(0, 0), (1, 9), (4, 4), (9, 1)] {
            let found = apply_masks(&noise_image(width, height, 1));
            assert!(found.blob.iter().chain(&found.corner).all(|&value| value == 0));
        }
    }
}
