//! Refinement of matches to a fraction of a pixel: a patch of one image is moved over another until they fit best
//! (inverse compositional alignment of Baker and Matthews 2004, translation only, difference of brightness removed).

use super::patch::{AREA, Patch};
use furrow_model::GreyImage;

const MAX_ITERATIONS: usize = 10;
/// The alignment has converged when an iteration moves the patch by less than this, in px.
const TOLERANCE_PX: f32 = 0.01;
/// A patch that moves farther than this from its start has found something else, in px.
const FARTHEST_PX: f32 = 2.5;

/// Standard deviation of a pixel, in grey levels: noise, and what light and leaves change between two views.
const GREY_STD: f64 = 2.7;
/// Variances are relative to that of a place in rich texture, which has a standard deviation of about this, in px.
const RICH_STD_PX: f64 = 0.05;
/// Relative variance that [`GREY_STD`] causes in a texture with a sum of squared slopes of one.
const GREY_VARIANCE: f64 = (GREY_STD / RICH_STD_PX) * (GREY_STD / RICH_STD_PX);
/// The sum of squared slopes of a patch that holds nothing but noise.
const NOISE_SLOPES: f64 = AREA as f64 * GREY_STD * GREY_STD / 2.0;
/// Relative variance of a place that is known to half a pixel, by the peak of the filter response.
pub(crate) const UNREFINED_VARIANCE: f64 = (0.5 / RICH_STD_PX) * (0.5 / RICH_STD_PX);
/// The greatest relative variance: a converged place is at most this far from its start.
const MAX_VARIANCE: f64 = (FARTHEST_PX as f64 / RICH_STD_PX) * (FARTHEST_PX as f64 / RICH_STD_PX);

/// The relative variance of a place along a direction in which a patch has this sum of squared slopes.
fn direction_variance(slopes: f64) -> f64 {
    1.0 + (GREY_VARIANCE / (slopes - NOISE_SLOPES).max(1.0)).min(MAX_VARIANCE)
}

impl Patch {
    /// Relative variances of the column and row that [`Patch::refine`] finds, with their covariance (uu, uv, vv). They
    /// are 1 in rich texture, and large along an edge.
    pub fn variance(&self) -> [f64; 3] {
        // Along the two eigenvectors of the normal matrix, whose eigenvalues are mean + half and mean - half.
        let [uu, uv, vv] = self.normal.map(f64::from);
        let (mean, cosine) = (0.5 * (uu + vv), 0.5 * (uu - vv));
        let half = (cosine * cosine + uv * uv).sqrt();
        let [across, along] = [mean + half, mean - half].map(direction_variance);
        // A misfit across an edge (it turned, or its sides lie at different depths) moves the place along it.
        let edge = (mean + half) / (mean - half).max(f64::MIN_POSITIVE);
        let along = (along + edge - 1.0).min(MAX_VARIANCE);
        let (middle, spread) = (0.5 * (across + along), 0.5 * (across - along) / half.max(f64::MIN_POSITIVE));
        [middle + spread * cosine, spread * uv, middle - spread * cosine]
    }

    /// Relative variance of the column that [`Patch::refine_along_row`] finds: 1 in rich texture.
    pub fn variance_along_row(&self) -> f64 {
        direction_variance(self.normal[0].into())
    }

    /// Where in `image` the patch fits best near `start_px`. `None` if it leaves the image, has too little texture, or
    /// the alignment does not converge.
    pub fn refine(&self, image: &GreyImage, start_px: [f64; 2]) -> Option<[f64; 2]> {
        let [uu, uv, vv] = self.normal;
        let determinant = uu * vv - uv * uv;
        let start = start_px.map(|v| v as f32);
        let mut at = start;
        for _ in 0..MAX_ITERATIONS {
            let [bu, bv] = self.weigh_differences(image, at[0], at[1])?;
            let step = [(vv * bu - uv * bv) / determinant, (uu * bv - uv * bu) / determinant];
            at = [at[0] - step[0], at[1] - step[1]];
            // A patch without texture gives NaN, for which every comparison is false.
            let is_close = |k: usize| (at[k] - start[k]).abs() <= FARTHEST_PX;
            if !(is_close(0) && is_close(1)) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < TOLERANCE_PX {
                return Some(at.map(f64::from));
            }
        }
        None
    }

    /// The column where the patch fits best along row `v_px` of `image`, near `start_u_px`. `None` as for
    /// [`Patch::refine`].
    pub fn refine_along_row(&self, image: &GreyImage, start_u_px: f64, v_px: f64) -> Option<f64> {
        let start = start_u_px as f32;
        let mut u = start;
        for _ in 0..MAX_ITERATIONS {
            let step = self.weigh_differences(image, u, v_px as f32)?[0] / self.normal[0];
            u -= step;
            let is_close = (u - start).abs() <= FARTHEST_PX;
            if !is_close {
                return None;
            }
            if step.abs() < TOLERANCE_PX {
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
        let patch = Patch::extract(&waves([0.0, 0.0], 0.0), [30.25, 24.5]).unwrap();
        for (du, dv) in [(0.3, -0.4), (1.1, 0.7), (-0.05, 0.02)] {
            let there = waves([du, dv], 12.0);
            let [u, v] = patch.refine(&there, [30.25, 24.5]).unwrap();
            assert!((u - 30.25 - du).abs() < 0.03 && (v - 24.5 - dv).abs() < 0.03, "{u} {v} for {du} {dv}");
            let along = patch.refine_along_row(&waves([du, 0.0], 12.0), 30.25, 24.5).unwrap();
            assert!((along - 30.25 - du).abs() < 0.03, "{along} for {du}");
        }
    }

    #[test]
    fn variances_are_large_along_edges_and_in_noise() {
        let edge = |slope: [f64; 2]| {
            let grey = |i: usize| {
                100.0 + 90.0 * ((i % 60) as f64 - 30.0).mul_add(slope[0], ((i / 60) as f64 - 25.0) * slope[1]).tanh()
            };
            GreyImage { width: 60, height: 50, pixels: (0..3000).map(|i| grey(i).round() as u8).collect() }
        };
        let variance = |slope| Patch::extract(&edge(slope), [30.0, 25.0]).unwrap().variance();
        let [uu, uv, vv] = variance([0.8, 0.0]);
        assert!(uu < 2.0 && uv.abs() < 1e-3 && vv > 1000.0, "{uu} {uv} {vv}");
        let [uu, uv, vv] = variance([0.6, 0.6]);
        // Along (1, -1): the errors of both coordinates are opposite.
        assert!(uu > 500.0 && (uu / vv - 1.0).abs() < 0.1 && (uv / uu + 1.0).abs() < 0.05, "{uu} {uv} {vv}");
        let rough = (0..3000).map(|i: usize| 98 + (i.wrapping_mul(2_654_435_761) >> 7) as u8 % 5).collect();
        let rough = Patch::extract(&GreyImage { width: 60, height: 50, pixels: rough }, [30.0, 25.0]).unwrap();
        assert!(rough.variance_along_row() > 100.0, "{}", rough.variance_along_row());
    }

    #[test]
    fn flat_patches_are_refused() {
        let flat = GreyImage { width: 60, height: 50, pixels: vec![7; 3000] };
        let patch = Patch::extract(&flat, [20.0, 20.0]).unwrap();
        assert!(patch.refine(&flat, [20.0, 20.0]).is_none() && patch.refine_along_row(&flat, 20.0, 20.0).is_none());
    }
}
