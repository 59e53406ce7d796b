//! Scales of an image: Gaussian blurs of growing width, their differences, and the base below.

use furrow_model::widest;

/// Blurs, and so bands.
pub const BANDS: usize = 4;
/// Standard deviation of the first blur in pixels of an image 640 wide; each is twice the one before.
const FIRST_SIGMA: f64 = 1.2;
const REFERENCE_WIDTH: f64 = 640.0;
/// Columns worked on at once.
const BLOCK: usize = 32;

/// Standard deviation of blur `k` in an image of `width` columns, in pixels.
pub fn sigma_px(k: usize, width: usize) -> f64 {
    FIRST_SIGMA * f64::from(1_u32 << k) * width as f64 / REFERENCE_WIDTH
}

/// The right half of a Gaussian kernel, the middle first; all of it sums to 1.
fn kernel(sigma_px: f64) -> Vec<f32> {
    let radius = (2.6 * sigma_px).ceil().max(1.0) as usize;
    let value = |i: usize| libm::exp(-0.5 * (i as f64 / sigma_px) * (i as f64 / sigma_px));
    let sum = value(0) + 2.0 * (1..=radius).map(value).sum::<f64>();
    (0..=radius).map(|i| (value(i) / sum) as f32).collect()
}

/// Blurs planes of one size; its memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Blur {
    padded: Vec<f32>,
    across: Vec<f32>,
}

impl Blur {
    /// `target` becomes `source` blurred by a Gaussian; beyond the edge, the outermost pixels go on.
    pub fn blur(&mut self, source: &[f32], width: usize, sigma_px: f64, target: &mut Vec<f32>) {
        let kernel = kernel(sigma_px);
        let radius = kernel.len() - 1;
        self.across.resize(source.len(), 0.0);
        self.padded.resize(width + 2 * radius + BLOCK, 0.0);
        for (row, across) in source.chunks_exact(width).zip(self.across.chunks_exact_mut(width)) {
            self.padded[..radius].fill(row[0]);
            self.padded[radius..radius + width].copy_from_slice(row);
            self.padded[radius + width..].fill(row[width - 1]);
            blur_row(&kernel, &self.padded, across);
        }
        target.resize(source.len(), 0.0);
        blur_columns(&kernel, &self.across, width, target);
    }
}

widest!(fn blur_row(kernel: &[f32], padded: &[f32], across: &mut [f32]) -> () = blur_row_anywhere);

/// `padded` has as many values before and after the row as the kernel reaches, and a block more.
#[inline(always)]
fn blur_row_anywhere(kernel: &[f32], padded: &[f32], across: &mut [f32]) {
    let radius = kernel.len() - 1;
    for (block, across) in across.chunks_mut(BLOCK).enumerate() {
        let first = block * BLOCK;
        let mut sums = [0.0_f32; BLOCK];
        let middle = &padded[first + radius..first + radius + BLOCK];
        for (sum, value) in sums.iter_mut().zip(middle) {
            *sum = kernel[0] * value;
        }
        for (i, weight) in kernel.iter().enumerate().skip(1) {
            let left = &padded[first + radius - i..first + radius - i + BLOCK];
            let right = &padded[first + radius + i..first + radius + i + BLOCK];
            for ((sum, left), right) in sums.iter_mut().zip(left).zip(right) {
                *sum += weight * (left + right);
            }
        }
        across.copy_from_slice(&sums[..across.len()]);
    }
}

widest!(fn blur_columns(kernel: &[f32], source: &[f32], width: usize, target: &mut [f32]) -> () = blur_columns_anywhere);

#[inline(always)]
fn blur_columns_anywhere(kernel: &[f32], source: &[f32], width: usize, target: &mut [f32]) {
    let last = source.len() / width - 1;
    // Stretch by stretch of columns, so that all rows under the kernel stay in the nearest memory.
    for first in (0..width).step_by(BLOCK) {
        let columns = BLOCK.min(width - first);
        for (y, target) in target.chunks_exact_mut(width).enumerate() {
            let of = |row: usize| &source[row * width + first..row * width + first + columns];
            let mut sums = [0.0_f32; BLOCK];
            for (sum, value) in sums.iter_mut().zip(of(y)) {
                *sum = kernel[0] * value;
            }
            for (i, weight) in kernel.iter().enumerate().skip(1) {
                let (above, below) = (of(y.saturating_sub(i)), of((y + i).min(last)));
                for ((sum, above), below) in sums.iter_mut().zip(above).zip(below) {
                    *sum += weight * (above + below);
                }
            }
            target[first..first + columns].copy_from_slice(&sums[..columns]);
        }
    }
}

/// From this blur on, every second pixel says all there is.
const COARSE: usize = 2;
/// What halving and doubling add to a blur's variance, in squared pixels: a mean of two, 1/4, and weights of 3/4 and
/// 1/4, 3/4.
const HALVING_PX2: f64 = 1.0;

