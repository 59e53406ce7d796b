//! The comparisons, sixteen at a time. No closure is handed to the library here: its functions know nothing of AVX2, and what they call would
//! not be inlined.

use super::blocks::{Blocks, LANES, REGISTER, SUMMED};
use crate::index::{Index, Window};
use crate::matching::Match;
use std::arch::x86_64::*;

/// No distance: the greatest is 64 * 255.
const NOBODY: u16 = u16::MAX;
/// Registers of a descriptor of the greatest length, 64 bytes.
const PARTS: usize = 8;

/// The least and second least distance of every point of one side.
struct Least {
    first: Vec<u16>,
    second: Vec<u16>,
}

impl Least {
    fn of(count: usize) -> Self {
        Self { first: vec![NOBODY; count], second: vec![NOBODY; count] }
    }

    /// Whether a point's least distance stands out.
    fn is_distinct(&self, i: usize, ratio: f64) -> bool {
        let (first, second) = (self.first[i], self.second[i]);
        first != NOBODY && (second == NOBODY || f64::from(first) < ratio * f64::from(second))
    }
}

/// The pairs that stand out on both sides.
#[target_feature(enable = "avx2")]
pub(super) fn distinct_pairs<const N: usize>(
    a: &Index<N>,
    b: &Blocks<N>,
    ratio: f64,
    window: impl Fn(usize) -> Option<Window>,
) -> Vec<Match> {
    let (mut of_a, mut of_b) = (Least::of(a.len()), Least::of(b.names.len()));
    for i in 0..a.len() {
        let Some(window) = window(i) else { continue };
        let query = Query::of(&a.descriptors[i], window);
        (of_a.first[i], of_a.second[i]) = offer(&query, a.class[i], window, b, &mut of_b);
    }
    let mut pairs = Vec::new();
    for i in (0..a.len()).filter(|&i| of_a.is_distinct(i, ratio)) {
        let Some(window) = window(i) else { continue };
        let (query, distance) = (Query::of(&a.descriptors[i], window), of_a.first[i]);
        // What stands out on both sides is one and the same pair.
        let partner = find(&query, a.class[i], window, b, (distance, &of_b.first));
        if let Some(partner) = partner.filter(|&partner| of_b.is_distinct(partner, ratio)) {
            pairs.push(Match { a: i as u32, b: b.names[partner], distance: distance.into() });
        }
    }
    pairs
}

/// A point with its window, in all lanes.
struct Query {
    /// Eight bytes of the descriptor in each, four times.
    parts: [__m256i; PARTS],
    columns: [__m256i; 2],
    rows: [__m256i; 2],
}

impl Query {
    #[inline]
    #[target_feature(enable = "avx2")]
    fn of<const N: usize>(descriptor: &[u8; N], window: Window) -> Self {
        let mut parts = [_mm256_setzero_si256(); PARTS];
        for (part, bytes) in parts.iter_mut().zip(descriptor.chunks_exact(SUMMED)) {
            *part = _mm256_set1_epi64x(bytes.iter().rev().fold(0, |word, byte| word << 8 | i64::from(*byte)));
        }
        Self { parts, columns: ends(window.u), rows: ends(window.v) }
    }
}

/// Two bounds in all lanes.
#[inline]
#[target_feature(enable = "avx2")]
fn ends((low, high): (i32, i32)) -> [__m256i; 2] {
    // The least number is the place of nobody, and outside of every window.
    let lanes = |at: i32| at.clamp((i16::MIN + 1).into(), i16::MAX.into()) as i16;
    [_mm256_set1_epi16(lanes(low)), _mm256_set1_epi16(lanes(high))]
}

