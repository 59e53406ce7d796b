//! The distance of two descriptors.

/// The sum of absolute differences of two descriptors; `N` is a multiple of 16.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn distance<const N: usize>(a: &[u8; N], b: &[u8; N]) -> u32 {
    use std::arch::x86_64::{
        _mm_add_epi64, _mm_cvtsi128_si32, _mm_loadu_si128, _mm_sad_epu8, _mm_setzero_si128, _mm_unpackhi_epi64,
    };
    const { assert!(N.is_multiple_of(16)) };
    // SAFETY: SSE2 belongs to every x86-64 machine; 16 bytes from every `at` on lie inside both arrays.
    unsafe {
        let mut sums = _mm_setzero_si128();
        for at in (0..N).step_by(16) {
            let [x, y] = [a, b].map(|bytes| _mm_loadu_si128(bytes.as_ptr().add(at).cast()));
            sums = _mm_add_epi64(sums, _mm_sad_epu8(x, y));
        }
        _mm_cvtsi128_si32(_mm_add_epi64(sums, _mm_unpackhi_epi64(sums, sums))) as u32
    }
}

/// The sum of absolute differences of two descriptors.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub(super) fn distance<const N: usize>(a: &[u8; N], b: &[u8; N]) -> u32 {
    a.iter().zip(b).map(|(&x, &y)| u32::from(x.abs_diff(y))).sum()
}
