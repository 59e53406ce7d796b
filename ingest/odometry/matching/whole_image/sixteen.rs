//! Distances of one point to sixteen others at a time.

use crate::features::{Blocks, LANES, REGISTER, SUMMED, Window};
use std::arch::x86_64::{
    __m256i, _mm256_add_epi64, _mm256_cmpeq_epi16, _mm256_cmpgt_epi16, _mm256_loadu_si256, _mm256_movemask_epi8,
    _mm256_or_si256, _mm256_sad_epu8, _mm256_set1_epi16, _mm256_set1_epi64x, _mm256_setzero_si256, _mm256_slli_epi64,
    _mm256_storeu_si256,
};

/// The distance of no point. The greatest distance is 64 * 255.
pub(super) const NO_DISTANCE: u16 = u16::MAX;
/// Registers of the longest descriptor, 64 bytes.
const PARTS: usize = 8;

/// A point and its window, repeated in all lanes.
pub(super) struct Query {
    /// Eight bytes of the descriptor in each register, four times.
    parts: [__m256i; PARTS],
    columns: [__m256i; 2],
    rows: [__m256i; 2],
}

impl Query {
    #[inline]
    #[target_feature(enable = "avx2")]
    pub fn new<const N: usize>(descriptor: &[u8; N], window: Window) -> Self {
        let mut parts = [_mm256_setzero_si256(); PARTS];
        for (part, bytes) in parts.iter_mut().zip(descriptor.chunks_exact(SUMMED)) {
            *part = _mm256_set1_epi64x(bytes.iter().rev().fold(0, |word, byte| word << 8 | i64::from(*byte)));
        }
        Self { parts, columns: in_all_lanes(window.u), rows: in_all_lanes(window.v) }
    }
}

/// Two bounds, repeated in all lanes.
#[inline]
#[target_feature(enable = "avx2")]
fn in_all_lanes((low, high): (i32, i32)) -> [__m256i; 2] {
    // The least number is the position of padding, which is outside of every window.
    let bound = |at: i32| at.clamp((i16::MIN + 1).into(), i16::MAX.into()) as i16;
    [_mm256_set1_epi16(bound(low)), _mm256_set1_epi16(bound(high))]
}

/// Two bits for each of sixteen lanes that is equal.
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn equal_lanes(a: __m256i, b: __m256i) -> u32 {
    _mm256_movemask_epi8(_mm256_cmpeq_epi16(a, b)) as u32
}

/// The numbers of sixteen lanes.
#[inline]
pub(super) fn to_array(lanes: __m256i) -> [u16; LANES] {
    let mut distances = [NO_DISTANCE; LANES];
    // SAFETY: the array has room for sixteen lanes, and the store belongs to AVX.
    unsafe { _mm256_storeu_si256(distances.as_mut_ptr().cast(), lanes) };
    distances
}

/// The distances to the points of the block at `j`; [`NO_DISTANCE`] for points outside the window.
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn sixteen_distances<const N: usize>(query: &Query, b: &Blocks<N>, j: usize) -> __m256i {
    let block = &b.bytes[j * N..j * N + Blocks::<N>::BLOCK];
    // A distance is below 2^16, so 64 bits hold those of four groups.
    let (p, q) = (four_distances::<N>(query, block, 0), four_distances::<N>(query, block, 1));
    let (r, s) = (four_distances::<N>(query, block, 2), four_distances::<N>(query, block, 3));
    let (pq, rs) = (_mm256_or_si256(p, _mm256_slli_epi64::<16>(q)), _mm256_or_si256(r, _mm256_slli_epi64::<16>(s)));
    let totals = _mm256_or_si256(pq, _mm256_slli_epi64::<32>(rs));
    let excluded = _mm256_or_si256(outside(&b.u[j..j + LANES], query.columns), outside(&b.v[j..j + LANES], query.rows));
    // All bits set is NO_DISTANCE.
    _mm256_or_si256(totals, excluded)
}

/// The distances to the four points of a group, 64 bits each.
#[inline]
#[target_feature(enable = "avx2")]
fn four_distances<const N: usize>(query: &Query, block: &[u8], group: usize) -> __m256i {
    const { assert!(N.is_multiple_of(SUMMED) && N / SUMMED <= PARTS) };
    let group = &block[group * 4 * N..(group + 1) * 4 * N];
    let mut sums = _mm256_setzero_si256();
    let mut k = 0;
    while k < N / SUMMED {
        // SAFETY: a register's bytes are read from inside the group.
        let bytes = unsafe { _mm256_loadu_si256(group[k * REGISTER..(k + 1) * REGISTER].as_ptr().cast()) };
        sums = _mm256_add_epi64(sums, _mm256_sad_epu8(query.parts[k], bytes));
        k += 1;
    }
    sums
}

/// All bits set in each of sixteen lanes whose position lies outside of two bounds.
#[inline]
#[target_feature(enable = "avx2")]
fn outside(positions: &[i16], [low, high]: [__m256i; 2]) -> __m256i {
    assert!(positions.len() == LANES);
    // SAFETY: sixteen values of two bytes are read.
    let positions = unsafe { _mm256_loadu_si256(positions.as_ptr().cast()) };
    _mm256_or_si256(_mm256_cmpgt_epi16(low, positions), _mm256_cmpgt_epi16(positions, high))
}
