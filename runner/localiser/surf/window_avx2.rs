//! Turned windows with eight samples to a register: the arithmetic of [`TurnedRows`], operation by operation, so the
//! same bits.

use super::patch::{Columns, LANES};
use super::window::{FRACTION, HALF, Quads, TurnedRows};
use std::arch::x86_64::*;

/// [`TurnedRows`] for AVX2. The first register of a pair holds rows 0, 1, 4, 5, the second rows 2, 3, 6, 7, so that the
/// halves of their words, taken together, come out in order.
pub(super) struct TurnedRowsAvx2<'a> {
    quads: &'a Quads,
    x: [__m256i; 2],
    y: [__m256i; 2],
    dx: __m256i,
    dy: __m256i,
    is_inside: bool,
}

impl<'a> TurnedRowsAvx2<'a> {
    /// The same rows as `rows`.
    ///
    /// # Safety
    /// The processor has AVX2, now and whenever the rows are read.
    #[inline(always)]
    pub unsafe fn new(rows: &TurnedRows<'a>) -> Self {
        // SAFETY: AVX2 by this function's contract.
        unsafe {
            let pair = |[a, b, c, d, e, f, g, h]: [i64; LANES]| {
                [_mm256_setr_epi64x(a, b, e, f), _mm256_setr_epi64x(c, d, g, h)]
            };
            Self {
                quads: rows.quads,
                x: pair(rows.x),
                y: pair(rows.y),
                dx: _mm256_set1_epi64x(rows.dx),
                dy: _mm256_set1_epi64x(rows.dy),
                is_inside: rows.is_inside,
            }
        }
    }
}

/// The whole pixels of eight coordinates.
#[inline(always)]
unsafe fn whole([first, second]: [__m256i; 2]) -> __m256i {
    // SAFETY: AVX2 by the contract of the only caller.
    unsafe {
        let [first, second] = [_mm256_castsi256_ps(first), _mm256_castsi256_ps(second)];
        _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(first, second))
    }
}

/// The fractions of eight coordinates.
#[inline(always)]
unsafe fn part([first, second]: [__m256i; 2]) -> __m256 {
    // SAFETY: AVX2 by the contract of the only caller.
    unsafe {
        let [first, second] = [_mm256_castsi256_ps(first), _mm256_castsi256_ps(second)];
        let fraction = _mm256_castps_si256(_mm256_shuffle_ps::<0b10_00_10_00>(first, second));
        _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_srli_epi32::<1>(fraction)), _mm256_set1_ps(FRACTION))
    }
}

/// The nearest of the whole numbers from 0 to `last`.
#[inline(always)]
unsafe fn nearest(values: [__m256i; 2], last: __m256i) -> __m256i {
    // SAFETY: AVX2 by the contract of the only caller.
    unsafe {
        let nearest = whole(values.map(|values| _mm256_add_epi64(values, _mm256_set1_epi64x(HALF))));
        _mm256_min_epi32(_mm256_max_epi32(nearest, _mm256_setzero_si256()), last)
    }
}

