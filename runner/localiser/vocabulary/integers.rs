//! The screening of all words where the processor multiplies integers and sums them up in one go (AVX-512 VNNI):
//! descriptors and words as integers of 14 bits, with a bound on what that rounding can change. Twice as many products
//! a cycle as in single precision.

use super::dimensions::{DIMENSIONS, Descriptor};
use super::search::{LANES, Search};

/// Numbers that one instruction multiplies and sums up in each lane.
const SUMMED: usize = 2;
/// The greatest integer: sums of 64 products of two, with every sign, fit 32 bits.
const GREATEST: f32 = 5790.0;
/// Added to a small number, it leaves no place for a fraction: the last bits of the sum are the nearest integer.
const SHIFT: f32 = 1.5 * (1 << 23) as f32;

/// Words as integers.
#[derive(Debug, Clone, Default)]
pub(super) struct IntegerWords {
    blocks: Vec<Block>,
    /// The greatest distance of a word to what its integers say.
    largest_error: f64,
}

/// Sixteen words, two dimensions by two.
#[derive(Debug, Clone)]
struct Block {
    numbers: [[[i16; SUMMED]; LANES]; DIMENSIONS / SUMMED],
    /// What 1 stands for, in each word.
    unit: [f32; LANES],
}

/// A descriptor as integers.
pub(super) struct IntegerDescriptor {
    numbers: [i16; DIMENSIONS],
    /// What 1 stands for.
    unit: f32,
    /// Its distance to what its integers say.
    error: f64,
    /// The length of what they say.
    norm: f64,
}

