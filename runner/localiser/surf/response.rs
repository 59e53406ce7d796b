//! Box filters of the second derivatives and the determinant of the Hessian (Bay et al. 2008, section 3.2).

use super::integral::Integral;

/// The 9 x 9 template of the filters and the weight of Dxy^2 in the determinant (Bay et al. 2008, eq. 4).
const TEMPLATE_SIDE: usize = 9;
const MIXED_WEIGHT: f32 = 0.81;

/// The three box filters Dxx, Dyy and Dxy at one side length. Offsets are pixels from the filter's top left corner.
pub(super) struct HessianFilter {
    /// Side in pixels, a multiple of 9 of the template.
    pub side: usize,
    /// Edges of the three lobes along the derivative, and of their common extent across it.
    lobes: [usize; 4],
    across: [usize; 2],
    lobe_weights: [f32; 3],
    /// Edges of the four boxes of Dxy: first box from 0 to 1, second from 2 to 3, in both directions.
    corners: [usize; 4],
    corner_weights: [f32; 4],
}

impl HessianFilter {
    /// The template resized to `side`, every edge rounded to the nearest pixel (ties to even).
    pub fn new(side: usize) -> Self {
        let ratio = side as f32 / TEMPLATE_SIDE as f32;
        let edge = |template: u8| (ratio * f32::from(template)).round_ties_even() as usize;
        let (lobes, across, corners) = ([0, 3, 6, 9].map(edge), [2, 7].map(edge), [1, 4, 5, 8].map(edge));
        let lobe = |k: usize, weight: f32| weight / ((lobes[k + 1] - lobes[k]) as f32 * (across[1] - across[0]) as f32);
        let extents = [(corners[1] - corners[0]) as f32, (corners[3] - corners[2]) as f32];
        let mixed = |i: usize, j: usize, weight: f32| weight / (extents[j] * extents[i]);
        Self {
            side,
            lobes,
            across,
            lobe_weights: [lobe(0, 1.0), lobe(1, -2.0), lobe(2, 1.0)],
            corners,
            corner_weights: [mixed(0, 0, 1.0), mixed(0, 1, -1.0), mixed(1, 0, -1.0), mixed(1, 1, 1.0)],
        }
    }

    /// Samples that fit along `length` pixels at `step`; 0 where the filter is larger.
    pub fn samples_along(&self, length: usize, step: usize) -> usize {
        if self.side > length { 0 } else { 1 + (length - self.side) / step }
    }

    /// Dxx at `n` samples from the top left corner (`x`, `y`), in grey levels.
    #[inline(always)]
    fn dxx(&self, integral: &Integral, x: usize, y: usize, out: &mut [f32]) {
        let n = out.len();
        let [top, bottom] = self.across.map(|row| self.lobes.map(|column| integral.samples(x + column, y + row, n)));
        three_lobes(top, bottom, self.lobe_weights, out);
    }

    /// Dyy, as [`Self::dxx`].
    #[inline(always)]
    fn dyy(&self, integral: &Integral, x: usize, y: usize, out: &mut [f32]) {
        let n = out.len();
        let [left, right] = self.across.map(|column| self.lobes.map(|row| integral.samples(x + column, y + row, n)));
        three_lobes(left, right, self.lobe_weights, out);
    }

    /// Dxy, as [`Self::dxx`].
    #[inline(always)]
    fn dxy(&self, integral: &Integral, x: usize, y: usize, out: &mut [f32]) {
        let n = out.len();
        let rows = self.corners.map(|row| self.corners.map(|column| integral.samples(x + column, y + row, n)));
        four_corners(rows, self.corner_weights, out);
    }

    /// The determinants Dxx Dyy - 0.81 Dxy^2 at `out.len()` samples from (`x`, `y`); `scratch` is as long as twice
    /// `out`.
    #[inline(always)]
    pub fn determinants(&self, integral: &Integral, x: usize, y: usize, scratch: &mut [f32], out: &mut [f32]) {
        let (dyy, dxy) = scratch.split_at_mut(out.len());
        self.dxx(integral, x, y, out);
        self.dyy(integral, x, y, dyy);
        self.dxy(integral, x, y, dxy);
        for ((det, &dyy), &dxy) in out.iter_mut().zip(&*dyy).zip(&*dxy) {
            *det = *det * dyy - MIXED_WEIGHT * dxy * dxy;
        }
    }

    /// The sign of the trace Dxx + Dyy with the corner at (`x`, `y`): 1 for dark blobs, -1 for bright ones.
    pub fn trace_sign(&self, integral: &Integral, x: usize, y: usize) -> i8 {
        let (mut dxx, mut dyy) = ([0.0], [0.0]);
        self.dxx(integral, x, y, &mut dxx);
        self.dyy(integral, x, y, &mut dyy);
        let trace = dxx[0] + dyy[0];
        i8::from(trace > 0.0) - i8::from(trace < 0.0)
    }
}

