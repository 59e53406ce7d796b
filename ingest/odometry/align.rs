//! Refinement to a fraction of a pixel: a patch of one image is slid over another until they fit best
//! (inverse compositional alignment, Baker and Matthews 2004, translation only, brightness offset removed).

use furrow_model::GreyImage;

/// Patch columns and rows.
const SIDE: usize = 9;
const AREA: usize = SIDE * SIDE;
const ROUNDS: usize = 10;
/// Settled when a round moves the patch by less than this, in px.
const SETTLED_PX: f32 = 0.01;
/// A patch that ends farther than this from where it started has found something else, in px.
const FARTHEST_PX: f32 = 2.5;

/// What a pixel may be off by, by noise and by what light and leaves do between two views, in grey levels.
const GREY: f64 = 2.7;
/// Variances here are in units of that of a place found in rich texture, some 0.05 px. A pixel that is off is this much of it in a texture of one
/// grey level a pixel.
const GREY_NOISE: f64 = (GREY / 0.05) * (GREY / 0.05);
/// What noise alone makes of a patch' sum of squared slopes: there is nothing to hold on to.
const NOISE_SLOPES: f64 = AREA as f64 * GREY * GREY / 2.0;
/// The variance of what is known to half a pixel, as the filter response tells it.
pub(crate) const UNREFINED: f64 = (0.5 / 0.05) * (0.5 / 0.05);
/// The greatest variance: what settles is found within so many pixels of where it was looked for.
const VAGUEST: f64 = (FARTHEST_PX as f64 / 0.05) * (FARTHEST_PX as f64 / 0.05);

/// A square of an image around a point, less its mean, with its gradients.
pub(crate) struct Patch {
    values: [f32; AREA],
    slope_u: [f32; AREA],
    slope_v: [f32; AREA],
    /// Sums of products of slopes: uu, uv, vv.
    normal: [f32; 3],
}

