//! What place recognisers have in common: the places of a map by how well they answer a live image.

/// A place on offer for a live image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// The place's number.
    pub place: usize,
    /// Larger is better; the unit is the method's.
    pub score: f64,
}

/// The `count` places with the highest of `scores` (fewer where the map is smaller), best first, ties to the lowest
/// number.
pub fn best_first(scores: &[f64], count: usize) -> Vec<Ranked> {
    let falling = |a: &usize, b: &usize| scores[*b].total_cmp(&scores[*a]).then(a.cmp(b));
    let mut places: Vec<usize> = (0..scores.len()).collect();
    if count < places.len() && count > 0 {
        places.select_nth_unstable_by(count - 1, falling);
    }
    places.truncate(count);
    places.sort_unstable_by(falling);
    places.into_iter().map(|place| Ranked { place, score: scores[place] }).collect()
}