impl Columns for TurnedRowsAvx2<'_> {
    #[inline(always)]
    fn next_column(&mut self) -> [f32; LANES] {
        // SAFETY: AVX2 by the contract of `new`. Entries up to `last` are read, which `quads`, never empty here, has.
        unsafe {
            let (mut column, mut right) = (whole(self.x), part(self.x));
            let (mut row, mut down) = (whole(self.y), part(self.y));
            if !self.is_inside {
                let last_x = _mm256_set1_epi32(self.quads.width as i32 - 1);
                let last_y = _mm256_set1_epi32(self.quads.height as i32 - 1);
                let least = _mm256_set1_epi32(-1);
                let in_row = _mm256_and_si256(_mm256_cmpgt_epi32(column, least), _mm256_cmpgt_epi32(last_x, column));
                let in_column = _mm256_and_si256(_mm256_cmpgt_epi32(row, least), _mm256_cmpgt_epi32(last_y, row));
                let inside = _mm256_and_si256(in_row, in_column);
                column = _mm256_blendv_epi8(nearest(self.x, last_x), column, inside);
                row = _mm256_blendv_epi8(nearest(self.y, last_y), row, inside);
                right = _mm256_and_ps(right, _mm256_castsi256_ps(inside));
                down = _mm256_and_ps(down, _mm256_castsi256_ps(inside));
            }
            let index = _mm256_add_epi32(_mm256_mullo_epi32(row, _mm256_set1_epi32(self.quads.width as i32)), column);
            let last = _mm256_set1_epi32(self.quads.pairs.len().saturating_sub(2) as i32);
            let index = _mm256_min_epu32(index, last);
            // Eight plain loads: gather instructions are slower on many processors.
            let mut entries = [0_u32; LANES];
            _mm256_storeu_si256(entries.as_mut_ptr().cast(), index);
            let first = self.quads.pairs.as_ptr();
            let [a, b, c, d, e, f, g, h] =
                entries.map(|entry| first.add(entry as usize).cast::<i32>().read_unaligned());
            let words = _mm256_setr_epi32(a, b, c, d, e, f, g, h);
            for (x, y) in self.x.iter_mut().zip(&mut self.y) {
                *x = _mm256_add_epi64(*x, self.dx);
                *y = _mm256_add_epi64(*y, self.dy);
            }
            let byte = _mm256_set1_epi32(255);
            let grey = [
                _mm256_and_si256(words, byte),
                _mm256_and_si256(_mm256_srli_epi32::<8>(words), byte),
                _mm256_and_si256(_mm256_srli_epi32::<16>(words), byte),
                _mm256_srli_epi32::<24>(words),
            ]
            .map(|grey| _mm256_cvtepi32_ps(grey));
            let one = _mm256_set1_ps(1.0);
            let (left, up) = (_mm256_sub_ps(one, right), _mm256_sub_ps(one, down));
            let part = |k: usize, across, along| _mm256_mul_ps(_mm256_mul_ps(grey[k], across), along);
            let upper = _mm256_add_ps(part(0, left, up), part(2, right, up));
            let sum = _mm256_add_ps(_mm256_add_ps(upper, part(1, left, down)), part(3, right, down));
            let rounded = _mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(sum);
            let mut greys = [0.0; LANES];
            _mm256_storeu_ps(greys.as_mut_ptr(), rounded);
            greys
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surf::window::Turn;
    use furrow_model::GreyImage;

    /// Both ways of sampling, inside the image and across each of its edges, to the last bit.
    #[test]
    fn samples_are_the_portable_ones() {
        if !is_x86_feature_detected!("avx2") {
            return;
        }
        let pixels: Vec<u8> = (0..90 * 70).map(|i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let quads = Quads::of(&GreyImage::new(90, 70, pixels).unwrap());
        let mut blocks = Vec::new();
        for (x, y, side) in [(45.3, 35.1, 31), (3.7, 30.0, 31), (80.0, 66.25, 40), (45.0, 35.0, 150)] {
            for degrees in [0.0_f32, 33.0, 90.0, 211.5, 359.0] {
                let turn = Turn::new(x, y, degrees.to_radians(), side);
                let inside = (0..side).step_by(LANES).filter(|&row| check(&turn, &quads, side, row)).count();
                blocks.push(inside);
            }
        }
        // Windows wholly inside, partly and not at all.
        assert!(
            blocks.contains(&4) && blocks.contains(&0) && blocks.iter().any(|inside| (1..4).contains(inside)),
            "{blocks:?}"
        );
    }

    /// Holds eight rows against the portable ones; whether they lie inside the image.
    fn check(turn: &Turn, quads: &Quads, side: usize, row: usize) -> bool {
        let mut portable = turn.rows(quads, side, row);
        // SAFETY: the test asked for AVX2.
        let mut fast = unsafe { TurnedRowsAvx2::new(&portable) };
        for column in 0..side {
            let (want, have) = (portable.next_column(), fast.next_column());
            assert_eq!(have.map(f32::to_bits), want.map(f32::to_bits), "column {column}");
        }
        portable.is_inside
    }
}
