//! Mutual best matches where windows hold a good part of the image: thousands of candidates a point. Only distances are kept while all pairs
//! are compared, sixteen at a time with AVX2; who it was is looked up for the few points that stand out. Integers: the same matches on every machine.

use crate::index::{Index, Window};
use crate::matching::{Match, mutual_best};

/// Points laid out for wide windows.
#[derive(Debug, Clone)]
pub(crate) struct Wide<const N: usize> {
    index: Index<N>,
    /// The index that each point has in the layout it was taken from.
    names: Vec<u32>,
}

impl<const N: usize> Wide<N> {
    /// The points of an image of `size` columns and rows.
    pub fn of(index: &Index<N>, size: (usize, usize)) -> Self {
        let (index, names) = index.tall(size);
        Self { index, names }
    }
}

/// As [`mutual_best`]. Pairs that are tied with others survive only where `ratio` is 1, and then in another order.
pub(crate) fn mutual_best_afar<const N: usize>(
    a: &Index<N>,
    b: &Wide<N>,
    ratio: f64,
    window: impl Fn(usize) -> Option<Window>,
) -> Vec<Match> {
    let named = |m: Match| Match { b: b.names[m.b as usize], ..m };
    #[cfg(target_arch = "x86_64")]
    if ratio < 1.0 && is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        let matches = unsafe { avx2::distinct_pairs(a, &b.index, ratio, window) };
        return matches.into_iter().map(named).collect();
    }
    mutual_best(a, &b.index, ratio, window).into_iter().map(named).collect()
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use crate::index::{AHEAD, Index, Window};
    use crate::matching::Match;
    use std::arch::x86_64::*;
    use std::ops::Range;

    /// Candidates at a time.
    const LANES: usize = 16;
    const _: () = assert!(AHEAD + 1 >= LANES);
    /// No distance: the greatest is 64 * 255.
    const NOBODY: u16 = u16::MAX;

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

    #[target_feature(enable = "avx2")]
    pub fn distinct_pairs<const N: usize>(
        a: &Index<N>,
        b: &Index<N>,
        ratio: f64,
        window: impl Fn(usize) -> Option<Window>,
    ) -> Vec<Match> {
        let (mut of_a, mut of_b) = (Least::of(a.len()), Least::of(b.len() + AHEAD));
        for i in 0..a.len() {
            let Some(window) = window(i) else { continue };
            (of_a.first[i], of_a.second[i]) =
                offer(&Query::of(&a.descriptors[i], window), a.class[i], window, b, &mut of_b);
        }
        let partner = |i: usize| {
            let window = window(i)?;
            let query = Query::of(&a.descriptors[i], window);
            let partner = find(&query, a.class[i], window, b, (of_a.first[i], &of_b.first))?;
            // What stands out on both sides is one and the same pair.
            of_b.is_distinct(partner, ratio).then_some(partner)
        };
        let distinct = (0..a.len()).filter(|&i| of_a.is_distinct(i, ratio));
        let pair = |i: usize| Some(Match { a: i as u32, b: partner(i)? as u32, distance: of_a.first[i].into() });
        distinct.filter_map(pair).collect()
    }

    /// A point with its window, in all lanes.
    struct Query<'a, const N: usize> {
        described: &'a [u8; N],
        columns: [__m256i; 2],
        rows: [__m256i; 2],
    }

    impl<'a, const N: usize> Query<'a, N> {
        #[inline]
        #[target_feature(enable = "avx2")]
        fn of(described: &'a [u8; N], window: Window) -> Self {
            let lanes = |at: i32| _mm256_set1_epi16(at.clamp(i16::MIN.into(), i16::MAX.into()) as i16);
            let ends = |(low, high): (i32, i32)| [lanes(low), lanes(high)];
            Self { described, columns: ends(window.u), rows: ends(window.v) }
        }
    }

    /// Compares a query with all points in its window: its least two distances; each point's own are kept in `theirs`.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn offer<const N: usize>(
        query: &Query<'_, N>,
        class: u8,
        window: Window,
        b: &Index<N>,
        theirs: &mut Least,
    ) -> (u16, u16) {
        let mut least = [_mm256_set1_epi16(-1); 2];
        b.for_each_run(class, window, |run| {
            for j in run.clone().step_by(LANES) {
                let distances = sixteen(query, b, j, &run);
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
            }
        });
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
        query: &Query<'_, N>,
        class: u8,
        window: Window,
        b: &Index<N>,
        (distance, least_of_b): (u16, &[u16]),
    ) -> Option<usize> {
        let wanted = _mm256_set1_epi16(distance as i16);
        let equal = |distances: __m256i| _mm256_movemask_epi8(_mm256_cmpeq_epi16(distances, wanted)) as u32;
        let mut found = None;
        b.for_each_run(class, window, |run| {
            let mut starts = run.clone().step_by(LANES);
            while let (None, Some(j)) = (found, starts.next()) {
                // SAFETY: sixteen distances are read.
                let least = equal(unsafe { _mm256_loadu_si256(least_of_b[j..j + LANES].as_ptr().cast()) });
                if least != 0 {
                    let both = least & equal(sixteen(query, b, j, &run));
                    found = (both != 0).then(|| j + both.trailing_zeros() as usize / 2);
                }
            }
        });
        found
    }

    fn unpacked(lanes: __m256i) -> [u16; LANES] {
        let mut distances = [NOBODY; LANES];
        // SAFETY: the array has room for sixteen lanes, and the store belongs to AVX.
        unsafe { _mm256_storeu_si256(distances.as_mut_ptr().cast(), lanes) };
        distances
    }

    /// The distances to the points from `j` on; [`NOBODY`] for those outside the window or behind the end of `run`.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn sixteen<const N: usize>(query: &Query<'_, N>, b: &Index<N>, j: usize, run: &Range<usize>) -> __m256i {
        const { assert!(N.is_multiple_of(32)) };
        let candidates = &b.descriptors[j..j + LANES];
        let sums = |candidate: &[u8; N]| {
            let mut sums = _mm256_setzero_si256();
            for at in (0..N).step_by(32) {
                // SAFETY: 32 bytes from `at` on lie inside both arrays.
                let [x, y] = unsafe {
                    [query.described, candidate].map(|bytes| _mm256_loadu_si256(bytes.as_ptr().add(at).cast()))
                };
                sums = _mm256_add_epi64(sums, _mm256_sad_epu8(x, y));
            }
            sums
        };
        // Sums of eight or sixteen bytes are below 2^12, so those of four candidates share a register, word by word.
        let four = |of: usize| {
            let [p, q, r, s] = [0, 1, 2, 3].map(|k| sums(&candidates[4 * of + k]));
            let (pq, rs) =
                (_mm256_or_si256(p, _mm256_slli_epi64::<16>(q)), _mm256_or_si256(r, _mm256_slli_epi64::<16>(s)));
            _mm256_or_si256(pq, _mm256_slli_epi64::<32>(rs))
        };
        // Each of the four parts of a register holds four candidates' sums over another quarter of the bytes.
        let halves = |of: usize| {
            let (even, odd) = (four(of), four(of + 1));
            _mm256_add_epi16(_mm256_unpacklo_epi64(even, odd), _mm256_unpackhi_epi64(even, odd))
        };
        let (low, high) = (halves(0), halves(2));
        let totals = _mm256_add_epi16(
            _mm256_permute2x128_si256::<0x20>(low, high),
            _mm256_permute2x128_si256::<0x31>(low, high),
        );
        let outside = |places: &[i16], [low, high]: [__m256i; 2]| {
            // SAFETY: sixteen values of two bytes are read.
            let places = unsafe { _mm256_loadu_si256(places[j..j + LANES].as_ptr().cast()) };
            _mm256_or_si256(_mm256_cmpgt_epi16(low, places), _mm256_cmpgt_epi16(places, high))
        };
        let mut nobody = _mm256_or_si256(outside(&b.u, query.columns), outside(&b.v, query.rows));
        if j + LANES > run.end {
            let lanes = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            let last = _mm256_set1_epi16((run.end - j) as i16 - 1);
            nobody = _mm256_or_si256(nobody, _mm256_cmpgt_epi16(lanes, last));
        }
        // All bits set is nobody.
        _mm256_or_si256(totals, nobody)
    }
}
