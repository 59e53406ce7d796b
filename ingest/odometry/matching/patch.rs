//! Patches: squares of an image around a point, and how they differ from another image.

use furrow_model::GreyImage;

/// Columns and rows of a patch.
const SIDE: usize = 9;
/// Pixels of a patch.
pub(super) const AREA: usize = SIDE * SIDE;

/// A square of an image around a point, minus its mean, with its gradients.
pub(crate) struct Patch {
    values: [f32; AREA],
    slope_u: [f32; AREA],
    slope_v: [f32; AREA],
    /// Sums of products of slopes: uu, uv, vv.
    pub(super) normal: [f32; 3],
}

/// `N` x `N` values of the image around (u, v), minus their mean, by bilinear interpolation. `None` if they leave the
/// image.
fn sample_square<const N: usize, const N_SQUARED: usize>(
    image: &GreyImage,
    u: f32,
    v: f32,
) -> Option<[f32; N_SQUARED]> {
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
    // One sum per column: the compiler must not reorder additions of floats, and this order is the one that it
    // vectorises.
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

impl Patch {
    /// The patch of `image` around (u, v) px; `None` at the image's border.
    pub fn extract(image: &GreyImage, at_px: [f64; 2]) -> Option<Self> {
        const WIDE: usize = SIDE + 2;
        let wide = sample_square::<WIDE, { WIDE * WIDE }>(image, at_px[0] as f32, at_px[1] as f32)?;
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

    /// Sums over the patch of its difference to `image` at (u, v), times each slope: the right side of the normal
    /// equations of the alignment. `None` at the image's border.
    pub(super) fn weigh_differences(&self, image: &GreyImage, u: f32, v: f32) -> Option<[f32; 2]> {
        let there = sample_square::<SIDE, AREA>(image, u, v)?;
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

    /// The correlation of the patch and `image` around (u, v) px, -1 to 1, independent of brightness and contrast.
    /// `None` at the image's border, NaN without texture.
    pub fn correlation(&self, image: &GreyImage, at_px: [f64; 2]) -> Option<f32> {
        let there = sample_square::<SIDE, AREA>(image, at_px[0] as f32, at_px[1] as f32)?;
        let (mut products, mut here_squares, mut there_squares) = (0.0, 0.0, 0.0);
        for (here, there) in self.values.iter().zip(&there) {
            products += here * there;
            here_squares += here * here;
            there_squares += there * there;
        }
        Some(products / (here_squares * there_squares).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_that_leave_the_image_are_refused() {
        let flat = GreyImage { width: 60, height: 50, pixels: vec![7; 3000] };
        assert!(Patch::extract(&flat, [3.0, 20.0]).is_none() && Patch::extract(&flat, [20.0, 47.0]).is_none());
        assert!(Patch::extract(&flat, [20.0, 20.0]).is_some());
    }
}