/// Compares a query with all points in its window: its least two distances; each point's own are kept in `theirs`.
#[inline]
#[target_feature(enable = "avx2")]
fn offer<const N: usize>(query: &Query, class: u8, window: Window, b: &Blocks<N>, theirs: &mut Least) -> (u16, u16) {
    let mut least = [_mm256_set1_epi16(-1); 2];
    for run in b.runs(class, window) {
        let mut j = run.start;
        while j < run.end {
            let distances = sixteen(query, b, j);
            least[1] = _mm256_min_epu16(least[1], _mm256_max_epu16(least[0], distances));
            least[0] = _mm256_min_epu16(least[0], distances);
            let first = theirs.first[j..j + LANES].as_mut_ptr().cast();
            let second = theirs.second[j..j + LANES].as_mut_ptr().cast();
            // SAFETY: both hold sixteen distances from `j` on.
            unsafe {
                let (before, runner_up) = (_mm256_loadu_si256(first), _mm256_loadu_si256(second));
                _mm256_storeu_si256(second, _mm256_min_epu16(runner_up, _mm256_max_epu16(before, distances)));
                _mm256_storeu_si256(first, _mm256_min_epu16(before, distances));
            }
            j += LANES;
        }
    }
    let (mut first, mut second) = (NOBODY, NOBODY);
    for distance in least.into_iter().flat_map(unpacked) {
        second = second.min(first.max(distance));
        first = first.min(distance);
    }
    (first, second)
}

/// The first point in the window at exactly this distance, which must be its least, too.
#[inline]
#[target_feature(enable = "avx2")]
fn find<const N: usize>(
    query: &Query,
    class: u8,
    window: Window,
    b: &Blocks<N>,
    (distance, least_of_b): (u16, &[u16]),
) -> Option<usize> {
    let wanted = _mm256_set1_epi16(distance as i16);
    for run in b.runs(class, window) {
        let mut j = run.start;
        while j < run.end {
            // SAFETY: sixteen distances are read.
            let least = equal(unsafe { _mm256_loadu_si256(least_of_b[j..j + LANES].as_ptr().cast()) }, wanted);
            if least != 0 {
                let both = least & equal(sixteen(query, b, j), wanted);
                if both != 0 {
                    return Some(j + both.trailing_zeros() as usize / 2);
                }
            }
            j += LANES;
        }
    }
    None
}

/// Two bits for each lane that is equal.
#[inline]
#[target_feature(enable = "avx2")]
fn equal(a: __m256i, b: __m256i) -> u32 {
    _mm256_movemask_epi8(_mm256_cmpeq_epi16(a, b)) as u32
}

fn unpacked(lanes: __m256i) -> [u16; LANES] {
    let mut distances = [NOBODY; LANES];
    // SAFETY: the array has room for sixteen lanes, and the store belongs to AVX.
    unsafe { _mm256_storeu_si256(distances.as_mut_ptr().cast(), lanes) };
    distances
}

/// The distances to the points of the block at `j`; [`NOBODY`] for those outside the window.
#[inline]
#[target_feature(enable = "avx2")]
fn sixteen<const N: usize>(query: &Query, b: &Blocks<N>, j: usize) -> __m256i {
    let block = &b.bytes[j * N..j * N + Blocks::<N>::BLOCK];
    // Distances are below 2^14, so the four of a register's parts have room for three others each.
    let (p, q) = (four::<N>(query, block, 0), four::<N>(query, block, 1));
    let (r, s) = (four::<N>(query, block, 2), four::<N>(query, block, 3));
    let (pq, rs) = (_mm256_or_si256(p, _mm256_slli_epi64::<16>(q)), _mm256_or_si256(r, _mm256_slli_epi64::<16>(s)));
    let totals = _mm256_or_si256(pq, _mm256_slli_epi64::<32>(rs));
    let nobody = _mm256_or_si256(outside(&b.u[j..j + LANES], query.columns), outside(&b.v[j..j + LANES], query.rows));
    // All bits set is nobody.
    _mm256_or_si256(totals, nobody)
}

/// The distances to the four points of a group, each in 64 bits.
#[inline]
#[target_feature(enable = "avx2")]
fn four<const N: usize>(query: &Query, block: &[u8], group: usize) -> __m256i {
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

/// All bits where one of sixteen places lies outside of two bounds.
#[inline]
#[target_feature(enable = "avx2")]
fn outside(places: &[i16], [low, high]: [__m256i; 2]) -> __m256i {
    assert!(places.len() == LANES);
    // SAFETY: sixteen values of two bytes are read.
    let places = unsafe { _mm256_loadu_si256(places.as_ptr().cast()) };
    _mm256_or_si256(_mm256_cmpgt_epi16(low, places), _mm256_cmpgt_epi16(places, high))
}
