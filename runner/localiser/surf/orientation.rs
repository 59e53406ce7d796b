//! The direction of a keypoint (Bay et al. 2008, section 4.1).

use super::arc_tangent::angle_deg;
use super::integral::Integral;
use super::keypoint::Keypoint;

/// Samples reach 6 s to each side and are weighted with a Gaussian of sigma 2.5 s.
const RADIUS: i32 = 6;
const SIGMA: f64 = 2.5;
const GRID: usize = 2 * RADIUS as usize + 1;
/// Grid points within the circle.
const SAMPLES: usize = 113;
/// A window of 60 degrees is slid in steps of 5.
const STEP_DEG: usize = 5;
const HALF_WINDOW_DEG: usize = 30;
const WINDOWS: usize = 72;
/// Steps from a window's centre to its edge, which it does not hold.
const HALF_WINDOW: usize = HALF_WINDOW_DEG / STEP_DEG;
/// A turn, and one window more so that those across 360 degrees are read in one piece.
const CYCLE: usize = WINDOWS + 2 * HALF_WINDOW;

/// The values of a normalised Gaussian at `N` whole steps around the middle. Where `N` is even the two middle values
/// are taken at the middle itself, as OpenCV does (its issue 15856).
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
}

/// Haar responses of side 4 s on the grid inside the circle, as sums of grey levels over the halves of the wavelets.
struct Wavelets {
    left: [i32; SAMPLES],
    right: [i32; SAMPLES],
    upper: [i32; SAMPLES],
    lower: [i32; SAMPLES],
    gauss: [f32; SAMPLES],
    /// How many fit the image.
    count: usize,
    /// One over the pixels of half a wavelet.
    weight: f32,
}

impl Compass {
    pub fn new() -> Self {
        Self { gaussian: gaussian(SIGMA) }
    }

    /// The direction in degrees; `None` where no gradient lies inside the image.
    #[inline(always)]
    pub fn direction_deg(&self, integral: &Integral, keypoint: &Keypoint) -> Option<f32> {
        let wavelets = self.wavelets(integral, keypoint);
        if wavelets.count == 0 {
            return None;
        }
        let (mut x, mut y, mut degrees) = ([0.0; SAMPLES], [0.0; SAMPLES], [0_i32; SAMPLES]);
        for i in 0..SAMPLES {
            let half = |sum: i32| sum as f32 * wavelets.weight;
            x[i] = (half(wavelets.right[i]) - half(wavelets.left[i])) * wavelets.gauss[i];
            y[i] = (half(wavelets.upper[i]) - half(wavelets.lower[i])) * wavelets.gauss[i];
            degrees[i] = whole(angle_deg(y[i], x[i]));
        }
        let count = wavelets.count;
        let sum_x = window_sums(&x[..count], &degrees[..count]);
        let sum_y = window_sums(&y[..count], &degrees[..count]);
        let (mut best, mut longest) = ((0.0, 0.0), 0.0);
        for (&x, &y) in sum_x.iter().zip(&sum_y) {
            let length = x * x + y * y;
            if length > longest {
                (best, longest) = ((x, y), length);
            }
        }
        Some(angle_deg(-best.1, best.0))
    }

