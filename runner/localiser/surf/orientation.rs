//! The direction of a keypoint (Bay et al. 2008, section 4.1).

use super::arc_tangent::angle_deg;
use super::features::Keypoint;
use super::integral::Integral;

/// Samples reach 6 s to each side and are weighted with a Gaussian of sigma 2.5 s.
const RADIUS: i32 = 6;
const SIGMA: f64 = 2.5;
const GRID: usize = 2 * RADIUS as usize + 1;
/// Grid points within the circle.
const SAMPLES: usize = 113;
/// A window of 60 degrees is slid in steps of 5.
const STEP_DEG: i32 = 5;
const HALF_WINDOW_DEG: i32 = 30;
const WINDOWS: usize = 72;
/// Windows that hold an angle: 11 where it is the centre of one, else 12.
const MOST_HOLDING: usize = 12;

/// The values of a normalised Gaussian at `N` whole steps around the middle. Where `N` is even the two middle values are taken
/// at the middle itself, as OpenCV does (its issue 15856).
pub(super) fn gaussian<const N: usize>(sigma: f64) -> [f32; N] {
    let middle = (N as f64 - 1.0) / 2.0;
    let raw: [f64; N] = std::array::from_fn(|i| {
        let distance = (i as f64 - middle).abs();
        if distance < 1.0 { 1.0 } else { libm::exp(-distance * distance / (2.0 * sigma * sigma)) }
    });
    let scale = 1.0 / raw.iter().sum::<f64>();
    raw.map(|value| (value * scale) as f32)
}

/// What finding directions needs once per image.
pub(super) struct Compass {
    gaussian: [f32; GRID],
    /// For angles in 12 and in 11 windows: 1 where a window holds the angle, from `WINDOWS - first window` on, cyclic.
    holding: [[f32; 2 * WINDOWS]; 2],
}

impl Compass {
    pub fn new() -> Self {
        let strip = |count: usize| std::array::from_fn(|i| if i % WINDOWS < count { 1.0 } else { 0.0 });
        Self { gaussian: gaussian(SIGMA), holding: [strip(MOST_HOLDING), strip(MOST_HOLDING - 1)] }
    }

    /// The direction in degrees; `None` where no gradient lies inside the image.
    #[inline(always)]
    pub fn direction_deg(&self, integral: &Integral, keypoint: &Keypoint) -> Option<f32> {
        let (mut x, mut y) = ([0.0; SAMPLES], [0.0; SAMPLES]);
        let count = self.gradients(integral, keypoint, &mut x, &mut y);
        if count == 0 {
            return None;
        }
        let mut degrees = [0_i32; SAMPLES];
        for ((degrees, &x), &y) in degrees.iter_mut().zip(&x).zip(&y) {
            *degrees = whole(angle_deg(y, x));
        }
        let sum_x = self.window_sums(&x[..count], &degrees[..count]);
        let sum_y = self.window_sums(&y[..count], &degrees[..count]);
        let (mut best, mut longest) = ((0.0, 0.0), 0.0);
        for (&x, &y) in sum_x.iter().zip(&sum_y) {
            let length = x * x + y * y;
            if length > longest {
                (best, longest) = ((x, y), length);
            }
        }
        Some(angle_deg(-best.1, best.0))
    }

