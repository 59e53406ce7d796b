//! How far away things are, coarsely and fast: disparities of a rectified pair by sums of absolute differences over a
//! window, at the resolution that the shape of the ground needs. Odometry has sharper ones, but at corners only.

mod costs;

use costs::{Best, Costs, WINDOW, keep, keep_right};
use furrow_model::GreyImage;

/// Images are halved, thirded ... to about so many columns.
const COLUMNS: usize = 320;
/// A match whose neighbours cost so much more in all, per pixel of the window and in grey levels, is identified by its
/// texture.
const LEAST_CURVE: f32 = 1.5;
/// Two ways of matching, left to right and back, may differ by so many pixels.
const AGREE_PX: usize = 1;

/// Disparities of the left image, at a part of its resolution.
#[derive(Debug, Clone, PartialEq)]
pub struct Disparities {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// So many pixels of the image, each way, became one.
    pub scale: usize,
    /// In small pixels, row by row; NaN where the images do not tell.
    pub px: Vec<f32>,
}

impl Disparities {
    /// Of a rectified pair of one size, up to `most_px` (pixels of the images).
    pub fn of(left: &GreyImage, right: &GreyImage, most_px: f64) -> Self {
        let scale = (left.width as f64 / COLUMNS as f64).round().max(1.0) as usize;
        let (left, right) = (shrunk(left, scale), shrunk(right, scale));
        let most = (most_px / scale as f64).ceil().clamp(1.0, left.width.max(2) as f64 - 1.0) as usize;
        let px = matched(&left, &right, most);
        Self { width: left.width, height: left.height, scale, px }
    }
}

/// Means of `scale` x `scale` pixels; what does not fill one is left out.
fn shrunk(image: &GreyImage, scale: usize) -> GreyImage {
    let (width, height) = (image.width / scale, image.height / scale);
    let count = (scale * scale) as u32;
    let mut pixels = Vec::with_capacity(width * height);
    let mut sums = vec![0_u32; width];
    for y in 0..height {
        sums.fill(count / 2);
        for row in (0..scale).map(|i| image.row(y * scale + i)) {
            for (sum, values) in sums.iter_mut().zip(row.chunks_exact(scale)) {
                *sum += values.iter().map(|value| u32::from(*value)).sum::<u32>();
            }
        }
        pixels.extend(sums.iter().map(|sum| (sum / count) as u8));
    }
    GreyImage { width, height, pixels }
}

/// The disparity of each left pixel.
fn matched(left: &GreyImage, right: &GreyImage, most: usize) -> Vec<f32> {
    let (width, count) = (left.width, left.pixels.len());
    if count == 0 {
        return Vec::new();
    }
    let mut best =
        Best { cost: vec![u16::MAX; count], at: vec![0; count], before: vec![0; count], after: vec![0; count] };
    let mut back = (vec![u16::MAX; count], vec![0_u16; count]);
    let (mut costs, mut last) = (Costs::of(count, width), vec![u16::MAX; count]);
    for d in 0..=most {
        costs.fill(left, right, d);
        for y in 0..count / width {
            let row = y * width..(y + 1) * width;
            keep(&costs.sums[row.clone()], &last[row.clone()], d as u16, &mut best, row.start);
            // The right pixel of left pixel x is x - d.
            let right = row.start..row.end - d;
            keep_right(&costs.sums[row.start + d..row.end], d as u16, &mut back.0[right.clone()], &mut back.1[right]);
        }
        std::mem::swap(&mut costs.sums, &mut last);
    }
    let area = ((2 * WINDOW[0] + 1) * (2 * WINDOW[1] + 1)) as f32;
    let told = |i: usize| {
        let d = usize::from(best.at[i]);
        if d == 0 || d >= most || i % width < d + WINDOW[0] || usize::from(back.1[i - d]).abs_diff(d) > AGREE_PX {
            return f32::NAN;
        }
        let [before, here, after] = [best.before[i], best.cost[i], best.after[i]].map(f32::from);
        let curve = before + after - 2.0 * here;
        if curve < LEAST_CURVE * area {
            return f32::NAN;
        }
        // Sums of absolute differences grow linearly on both sides: two lines of one slope meet at the minimum.
        let steeper = (before - here).max(after - here);
        d as f32 + 0.5 * (before - after) / steeper
    };
    (0..count).map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A textured plane that leans away: the right image shows its texture moved by 6 + 0.05 (y - 60) pixels. Both are
    /// drawn from one function of place, so that the answer is known without any matching.
    #[test]
    fn a_leaning_plane_has_the_disparities_it_was_drawn_with() {
        let texture = |x: f64, y: f64| {
            120.0
                + 45.0 * (x * 0.9).sin() * (y * 0.31).cos()
                + 35.0 * (x * 0.37 + y * 0.71).sin()
                + 20.0 * (x * 1.7 - y * 0.23).cos()
        };
        let disparity = |y: usize| 6.0 + 0.05 * (y as f64 - 60.0);
        let draw = |shift: &dyn Fn(usize) -> f64| GreyImage {
            width: 320,
            height: 120,
            pixels: (0..320 * 120)
                .map(|i| texture((i % 320) as f64 + shift(i / 320), (i / 320) as f64) as u8)
                .collect(),
        };
        // What the left camera sees at x, the right one sees at x - d.
        let found = Disparities::of(&draw(&|_| 0.0), &draw(&disparity), 16.0);
        let errors: Vec<f64> = (0..320 * 120)
            .filter(|i| found.px[*i].is_finite())
            .map(|i| (f64::from(found.px[i]) - disparity(i / 320)).abs())
            .collect();
        assert!(errors.len() > 320 * 120 * 8 / 10, "{} of {} pixels", errors.len(), 320 * 120);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(mean < 0.12, "{mean}");
    }

    #[test]
    fn nothing_is_told_of_a_blank_wall_or_a_tiny_image() {
        let blank = GreyImage { width: 64, height: 40, pixels: vec![90; 64 * 40] };
        assert!(Disparities::of(&blank, &blank, 16.0).px.iter().all(|px| px.is_nan()));
        for (width, height) in [(0, 0), (1, 1), (2, 9), (9, 2)] {
            let tiny = GreyImage { width, height, pixels: vec![7; width * height] };
            assert!(Disparities::of(&tiny, &tiny, 16.0).px.iter().all(|px| px.is_nan()));
        }
    }
}
