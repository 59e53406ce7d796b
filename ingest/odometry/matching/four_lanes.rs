//! The comparisons of mutual matching, four candidates at a time with AVX2. All numbers are integers, so the matches
//! are equal on every machine.

use super::best::Best;
use crate::features::{Index, Window};

/// Bits of the partner's index in a key of 32 bits. The others hold the distance, at most 64 * 255.
const INDEX_BITS: u32 = 18;

/// Whether the machine has AVX2 and the points are few enough for short keys.
pub(super) fn is_available<const N: usize>(a: &Index<N>, b: &Index<N>) -> bool {
    // The greatest key stands for no partner.
    let few = a.len().max(b.len()) < (1 << INDEX_BITS) - 1;
    #[cfg(target_arch = "x86_64")]
    return few && is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

/// Compares every pair and updates the best partners of both points. Panics unless [`is_available`].
pub(super) fn compare<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    window: impl FnMut(usize) -> Option<Window>,
    best_of_a: &mut Best,
    best_of_b: &mut Best,
) {
    assert!(is_available(a, b), "four lanes need AVX2 and keys of {INDEX_BITS} bits");
    #[cfg(target_arch = "x86_64")]
    // SAFETY: the machine has AVX2.
    unsafe {
        avx2::compare(a, b, window, best_of_a, best_of_b);
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::INDEX_BITS;
    use crate::features::{Index, Window};
    use crate::matching::best::{Best, Key, NO_KEY, make_key};
    use crate::matching::distance::distance;
    use std::arch::x86_64::{
        __m128i, _mm_add_epi16, _mm_add_epi32, _mm_cmpgt_epi32, _mm_cvtepi16_epi32, _mm_cvtepu16_epi32,
        _mm_cvtsi32_si128, _mm_loadl_epi64, _mm_loadu_si128, _mm_max_epu32, _mm_min_epu32, _mm_or_si128,
        _mm_set1_epi32, _mm_setr_epi32, _mm_slli_epi32, _mm_storeu_si128, _mm_unpackhi_epi64, _mm256_add_epi64,
        _mm256_castsi256_si128, _mm256_extracti128_si256, _mm256_loadu_si256, _mm256_or_si256, _mm256_sad_epu8,
        _mm256_setzero_si256, _mm256_sll_epi64,
    };

    /// Candidates at a time.
    const LANES: usize = 4;
    /// A [`Key`] of 32 bits.
    type ShortKey = u32;
    /// The short key of no partner.
    const NO_SHORT_KEY: ShortKey = ShortKey::MAX;

    fn widen_key(short: ShortKey) -> Key {
        if short == NO_SHORT_KEY {
            NO_KEY
        } else {
            make_key(short >> INDEX_BITS, (short & ((1 << INDEX_BITS) - 1)) as usize)
        }
    }

    /// The best and second best partner of one point.
    #[derive(Clone, Copy)]
    struct Two {
        first: ShortKey,
        second: ShortKey,
    }

    impl Two {
        #[inline(always)]
        fn offer(&mut self, key: ShortKey) {
            self.second = self.second.min(self.first.max(key));
            self.first = self.first.min(key);
        }
    }

    /// As the function around this module, on AVX2.
    #[target_feature(enable = "avx2")]
    pub fn compare<const N: usize>(
        a: &Index<N>,
        b: &Index<N>,
        mut window: impl FnMut(usize) -> Option<Window>,
        best_of_a: &mut Best,
        best_of_b: &mut Best,
    ) {
        let (mut first, mut second) = (vec![NO_SHORT_KEY; b.len()], vec![NO_SHORT_KEY; b.len()]);
        for i in 0..a.len() {
            let Some(window) = window(i) else { continue };
            let mut best = Two { first: NO_SHORT_KEY, second: NO_SHORT_KEY };
            let mut lanes = [_mm_set1_epi32(-1); 2];
            b.for_each_run(a.class[i], window, |run| {
                let mut j = run.start;
                while j + LANES <= run.end {
                    four(a, i, b, j, window, &mut lanes, (&mut first[j..j + LANES], &mut second[j..j + LANES]));
                    j += LANES;
                }
                for j in j..run.end {
                    let (u, v) = (i32::from(b.u[j]), i32::from(b.v[j]));
                    if (u >= window.u.0) & (u <= window.u.1) & (v >= window.v.0) & (v <= window.v.1) {
                        let distance = distance(&a.descriptors[i], &b.descriptors[j]) << INDEX_BITS;
                        best.offer(distance | j as u32);
                        let mut theirs = Two { first: first[j], second: second[j] };
                        theirs.offer(distance | i as u32);
                        (first[j], second[j]) = (theirs.first, theirs.second);
                    }
                }
            });
            for lane in lanes {
                let mut keys = [NO_SHORT_KEY; LANES];
                // SAFETY: the array has room for four lanes.
                unsafe { _mm_storeu_si128(keys.as_mut_ptr().cast(), lane) };
                keys.into_iter().for_each(|key| best.offer(key));
            }
            (best_of_a.first[i], best_of_a.second[i]) = (widen_key(best.first), widen_key(best.second));
        }
        best_of_b.first = first.into_iter().map(widen_key).collect();
        best_of_b.second = second.into_iter().map(widen_key).collect();
    }

    /// Compares point `i` of `a` with those of the points `j..j + 4` of `b` that lie in the window. `best` holds the
    /// best and second best of `i`, lane by lane; `theirs` those of the four.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn four<const N: usize>(
        a: &Index<N>,
        i: usize,
        b: &Index<N>,
        j: usize,
        window: Window,
        best: &mut [__m128i; 2],
        theirs: (&mut [ShortKey], &mut [ShortKey]),
    ) {
        const { assert!(N.is_multiple_of(32)) };
        let described = &a.descriptors[i];
        let candidates = &b.descriptors[j..j + LANES];
        // A sum of eight bytes is below 2^11, two of them below 2^12, so those of four candidates share the 16-bit
        // words of one register.
        let mut words = _mm256_setzero_si256();
        for (k, candidate) in candidates.iter().enumerate() {
            let mut sums = _mm256_setzero_si256();
            for at in (0..N).step_by(32) {
                // SAFETY: 32 bytes from `at` on lie inside both arrays.
                let [x, y] =
                    unsafe { [described, candidate].map(|bytes| _mm256_loadu_si256(bytes.as_ptr().add(at).cast())) };
                sums = _mm256_add_epi64(sums, _mm256_sad_epu8(x, y));
            }
            words = _mm256_or_si256(words, _mm256_sll_epi64(sums, _mm_cvtsi32_si128(16 * k as i32)));
        }
        let halves = _mm_add_epi16(_mm256_castsi256_si128(words), _mm256_extracti128_si256::<1>(words));
        let totals = _mm_cvtepu16_epi32(_mm_add_epi16(halves, _mm_unpackhi_epi64(halves, halves)));
        let distances = _mm_slli_epi32::<{ INDEX_BITS as i32 }>(totals);

        let outside = |values: &[i16], (low, high): (i32, i32)| {
            // SAFETY: four values of two bytes are read.
            let four = _mm_cvtepi16_epi32(unsafe { _mm_loadl_epi64(values[j..j + LANES].as_ptr().cast()) });
            _mm_or_si128(_mm_cmpgt_epi32(_mm_set1_epi32(low), four), _mm_cmpgt_epi32(four, _mm_set1_epi32(high)))
        };
        // All bits set is NO_SHORT_KEY.
        let excluded = _mm_or_si128(outside(&b.u, window.u), outside(&b.v, window.v));
        let indices = _mm_add_epi32(_mm_set1_epi32(j as i32), _mm_setr_epi32(0, 1, 2, 3));
        let ours = _mm_or_si128(excluded, _mm_or_si128(distances, indices));
        best[1] = _mm_min_epu32(best[1], _mm_max_epu32(best[0], ours));
        best[0] = _mm_min_epu32(best[0], ours);

        let key = _mm_or_si128(excluded, _mm_or_si128(distances, _mm_set1_epi32(i as i32)));
        let (first, second) = (theirs.0.as_mut_ptr().cast(), theirs.1.as_mut_ptr().cast());
        // SAFETY: both slices hold four keys.
        unsafe {
            let (before, runner_up) = (_mm_loadu_si128(first), _mm_loadu_si128(second));
            _mm_storeu_si128(second, _mm_min_epu32(runner_up, _mm_max_epu32(before, key)));
            _mm_storeu_si128(first, _mm_min_epu32(before, key));
        }
    }
}
