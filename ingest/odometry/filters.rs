//! Integer filters of the matching image: half resolution, 5x5 Sobel, and the blob and corner masks of Geiger et al. 2011, Fig 2.
//!
//! All of it is `u8` and `i16` arithmetic over whole rows, written so that the compiler turns each loop into vector code; being
//! integers, the results are the same on every machine.

use furrow_model::GreyImage;

/// Pixels at the image's rim where a 5x5 mask does not fit; the responses there are zero.
pub(crate) const MASK_RADIUS: usize = 2;

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

/// Runs the four masks over `image`. Each is the sum of products of a vertical and a horizontal profile, so one pass down the
/// columns and one along the row do.
pub(crate) fn respond(image: &GreyImage) -> Responses {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        return unsafe { respond_avx2(image) };
    }
    respond_anywhere(image)
}

/// The same with twice as many values at a time.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn respond_avx2(image: &GreyImage) -> Responses {
    respond_anywhere(image)
}

#[inline(always)]
fn respond_anywhere(image: &GreyImage) -> Responses {
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

/// The five vertical profiles of one row.
struct ColumnSums {
    smooth: Vec<i16>,
    slope: Vec<i16>,
    five: Vec<i16>,
    three: Vec<i16>,
    sign: Vec<i16>,
}

impl ColumnSums {
    fn new(width: usize) -> Self {
        let row = || vec![0; width];
        Self { smooth: row(), slope: row(), five: row(), three: row(), sign: row() }
    }

    #[inline(always)]
    fn gather(&mut self, rows: [&[u8]; 5]) {
        let width = self.smooth.len();
        let [a, b, c, d, e] = rows.map(|row| &row[..width]);
        let (smooth, slope) = (&mut self.smooth[..width], &mut self.slope[..width]);
        for u in 0..width {
            let (a, b, c, d, e) = (i16::from(a[u]), i16::from(b[u]), i16::from(c[u]), i16::from(d[u]), i16::from(e[u]));
            smooth[u] = a + e + 4 * (b + d) + 6 * c;
            slope[u] = (e - a) + 2 * (d - b);
        }
        let (five, three, sign) = (&mut self.five[..width], &mut self.three[..width], &mut self.sign[..width]);
        for u in 0..width {
            let (a, b, c, d, e) = (i16::from(a[u]), i16::from(b[u]), i16::from(c[u]), i16::from(d[u]), i16::from(e[u]));
            three[u] = b + c + d;
            five[u] = a + b + c + d + e;
            sign[u] = (a + b) - (d + e);
        }
    }

    #[inline(always)]
    fn sobel_u(&self, out: &mut [u8]) {
        let [a, b, _, d, e] = taps(&self.smooth, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = to_byte((e[u] - a[u]) + 2 * (d[u] - b[u]));
        }
    }

    #[inline(always)]
    fn sobel_v(&self, out: &mut [u8]) {
        let [a, b, c, d, e] = taps(&self.slope, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = to_byte(a[u] + e[u] + 4 * (b[u] + d[u]) + 6 * c[u]);
        }
    }

    /// -1 over 5x5, +1 over the inner 3x3, 8 in the middle: -five + 2 three + 7 centre.
    #[inline(always)]
    fn blob(&self, centre: &[u8], out: &mut [i16]) {
        let [a, b, c, d, e] = taps(&self.five, out.len());
        let [_, f, g, h, _] = taps(&self.three, out.len());
        let centre = &centre[MASK_RADIUS..MASK_RADIUS + out.len()];
        for (u, value) in out.iter_mut().enumerate() {
            *value = 2 * (f[u] + g[u] + h[u]) + 7 * i16::from(centre[u]) - (a[u] + b[u] + c[u] + d[u] + e[u]);
        }
    }

    #[inline(always)]
    fn corner(&self, out: &mut [i16]) {
        let [a, b, _, d, e] = taps(&self.sign, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = (d[u] + e[u]) - (a[u] + b[u]);
        }
    }
}

/// The five shifted views of a row of profiles that a horizontal mask of `len` outputs reads.
#[inline(always)]
fn taps(row: &[i16], len: usize) -> [&[i16]; 5] {
    std::array::from_fn(|i| &row[i..i + len])
}

/// A Sobel sum (at most 48 * 255 in magnitude) as a byte around 128. An edge of 85 grey levels saturates: weaker gradients, which
/// are most of the texture, keep their resolution.
#[inline(always)]
fn to_byte(sum: i16) -> u8 {
    ((sum >> SOBEL_SHIFT) + 128).clamp(0, 255) as u8
}

const SOBEL_SHIFT: i16 = 5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_images::noise;

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
        let image = noise(37, 21, 7);
        let found = respond(&image);
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
            let found = respond(&noise(width, height, 1));
            assert!(found.blob.iter().chain(&found.corner).all(|&value| value == 0));
        }
    }
}
