//! Chance that is the same everywhere: numbers out of a seed and a place (splitmix64; Steele, Lea and Flood 2014).

/// Scrambles 64 bits.
fn mix(bits: u64) -> u64 {
    let z = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A seed of its own for each pair of numbers.
pub(crate) fn seed_of(a: u64, b: u64) -> u64 {
    mix(mix(a) ^ b)
}

/// A number of mean 0 and deviation 1 for each place: the sum of four uniform ones, which is near enough to normal for
/// a camera's noise.
pub(crate) fn bell(seed: u64, place: u64) -> f32 {
    /// Deviation of the sum of four whole numbers below 2^16: 2^16 sqrt(4 / 12).
    const DEVIATION: f32 = 37_837.227;
    let bits = mix(seed ^ place.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let sum: i64 = (0..4).map(|k| (bits >> (16 * k) & 0xffff) as i64).sum();
    (sum - 131_070) as f32 / DEVIATION
}