/// The blurs of a plane: `blurs[k]` has the width of [`sigma_px`]. Each is made from the one before, since Gaussians
/// add by their squares; the wide ones at half the resolution.
#[derive(Debug, Default)]
pub(crate) struct Pyramid {
    pub blurs: [Vec<f32>; BANDS],
    blur: Blur,
    half: [Vec<f32>; 2],
}

impl Pyramid {
    /// Blurs `plane`.
    pub fn of(&mut self, plane: &[f32], width: usize) {
        let mut before_px2 = 0.0;
        for k in 0..COARSE {
            let sigma_px2 = sigma_px(k, width).powi(2);
            let (done, rest) = self.blurs.split_at_mut(k);
            let source = done.last().map_or(plane, |blurred| blurred.as_slice());
            self.blur.blur(source, width, (sigma_px2 - before_px2).sqrt(), &mut rest[0]);
            before_px2 = sigma_px2;
        }
        let [half, blurred] = &mut self.half;
        halve(&self.blurs[COARSE - 1], width, half);
        before_px2 += HALVING_PX2;
        for k in COARSE..BANDS {
            let sigma_px2 = sigma_px(k, width).powi(2);
            // Images so small that halving alone blurs more: a kernel of next to no width.
            let more_px2 = ((sigma_px2 - before_px2) / 4.0).max(1e-4);
            self.blur.blur(half, width.div_ceil(2), more_px2.sqrt(), blurred);
            self.blurs[k].resize(plane.len(), 0.0);
            double(blurred, width, &mut self.blurs[k]);
            std::mem::swap(half, blurred);
            before_px2 = sigma_px2;
        }
    }
}

/// The means of 2 x 2 pixels; the last column and row count twice where they have no partner.
fn halve(plane: &[f32], width: usize, half: &mut Vec<f32>) {
    half.clear();
    for rows in plane.chunks(2 * width) {
        let (above, below) = rows.split_at(width);
        let below = if below.is_empty() { above } else { below };
        let pairs = above.chunks(2).zip(below.chunks(2));
        half.extend(pairs.map(|(a, b)| (a[0] + a[a.len() - 1] + b[0] + b[b.len() - 1]) * 0.25));
    }
}

widest!(fn double(half: &[f32], width: usize, plane: &mut [f32]) -> () = double_anywhere);

/// Back to full size: each pixel has 3/4 of the nearest and 1/4 of the next pixel of the half along each axis.
#[inline(always)]
fn double_anywhere(half: &[f32], width: usize, plane: &mut [f32]) {
    let columns = width.div_ceil(2);
    let rows = half.len() / columns;
    let mut line = vec![0.0; columns + 2];
    for (y, target) in plane.chunks_exact_mut(width).enumerate() {
        let near = y / 2;
        let next = if y % 2 == 0 { near.saturating_sub(1) } else { (near + 1).min(rows - 1) };
        let of = |row: usize| &half[row * columns..(row + 1) * columns];
        for ((value, near), next) in line[1..].iter_mut().zip(of(near)).zip(of(next)) {
            *value = 0.75 * near + 0.25 * next;
        }
        (line[0], line[columns + 1]) = (line[1], line[columns]);
        for (i, pair) in target.chunks_mut(2).enumerate() {
            pair[0] = 0.75 * line[i + 1] + 0.25 * line[i];
            if let Some(second) = pair.get_mut(1) {
                *second = 0.75 * line[i + 1] + 0.25 * line[i + 2];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A blurred impulse is a Gaussian: its variance along both axes is the square of sigma, its sum 1.
    #[test]
    fn an_impulse_becomes_a_gaussian_of_the_wanted_width() {
        let (width, height) = (640, 120);
        let mut plane = vec![0.0; width * height];
        plane[60 * width + 300] = 1.0;
        let mut pyramid = Pyramid::default();
        pyramid.of(&plane, width);
        for (k, blurred) in pyramid.blurs.iter().enumerate() {
            let value = |i: usize| f64::from(blurred[i]);
            let sum: f64 = (0..plane.len()).map(value).sum();
            let spread = |of: &dyn Fn(usize) -> f64| (0..plane.len()).map(|i| value(i) * of(i) * of(i)).sum::<f64>();
            let wanted = sigma_px(k, width).powi(2);
            for variance in [spread(&|i| (i % width) as f64 - 300.0), spread(&|i| (i / width) as f64 - 60.0)] {
                // The kernel ends at 2.6 sigma, which takes a little off its variance.
                assert!((variance / wanted - 1.0).abs() < 0.08, "{k}: {variance} {wanted}");
            }
            assert!((sum - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_flat_plane_stays_flat_at_any_size() {
        for (width, height) in [(1, 1), (3, 2), (33, 7), (64, 64)] {
            let plane = vec![0.7; width * height];
            let (mut blur, mut out) = (Blur::default(), Vec::new());
            blur.blur(&plane, width, 2.0, &mut out);
            assert!(out.iter().all(|value| (value - 0.7).abs() < 1e-5));
        }
    }
}