    /// Weighted Haar responses of side 4 s on the grid of spacing s inside the circle, those that fit the image; their number.
    #[inline(always)]
    fn gradients(
        &self,
        integral: &Integral,
        keypoint: &Keypoint,
        x: &mut [f32; SAMPLES],
        y: &mut [f32; SAMPLES],
    ) -> usize {
        let scale = keypoint.size_px * 1.2 / 9.0;
        let side = wavelet_side(scale);
        let half = side / 2;
        let weight = 1.0 / (half as f32 * side as f32);
        let corner = |centre: f32, step: i32| whole(centre + step as f32 * scale - (side as f32 - 1.0) / 2.0);
        let fits = |corner: i32, length: usize| usize::try_from(corner).ok().filter(|corner| corner + side <= length);
        let lefts: [_; GRID] = std::array::from_fn(|i| fits(corner(keypoint.x_px, i as i32 - RADIUS), integral.width));
        let tops: [_; GRID] = std::array::from_fn(|i| fits(corner(keypoint.y_px, i as i32 - RADIUS), integral.height));
        let mut count = 0;
        for (i, left) in (-RADIUS..).zip(lefts) {
            let Some(left) = left else { continue };
            for (j, top) in (-RADIUS..).zip(tops) {
                let Some(top) = top.filter(|_| i * i + j * j <= RADIUS * RADIUS) else { continue };
                let row = |y: usize| {
                    let sums = integral.samples(left, y, side + 1);
                    [sums[0], sums[half], sums[side]]
                };
                let [above, middle, below] = [row(top), row(top + half), row(top + side)];
                let column = |k: usize| below[k].wrapping_sub(above[k]);
                let line = |row: [i32; 3]| row[2].wrapping_sub(row[0]);
                let (first, second) =
                    (column(1).wrapping_sub(column(0)) as f32, column(2).wrapping_sub(column(1)) as f32);
                let (upper, lower) =
                    (line(middle).wrapping_sub(line(above)) as f32, line(below).wrapping_sub(line(middle)) as f32);
                let gauss = self.gaussian[(i + RADIUS) as usize] * self.gaussian[(j + RADIUS) as usize];
                x[count] = (second * weight - first * weight) * gauss;
                y[count] = (upper * weight - lower * weight) * gauss;
                count += 1;
            }
        }
        count
    }

    /// Sums of `values` in each window, added in the order they come.
    #[inline(always)]
    fn window_sums(&self, values: &[f32], degrees: &[i32]) -> [f32; WINDOWS] {
        let mut sums = [0.0; WINDOWS];
        for (&value, &degrees) in values.iter().zip(degrees) {
            let centred = degrees % STEP_DEG == 0;
            let first = (degrees - HALF_WINDOW_DEG).div_euclid(STEP_DEG) + 1;
            let offset = (-first).rem_euclid(WINDOWS as i32) as usize;
            let holding = &self.holding[usize::from(centred)][offset..offset + WINDOWS];
            for (sum, &held) in sums.iter_mut().zip(holding) {
                *sum += value * held;
            }
        }
        sums
    }
}

/// Side of the Haar wavelets, even so that they are balanced.
fn wavelet_side(scale: f32) -> usize {
    2 * whole(2.0 * scale).max(1) as usize
}

/// Whether the wavelets of a keypoint of `size_px` fit the image at all.
pub(super) fn wavelet_fits(size_px: f32, integral: &Integral) -> bool {
    wavelet_side(size_px * 1.2 / 9.0) <= integral.width.min(integral.height) + 1
}

/// The nearest whole number, ties to even.
#[inline(always)]
fn whole(value: f32) -> i32 {
    value.round_ties_even() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Window sums against the definition: every window adds what lies less than 30 degrees from its centre, around the circle.
    #[test]
    fn windows_hold_what_is_nearer_than_thirty_degrees() {
        let degrees: Vec<i32> = (0..=360).collect();
        let values: Vec<f32> = degrees.iter().map(|&d| 1.0 + (d * 7 % 13) as f32 * 0.37).collect();
        let sums = Compass::new().window_sums(&values, &degrees);
        for (window, &sum) in sums.iter().enumerate() {
            let mut brute = 0.0_f32;
            for (&value, &degrees) in values.iter().zip(&degrees) {
                let apart = (degrees - 5 * window as i32).abs();
                if apart.min(360 - apart) < 30 {
                    brute += value;
                }
            }
            assert_eq!(sum.to_bits(), brute.to_bits(), "window {window}");
        }
    }

    #[test]
    fn the_circle_holds_as_many_samples_as_are_kept() {
        let inside = (-6..=6).flat_map(|i| (-6..=6).map(move |j| i * i + j * j)).filter(|&square: &i32| square <= 36);
        assert_eq!(inside.count(), SAMPLES);
    }
}