/// Weighted mean of three adjacent boxes, whose edges along the row of lobes are looked up on its `near` and its `far`
/// side. Each box is weighted in `f32`, the boxes are added in `f64`.
#[inline(always)]
fn three_lobes(near: [&[i32]; 4], far: [&[i32]; 4], weights: [f32; 3], out: &mut [f32]) {
    let n = out.len();
    let (near, far) = (near.map(|s| &s[..n]), far.map(|s| &s[..n]));
    for i in 0..n {
        let edges: [i32; 4] = std::array::from_fn(|k| far[k][i].wrapping_sub(near[k][i]));
        let lobe = |k: usize| f64::from(edges[k + 1].wrapping_sub(edges[k]) as f32 * weights[k]);
        out[i] = (lobe(0) + lobe(1) + lobe(2)) as f32;
    }
}

/// Weighted mean of the four boxes of Dxy, looked up in four rows at four columns.
#[inline(always)]
fn four_corners(rows: [[&[i32]; 4]; 4], weights: [f32; 4], out: &mut [f32]) {
    let n = out.len();
    let rows = rows.map(|row| row.map(|s| &s[..n]));
    for i in 0..n {
        let half = |upper: usize, k: usize| {
            let [above, below] = [rows[upper], rows[upper + 1]].map(|row| row[k + 1][i].wrapping_sub(row[k][i]));
            below.wrapping_sub(above) as f32
        };
        let first = f64::from(half(0, 0) * weights[0]) + f64::from(half(0, 2) * weights[1]);
        out[i] = (first + f64::from(half(2, 0) * weights[2]) + f64::from(half(2, 2) * weights[3])) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_model::GreyImage;

    /// On a paraboloid the mean over a lobe is exact in closed form up to the grey levels' rounding; a plane must give
    /// 0.
    #[test]
    fn a_plane_has_no_second_derivative() {
        let image = GreyImage::new(60, 60, (0..3600).map(|i| (i % 60 * 2 + i / 60) as u8).collect()).unwrap();
        let integral = Integral::of(&image);
        for side in [9, 15, 21, 27, 33] {
            let filter = HessianFilter::new(side);
            let mut det = vec![1.0; filter.samples_along(60, 1)];
            let mut scratch = vec![0.0; 2 * det.len()];
            filter.determinants(&integral, 0, 3, &mut scratch, &mut det);
            assert!(det.iter().all(|d| d.abs() < 1e-6), "side {side}: {det:?}");
        }
    }

    #[test]
    fn filters_equal_sums_over_pixels() {
        let pixels: Vec<u8> = (0..64 * 50).map(|i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let image = GreyImage::new(64, 50, pixels).unwrap();
        let fine = Integral::of(&image);
        let coarse = fine.halved();
        let mean = |x0: usize, y0: usize, [u0, v0, u1, v1]: [usize; 4]| {
            let total: f64 = (v0..v1)
                .flat_map(|v| (u0..u1).map(move |u| (u, v)))
                .map(|(u, v)| f64::from(image.at(x0 + u, y0 + v)))
                .sum();
            total / ((u1 - u0) * (v1 - v0)) as f64
        };
        // The layouts of Bay et al. 2008, figure 2, at 9 x 9, and by hand rounding at 18 x 18.
        for (integral, k) in [(&fine, 1), (&coarse, 2)] {
            let filter = HessianFilter::new(9 * k);
            let n = filter.samples_along(64, integral.step);
            let (mut det, mut scratch) = (vec![0.0; n], vec![0.0; 2 * n]);
            filter.determinants(integral, 0, 5, &mut scratch, &mut det);
            for (i, &det) in det.iter().enumerate() {
                let at = |b: [usize; 4]| mean(i * integral.step, 5, b.map(|edge| edge * k));
                let dxx = at([0, 2, 3, 7]) - 2.0 * at([3, 2, 6, 7]) + at([6, 2, 9, 7]);
                let dyy = at([2, 0, 7, 3]) - 2.0 * at([2, 3, 7, 6]) + at([2, 6, 7, 9]);
                let dxy = at([1, 1, 4, 4]) - at([5, 1, 8, 4]) - at([1, 5, 4, 8]) + at([5, 5, 8, 8]);
                let want = dxx * dyy - 0.81 * dxy * dxy;
                assert!((f64::from(det) - want).abs() < 1e-2 + 1e-5 * want.abs(), "{det} {want}");
            }
        }
    }
}