/// The image around (u, v), `N` x `N` values less their mean, by bilinear interpolation; `None` where that leaves the image.
fn cut<const N: usize, const N_SQUARED: usize>(image: &GreyImage, u: f32, v: f32) -> Option<[f32; N_SQUARED]> {
    let half = (N / 2) as f32;
    let (left, top) = (u - half, v - half);
    let fits = |from: f32, size: usize| from >= 0.0 && from + ((N + 1) as f32) < size as f32;
    if !fits(left, image.width) || !fits(top, image.height) {
        return None;
    }
    let (column, row) = (left as usize, top as usize);
    let (a, b) = (left - column as f32, top - row as f32);
    let weights = [(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b];
    let mut out = [0.0; N_SQUARED];
    // One sum per column: additions of floats must not be reordered, so this order is the one that vectorises.
    let mut sums = [0.0_f32; N];
    for (i, line) in out.chunks_exact_mut(N).enumerate() {
        let upper = &image.row(row + i)[column..column + N + 1];
        let lower = &image.row(row + i + 1)[column..column + N + 1];
        for ((j, value), sum) in line.iter_mut().enumerate().zip(&mut sums) {
            *value = weights[0] * f32::from(upper[j])
                + weights[1] * f32::from(upper[j + 1])
                + weights[2] * f32::from(lower[j])
                + weights[3] * f32::from(lower[j + 1]);
            *sum += *value;
        }
    }
    let mean = sums.iter().sum::<f32>() / N_SQUARED as f32;
    out.iter_mut().for_each(|value| *value -= mean);
    Some(out)
}

/// The variance of a place along a direction in which a patch has this sum of squared slopes.
fn noise_of(slopes: f64) -> f64 {
    1.0 + (GREY_NOISE / (slopes - NOISE_SLOPES).max(1.0)).min(VAGUEST)
}

impl Patch {
    /// The patch of `image` around (u, v) px; `None` at the image's rim.
    pub fn cut(image: &GreyImage, at_px: [f64; 2]) -> Option<Self> {
        const WIDE: usize = SIDE + 2;
        let wide = cut::<WIDE, { WIDE * WIDE }>(image, at_px[0] as f32, at_px[1] as f32)?;
        let mut patch = Self { values: [0.0; AREA], slope_u: [0.0; AREA], slope_v: [0.0; AREA], normal: [0.0; 3] };
        for i in 0..SIDE {
            for j in 0..SIDE {
                let (at, here) = (i * SIDE + j, (i + 1) * WIDE + j + 1);
                patch.values[at] = wide[here];
                patch.slope_u[at] = 0.5 * (wide[here + 1] - wide[here - 1]);
                patch.slope_v[at] = 0.5 * (wide[here + WIDE] - wide[here - WIDE]);
            }
        }
        for values in [&mut patch.values, &mut patch.slope_u, &mut patch.slope_v] {
            let mean = values.iter().sum::<f32>() / AREA as f32;
            values.iter_mut().for_each(|value| *value -= mean);
        }
        let dot = |a: &[f32; AREA], b: &[f32; AREA]| a.iter().zip(b).map(|(x, y)| x * y).sum();
        let (gu, gv) = (&patch.slope_u, &patch.slope_v);
        patch.normal = [dot(gu, gu), dot(gu, gv), dot(gv, gv)];
        Some(patch)
    }

    /// Sums of the difference to `image` at (u, v), times each slope.
    fn misfit(&self, image: &GreyImage, u: f32, v: f32) -> Option<[f32; 2]> {
        let there = cut::<SIDE, AREA>(image, u, v)?;
        let (mut by_u, mut by_v) = ([0.0; SIDE], [0.0; SIDE]);
        let rows = there.chunks_exact(SIDE).zip(self.values.chunks_exact(SIDE));
        let slopes = self.slope_u.chunks_exact(SIDE).zip(self.slope_v.chunks_exact(SIDE));
        for ((there, here), (slope_u, slope_v)) in rows.zip(slopes) {
            for j in 0..SIDE {
                let difference = there[j] - here[j];
                by_u[j] += difference * slope_u[j];
                by_v[j] += difference * slope_v[j];
            }
        }
        Some([by_u.iter().sum(), by_v.iter().sum()])
    }

    /// How alike the patch and `image` around (u, v) px are: the correlation of their values, -1 to 1, blind to brightness and contrast; `None`
    /// at the image's rim, NaN without texture.
    pub fn likeness(&self, image: &GreyImage, at_px: [f64; 2]) -> Option<f32> {
        let there = cut::<SIDE, AREA>(image, at_px[0] as f32, at_px[1] as f32)?;
        let (mut products, mut here_squares, mut there_squares) = (0.0, 0.0, 0.0);
        for (here, there) in self.values.iter().zip(&there) {
            products += here * there;
            here_squares += here * here;
            there_squares += there * there;
        }
        Some(products / (here_squares * there_squares).sqrt())
    }

    /// How much a place that [`Patch::anywhere`] found errs: variances of column and row with their covariance (uu, uv, vv), 1 where texture is
    /// rich. Along an edge there is little to hold on to.
    pub fn noise(&self) -> [f64; 3] {
        // Along the texture's two own directions: half the sum and half the difference of what is known there.
        let [uu, uv, vv] = self.normal.map(f64::from);
        let (mean, cosine) = (0.5 * (uu + vv), 0.5 * (uu - vv));
        let half = (cosine * cosine + uv * uv).sqrt();
        let [across, along] = [mean + half, mean - half].map(noise_of);
        // What does not fit across an edge, because it turned or its sides lie at different depths, moves the place along it.
        let edge = (mean + half) / (mean - half).max(f64::MIN_POSITIVE);
        let along = (along + edge - 1.0).min(VAGUEST);
        let (middle, spread) = (0.5 * (across + along), 0.5 * (across - along) / half.max(f64::MIN_POSITIVE));
        [middle + spread * cosine, spread * uv, middle - spread * cosine]
    }

    /// How much a column that [`Patch::along_row`] found errs, as a variance: 1 where texture is rich.
    pub fn noise_along_row(&self) -> f64 {
        noise_of(self.normal[0].into())
    }

    /// Where in `image` the patch fits best near `start_px`; `None` where it leaves the image, has too little texture, or does not settle.
    pub fn anywhere(&self, image: &GreyImage, start_px: [f64; 2]) -> Option<[f64; 2]> {
        let [uu, uv, vv] = self.normal;
        let determinant = uu * vv - uv * uv;
        let start = start_px.map(|v| v as f32);
        let mut at = start;
        for _ in 0..ROUNDS {
            let [bu, bv] = self.misfit(image, at[0], at[1])?;
            let step = [(vv * bu - uv * bv) / determinant, (uu * bv - uv * bu) / determinant];
            at = [at[0] - step[0], at[1] - step[1]];
            // A patch without texture gives NaN, which no comparison finds close.
            let close = |k: usize| (at[k] - start[k]).abs() <= FARTHEST_PX;
            if !(close(0) && close(1)) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < SETTLED_PX {
                return Some(at.map(f64::from));
            }
        }
        None
    }

    /// The column where the patch fits best along row `v_px` of `image`, near `start_u_px`; `None` as for [`Patch::anywhere`].
    pub fn along_row(&self, image: &GreyImage, start_u_px: f64, v_px: f64) -> Option<f64> {
        let start = start_u_px as f32;
        let mut u = start;
        for _ in 0..ROUNDS {
            let step = self.misfit(image, u, v_px as f32)?[0] / self.normal[0];
            u -= step;
            let close = (u - start).abs() <= FARTHEST_PX;
            if !close {
                return None;
            }
            if step.abs() < SETTLED_PX {
                return Some(f64::from(u));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth pattern sampled at a shift, with another brightness.
    fn waves(shift: [f64; 2], offset: f64) -> GreyImage {
        let value = |i: usize| {
            let (u, v) = ((i % 60) as f64 - shift[0], (i / 60) as f64 - shift[1]);
            (120.0 + offset + 50.0 * (0.5 * u).sin() * (0.4 * v + 0.3).cos() + 30.0 * (0.23 * u + 0.31 * v).sin())
                .round() as u8
        };
        GreyImage { width: 60, height: 50, pixels: (0..60 * 50).map(value).collect() }
    }

    #[test]
    fn a_shift_is_found_to_a_few_hundredths_of_a_pixel() {
        let patch = Patch::cut(&waves([0.0, 0.0], 0.0), [30.25, 24.5]).unwrap();
        for (du, dv) in [(0.3, -0.4), (1.1, 0.7), (-0.05, 0.02)] {
            let there = waves([du, dv], 12.0);
            let [u, v] = patch.anywhere(&there, [30.25, 24.5]).unwrap();
            assert!((u - 30.25 - du).abs() < 0.03 && (v - 24.5 - dv).abs() < 0.03, "{u} {v} for {du} {dv}");
            let along = patch.along_row(&waves([du, 0.0], 12.0), 30.25, 24.5).unwrap();
            assert!((along - 30.25 - du).abs() < 0.03, "{along} for {du}");
        }
    }

    #[test]
    fn an_edge_is_vague_along_itself_and_noise_is_no_texture() {
        let edge = |slope: [f64; 2]| {
            let grey = |i: usize| {
                100.0 + 90.0 * ((i % 60) as f64 - 30.0).mul_add(slope[0], ((i / 60) as f64 - 25.0) * slope[1]).tanh()
            };
            GreyImage { width: 60, height: 50, pixels: (0..3000).map(|i| grey(i).round() as u8).collect() }
        };
        let noise = |slope| Patch::cut(&edge(slope), [30.0, 25.0]).unwrap().noise();
        let [uu, uv, vv] = noise([0.8, 0.0]);
        assert!(uu < 2.0 && uv.abs() < 1e-3 && vv > 1000.0, "{uu} {uv} {vv}");
        let [uu, uv, vv] = noise([0.6, 0.6]);
        // Along (1, -1): both coordinates err together, in opposite directions.
        assert!(uu > 500.0 && (uu / vv - 1.0).abs() < 0.1 && (uv / uu + 1.0).abs() < 0.05, "{uu} {uv} {vv}");
        let rough = (0..3000).map(|i: usize| 98 + (i.wrapping_mul(2_654_435_761) >> 7) as u8 % 5).collect();
        let rough = Patch::cut(&GreyImage { width: 60, height: 50, pixels: rough }, [30.0, 25.0]).unwrap();
        assert!(rough.noise_along_row() > 100.0, "{}", rough.noise_along_row());
    }

    #[test]
    fn rims_and_flat_patches_are_refused() {
        let flat = GreyImage { width: 60, height: 50, pixels: vec![7; 3000] };
        assert!(Patch::cut(&flat, [3.0, 20.0]).is_none() && Patch::cut(&flat, [20.0, 47.0]).is_none());
        let patch = Patch::cut(&flat, [20.0, 20.0]).unwrap();
        assert!(patch.anywhere(&flat, [20.0, 20.0]).is_none() && patch.along_row(&flat, 20.0, 20.0).is_none());
    }
}
