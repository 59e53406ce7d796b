//! Integral images.

use super::memory::Numbers;
use furrow_model::GreyImage;

/// Sums of grey values above and left of every pixel, (height + 1) x (width + 1), wrapping `i32`: a difference of four
/// corners is right as long as the rectangle itself sums to less than 2^31.
///
/// The columns of each row are regrouped by their remainder modulo `step`, so that every `step`-th column from any
/// start is contiguous: the coarser octaves then read as fast as the first, for which `step` is 1 and nothing moves.
pub(super) struct Integral {
    /// Columns of the image, in pixels.
    pub width: usize,
    /// Rows of the image, in pixels.
    pub height: usize,
    /// Distance of neighbouring samples, in pixels: 2 to the power of `octave`.
    pub step: usize,
    octave: u32,
    /// Entries of one phase of one row.
    phase_length: usize,
    sums: Numbers,
}

impl Integral {
    /// The integral image of `image`, with step 1.
    pub fn of(image: &GreyImage) -> Self {
        let (width, height) = (image.width, image.height);
        let stride = width + 1;
        let mut sums = Numbers::new(stride * (height + 1));
        sums[..stride].fill(0);
        for y in 0..height {
            let (above, below) = sums.split_at_mut((y + 1) * stride);
            let (above, below) = (&above[y * stride + 1..], &mut below[..stride]);
            below[0] = 0;
            let mut row_sum = 0_i32;
            for ((sum, over), &grey) in below[1..].iter_mut().zip(above).zip(image.row(y)) {
                row_sum = row_sum.wrapping_add(i32::from(grey));
                *sum = row_sum.wrapping_add(*over);
            }
        }
        Self { width, height, step: 1, octave: 0, phase_length: stride, sums }
    }

    /// The same sums for samples twice as far apart.
    pub fn halved(&self) -> Self {
        let phase_length = self.phase_length.div_ceil(2);
        let mut sums = Numbers::new(2 * self.step * phase_length * (self.height + 1));
        let rows = self.sums.chunks_exact(self.step * self.phase_length);
        for (from, to) in rows.zip(sums.chunks_exact_mut(2 * self.step * phase_length)) {
            let (first, second) = to.split_at_mut(self.step * phase_length);
            let phases = first.chunks_exact_mut(phase_length).zip(second.chunks_exact_mut(phase_length));
            for (phase, (even, odd)) in from.chunks_exact(self.phase_length).zip(phases) {
                let pairs = phase.chunks_exact(2);
                if let ([last], Some(end)) = (pairs.remainder(), even.last_mut()) {
                    *end = *last;
                }
                for ((pair, even), odd) in pairs.zip(even.iter_mut()).zip(odd.iter_mut()) {
                    *even = pair[0];
                    *odd = pair[1];
                }
            }
        }
        let (width, height, step, octave) = (self.width, self.height, 2 * self.step, self.octave + 1);
        Self { width, height, step, octave, phase_length, sums }
    }

    /// The sums at row `y` and columns `x`, `x + step`, ..., `n` of them.
    #[inline(always)]
    pub fn samples(&self, x: usize, y: usize, n: usize) -> &[i32] {
        let phase = x & (self.step - 1);
        let start = (y * self.step + phase) * self.phase_length + (x >> self.octave);
        &self.sums[start..start + n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_brute_force_sums_at_every_step() {
        let pixels = (0..17 * 11).map(|i| (i * 37 % 251) as u8).collect();
        let image = GreyImage::new(17, 11, pixels).unwrap();
        let mut integral = Integral::of(&image);
        for _ in 0..4 {
            for y in 0..=11 {
                for x in 0..=17 {
                    let n = (17 - x) / integral.step + 1;
                    for (k, &sum) in integral.samples(x, y, n).iter().enumerate() {
                        let right = x + k * integral.step;
                        let brute: i32 = (0..y)
                            .flat_map(|v| (0..right).map(move |u| (u, v)))
                            .map(|(u, v)| i32::from(image.at(u, v)))
                            .sum();
                        assert_eq!(sum, brute, "step {} at ({right}, {y})", integral.step);
                    }
                }
            }
            integral = integral.halved();
        }
    }
}
