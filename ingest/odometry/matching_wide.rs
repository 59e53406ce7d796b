//! The comparisons of [`matching`](crate::matching), four candidates at a time with AVX2. Integers: the same matches on every machine.

use crate::index::{Index, Window};
use crate::matching::Best;

/// Bits of a partner's index in a key of 32 bits; the rest holds the distance, at most 64 * 255.
const INDEX_BITS: u32 = 18;

/// Whether the machine has AVX2 and there are few enough points for short keys.
pub(crate) fn can<const N: usize>(a: &Index<N>, b: &Index<N>) -> bool {
    // The greatest key means none.
    let few = a.len().max(b.len()) < (1 << INDEX_BITS) - 1;
    #[cfg(target_arch = "x86_64")]
    return few && is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

/// Offers every pair to both sides. Call it where [`can`] says so.
pub(crate) fn compare<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    window: impl FnMut(usize) -> Option<Window>,
    of_a: &mut Best,
    of_b: &mut Best,
) {
    assert!(can(a, b), "asked for what the machine or the number of points does not allow");
    #[cfg(target_arch = "x86_64")]
    // SAFETY: the machine has AVX2.
    unsafe {
        avx2::compare(a, b, window, of_a, of_b);
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::INDEX_BITS;
    use crate::index::{Index, Window, distance};
    use crate::matching::{Best, Key, NONE, key};
    use std::arch::x86_64::*;

    /// Candidates at a time.
    const LANES: usize = 4;
    /// A distance over a partner's index, as in [`Key`] but shorter.
    type Short = u32;
    const NOBODY: Short = Short::MAX;

    fn long(short: Short) -> Key {
        if short == NOBODY { NONE } else { key(short >> INDEX_BITS, (short & ((1 << INDEX_BITS) - 1)) as usize) }
    }

    /// The best and second best of one point, as they come.
    #[derive(Clone, Copy)]
    struct Two {
        first: Short,
        second: Short,
    }

    impl Two {
        #[inline(always)]
        fn offer(&mut self, key: Short) {
            self.second = self.second.min(self.first.max(key));
            self.first = self.first.min(key);
        }
    }

    #[target_feature(enable = "avx2")]
    pub fn compare<const N: usize>(
        a: &Index<N>,
        b: &Index<N>,
        mut window: impl FnMut(usize) -> Option<Window>,
        of_a: &mut Best,
        of_b: &mut Best,
    ) {
        let (mut first, mut second) = (vec![NOBODY; b.len()], vec![NOBODY; b.len()]);
        for i in 0..a.len() {
            let Some(window) = window(i) else { continue };
            let mut best = Two { first: NOBODY, second: NOBODY };
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
                let mut keys = [NOBODY; LANES];
                // SAFETY: the array has room for four lanes.
                unsafe { _mm_storeu_si128(keys.as_mut_ptr().cast(), lane) };
                keys.into_iter().for_each(|key| best.offer(key));
            }
            (of_a.first[i], of_a.second[i]) = (long(best.first), long(best.second));
        }
        of_b.first = first.into_iter().map(long).collect();
        of_b.second = second.into_iter().map(long).collect();
    }

    /// Offers point `i` of `a` and the points `j..j + 4` of `b` to each other, where those lie in the window. `best` holds the first and
    /// second of `i`, lane by lane; `theirs` those of the four.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn four<const N: usize>(
        a: &Index<N>,
        i: usize,
        b: &Index<N>,
        j: usize,
        window: Window,
        best: &mut [__m128i; 2],
        theirs: (&mut [Short], &mut [Short]),
    ) {
        const { assert!(N.is_multiple_of(32)) };
        let described = &a.descriptors[i];
        let candidates = &b.descriptors[j..j + LANES];
        // Sums of eight bytes are below 2^11 (two of them below 2^12), so the four candidates' share the words of one register.
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
        // All bits set is NOBODY.
        let nobody = _mm_or_si128(outside(&b.u, window.u), outside(&b.v, window.v));
        let indices = _mm_add_epi32(_mm_set1_epi32(j as i32), _mm_setr_epi32(0, 1, 2, 3));
        let ours = _mm_or_si128(nobody, _mm_or_si128(distances, indices));
        best[1] = _mm_min_epu32(best[1], _mm_max_epu32(best[0], ours));
        best[0] = _mm_min_epu32(best[0], ours);

        let key = _mm_or_si128(nobody, _mm_or_si128(distances, _mm_set1_epi32(i as i32)));
        let (first, second) = (theirs.0.as_mut_ptr().cast(), theirs.1.as_mut_ptr().cast());
        // SAFETY: both slices hold four keys.
        unsafe {
            let (before, runner_up) = (_mm_loadu_si128(first), _mm_loadu_si128(second));
            _mm_storeu_si128(second, _mm_min_epu32(runner_up, _mm_max_epu32(before, key)));
            _mm_storeu_si128(first, _mm_min_epu32(before, key));
        }
    }
}