/// Whether the processor has AVX-512 VNNI.
pub(super) fn are_fast() -> bool {
    #[cfg(target_arch = "x86_64")]
    return is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vnni");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

impl IntegerDescriptor {
    pub fn of(descriptor: &Descriptor) -> Self {
        let greatest = descriptor.iter().fold(0.0_f32, |greatest, number| greatest.max(number.abs()));
        // Of less than this there is no reciprocal; the numbers are zero, and the error says so.
        let unit = (greatest / GREATEST).max(f32::MIN_POSITIVE);
        let per_unit = 1.0 / unit;
        let numbers =
            descriptor.map(|number| ((number * per_unit).clamp(-GREATEST, GREATEST) + SHIFT).to_bits() as i16);
        let (mut error, mut norm) = (0.0, 0.0);
        for (number, integer) in descriptor.iter().zip(numbers) {
            let said = f64::from(integer) * f64::from(unit);
            error += (f64::from(*number) - said).powi(2);
            norm += said * said;
        }
        Self { numbers, unit, error: error.sqrt(), norm: norm.sqrt() }
    }
}

impl IntegerWords {
    /// Adds a word behind `len` others.
    pub fn push(&mut self, word: &Descriptor, len: usize) {
        let lane = len % LANES;
        if lane == 0 {
            let numbers = [[[0; SUMMED]; LANES]; DIMENSIONS / SUMMED];
            self.blocks.push(Block { numbers, unit: [0.0; LANES] });
        }
        let word = IntegerDescriptor::of(word);
        let block = &mut self.blocks[len / LANES];
        for (row, numbers) in block.numbers.iter_mut().zip(word.numbers.as_chunks().0) {
            row[lane] = *numbers;
        }
        block.unit[lane] = word.unit;
        self.largest_error = self.largest_error.max(word.error);
    }

    /// How far a product of this descriptor with a word may be from that of their integers, words being no longer than
    /// `largest_norm`: by d.w - d'.w' = (d - d').w + d'.(w - w').
    pub fn error(&self, descriptor: &IntegerDescriptor, largest_norm: f64) -> f64 {
        descriptor.error * largest_norm + descriptor.norm * self.largest_error
    }

    /// Collects in `searches` every word that may be nearest to one of the descriptors. Call it where [`are_fast`] says
    /// so.
    pub fn screen(&self, half_norms: &[[f32; LANES]], group: &[IntegerDescriptor], searches: &mut [Search]) {
        assert!(are_fast(), "asked for what the processor cannot do");
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has AVX-512 VNNI.
        unsafe {
            vnni::screen(&self.blocks, half_norms, group, searches);
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod vnni {
    use super::{Block, IntegerDescriptor, SUMMED};
    use crate::vocabulary::search::{LANES, Search};
    use std::arch::x86_64::*;

    /// Descriptors scored against a block at once: one register of sums each.
    const TILE: usize = 12;

    #[target_feature(enable = "avx512f,avx512vnni")]
    pub fn screen(blocks: &[Block], half_norms: &[[f32; LANES]], group: &[IntegerDescriptor], searches: &mut [Search]) {
        for (index, (block, half_norms)) in blocks.iter().zip(half_norms).enumerate() {
            // SAFETY: sixteen numbers are read each time.
            let (half_norms, units) =
                unsafe { (_mm512_loadu_ps(half_norms.as_ptr()), _mm512_loadu_ps(block.unit.as_ptr())) };
            for (tile, searches) in group.chunks(TILE).zip(searches.chunks_mut(TILE)) {
                let sums = products(block, std::array::from_fn(|i| &tile[i.min(tile.len() - 1)]));
                for ((descriptor, search), sum) in tile.iter().zip(searches).zip(sums) {
                    let unit = _mm512_mul_ps(units, _mm512_set1_ps(descriptor.unit));
                    let scores = _mm512_fnmadd_ps(unit, _mm512_cvtepi32_ps(sum), half_norms);
                    if _mm512_cmp_ps_mask::<_CMP_LE_OQ>(scores, _mm512_set1_ps(search.limit())) != 0 {
                        let mut stored = [0.0; LANES];
                        // SAFETY: there is room for sixteen numbers.
                        unsafe { _mm512_storeu_ps(stored.as_mut_ptr(), scores) };
                        search.note((index * LANES) as u32, &stored);
                    }
                }
            }
        }
    }

    /// The products of the integers of sixteen words and of each descriptor.
    #[inline]
    #[target_feature(enable = "avx512f,avx512vnni")]
    fn products(block: &Block, tile: [&IntegerDescriptor; TILE]) -> [__m512i; TILE] {
        let mut sums = [_mm512_setzero_si512(); TILE];
        for (k, words) in block.numbers.iter().enumerate() {
            // SAFETY: sixteen times two numbers of two bytes are read.
            let words = unsafe { _mm512_loadu_si512(words.as_ptr().cast()) };
            for (sum, descriptor) in sums.iter_mut().zip(tile) {
                let [low, high] = descriptor.numbers.as_chunks::<SUMMED>().0[k];
                let pair = i32::from(high) << 16 | i32::from(low as u16);
                *sum = _mm512_dpwssd_epi32(*sum, _mm512_set1_epi32(pair), words);
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn product(a: &Descriptor, b: &Descriptor) -> f64 {
        a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    }

    proptest! {
        #[test]
        fn integers_err_by_no_more_than_they_say(
            numbers in proptest::collection::vec(-1.0f32..1.0, 17 * DIMENSIONS),
            exponent in -44i32..4,
        ) {
            let rows: Vec<Descriptor> =
                numbers.as_chunks::<DIMENSIONS>().0.iter().map(|row| row.map(|v| v * 10f32.powi(exponent))).collect();
            let (descriptor, words) = (&rows[0], &rows[1..]);
            let mut integers = IntegerWords::default();
            words.iter().enumerate().for_each(|(len, word)| integers.push(word, len));
            let of_descriptor = IntegerDescriptor::of(descriptor);
            let largest_norm = words.iter().map(|word| product(word, word).sqrt()).fold(0.0, f64::max);
            for (lane, word) in words.iter().enumerate() {
                let sum: i32 = (of_descriptor.numbers.iter().enumerate())
                    .map(|(k, number)| i32::from(*number) * i32::from(integers.blocks[0].numbers[k / SUMMED][lane][k % SUMMED]))
                    .sum();
                let said = f64::from(sum) * f64::from(integers.blocks[0].unit[lane]) * f64::from(of_descriptor.unit);
                let error = (product(descriptor, word) - said).abs();
                let bound = integers.error(&of_descriptor, largest_norm);
                prop_assert!(error <= bound * (1.0 + 1e-9), "{error} {bound}");
            }
        }
    }

    #[test]
    fn the_largest_sums_fit() {
        for sign in [1.0, -1.0] {
            let (one, other) =
                (IntegerDescriptor::of(&[0.5; DIMENSIONS]), IntegerDescriptor::of(&[sign * 0.5; DIMENSIONS]));
            let products = one.numbers.iter().zip(other.numbers).map(|(a, b)| i64::from(*a) * i64::from(b));
            let sum: i64 = products.sum();
            assert!(i32::try_from(sum).is_ok() && sum.abs() > i64::from(i32::MAX) / 2, "{sum}");
        }
    }
}
