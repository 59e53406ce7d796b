//! Matches, and the best and second best partner of each point while candidates are compared.

/// Two points that are each other's best partner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Match {
    /// Index into the first set.
    pub a: u32,
    /// Index into the second set.
    pub b: u32,
    /// Sum of absolute differences of their descriptors.
    pub distance: u32,
}

/// A distance and a partner's index in one number: the least key is the nearest partner, of equal ones that with the
/// lower index.
pub(super) type Key = u64;

/// The key of no partner.
pub(super) const NO_KEY: Key = Key::MAX;

pub(super) fn make_key(distance: u32, partner: usize) -> Key {
    u64::from(distance) << 32 | partner as u64
}

pub(super) fn key_distance(key: Key) -> u32 {
    (key >> 32) as u32
}

/// The best and second best partner of every point of one set.
pub(super) struct Best {
    pub first: Vec<Key>,
    pub second: Vec<Key>,
}

impl Best {
    /// No partners yet, for `count` points.
    pub fn none(count: usize) -> Self {
        Self { first: vec![NO_KEY; count], second: vec![NO_KEY; count] }
    }

    /// Lowe's ratio test (2004): whether the best distance of point `i` is below `ratio` times its second best.
    pub fn passes_ratio_test(&self, i: usize, ratio: f64) -> bool {
        let second = self.second[i];
        second == NO_KEY || f64::from(key_distance(self.first[i])) < ratio * f64::from(key_distance(second))
    }
}