    /// The wavelets on the grid of spacing s inside the circle, those that fit the image, row by row.
    #[inline(always)]
    fn wavelets(&self, integral: &Integral, keypoint: &Keypoint) -> Wavelets {
        let scale = keypoint.size_px * 1.2 / 9.0;
        let side = wavelet_side(scale);
        let half = side / 2;
        let corner = |centre: f32, step: i32| whole(centre + step as f32 * scale - (side as f32 - 1.0) / 2.0);
        let fits = |corner: i32, length: usize| usize::try_from(corner).ok().filter(|corner| corner + side <= length);
        let lefts: [_; GRID] = std::array::from_fn(|i| fits(corner(keypoint.x_px, i as i32 - RADIUS), integral.width));
        let mut found = Wavelets {
            left: [0; SAMPLES],
            right: [0; SAMPLES],
            upper: [0; SAMPLES],
            lower: [0; SAMPLES],
            gauss: [0.0; SAMPLES],
            count: 0,
            weight: 1.0 / (half as f32 * side as f32),
        };
        for j in -RADIUS..=RADIUS {
            let Some(top) = fits(corner(keypoint.y_px, j), integral.height) else { continue };
            let row = |y: usize| integral.samples(0, y, integral.width + 1);
            let (above, middle, below) = (row(top), row(top + half), row(top + side));
            for (i, left) in (-RADIUS..).zip(lefts) {
                let Some(left) = left.filter(|_| i * i + j * j <= RADIUS * RADIUS) else { continue };
                let at = |row: &[i32]| [row[left], row[left + half], row[left + side]];
                let ([a, b, c], [d, _, e], [f, g, h]) = (at(above), at(middle), at(below));
                // Sums over rectangles wrap, their differences do not.
                let box_sum = |corners: [i32; 4]| {
                    corners[0].wrapping_sub(corners[1]).wrapping_sub(corners[2].wrapping_sub(corners[3]))
                };
                let sample = found.count;
                found.left[sample] = box_sum([g, f, b, a]);
                found.right[sample] = box_sum([h, g, c, b]);
                found.upper[sample] = box_sum([e, d, c, a]);
                found.lower[sample] = box_sum([h, f, e, d]);
                found.gauss[sample] = self.gaussian[(i + RADIUS) as usize] * self.gaussian[(j + RADIUS) as usize];
                found.count += 1;
            }
        }
        found
    }
}

/// Sums of `values` whose angles are less than 30 degrees from each window's centre. Values are first added up by
/// angle: `on` holds those at a multiple of 5 degrees, `between` those up to the next one. A window is 11 of the former
/// and 12 of the latter.
#[inline(always)]
fn window_sums(values: &[f32], degrees: &[i32]) -> [f32; WINDOWS] {
    let (mut on, mut between) = ([0.0_f32; WINDOWS], [0.0_f32; WINDOWS]);
    for (&value, &degrees) in values.iter().zip(degrees) {
        let step = degrees as usize / STEP_DEG % WINDOWS;
        let bins = if (degrees as usize).is_multiple_of(STEP_DEG) { &mut on } else { &mut between };
        bins[step] += value;
    }
    // Entry i stands for the step i - 6, so that a window begins at its own number.
    let before = |i: usize| (i + WINDOWS - HALF_WINDOW) % WINDOWS;
    let ones: [f32; CYCLE] = std::array::from_fn(|i| between[before(i)] + on[before(i + 1)]);
    let twos: [f32; CYCLE - 1] = std::array::from_fn(|i| ones[i] + ones[i + 1]);
    let fours: [f32; CYCLE - 3] = std::array::from_fn(|i| twos[i] + twos[i + 2]);
    std::array::from_fn(|i| {
        let eight = fours[i] + fours[i + 4];
        eight + twos[i + 8] + (ones[i + 10] + between[before(i + 11)])
    })
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

    /// Window sums against the definition: every window adds what lies less than 30 degrees from its centre, around the
    /// circle. The values are whole numbers, so that no order of adding rounds.
    #[test]
    fn windows_hold_what_is_nearer_than_thirty_degrees() {
        let degrees: Vec<i32> = (0..=360).collect();
        let values: Vec<f32> = degrees.iter().map(|&d| 1.0 + (d * 7 % 13) as f32 * 37.0).collect();
        let sums = window_sums(&values, &degrees);
        for (window, &sum) in sums.iter().enumerate() {
            let apart = |degrees: i32| (degrees - 5 * window as i32).abs();
            let held = |degrees: i32| apart(degrees).min(360 - apart(degrees)) < 30;
            let brute: f32 = values.iter().zip(&degrees).filter(|(_, d)| held(**d)).map(|(value, _)| value).sum();
            assert_eq!(sum, brute, "window {window}");
        }
    }

    #[test]
    fn the_circle_holds_as_many_samples_as_are_kept() {
        let inside = (-6..=6).flat_map(|i| (-6..=6).map(move |j| i * i + j * j)).filter(|&square: &i32| square <= 36);
        assert_eq!(inside.count(), SAMPLES);
    }
}
