//! Some of many, evenly spread.

/// At most `wanted` of `all`, from the first on.
pub(crate) fn spread<T: Copy>(all: &[T], wanted: usize) -> Vec<T> {
    let taken = wanted.min(all.len());
    (0..taken).map(|i| all[i * all.len() / taken]).collect()
}

/// At most `wanted` of `all`, each from the middle of an equal part.
pub(crate) fn middles<T: Clone>(all: &[T], wanted: usize) -> Vec<T> {
    let taken = wanted.min(all.len());
    (0..taken).map(|i| all[(2 * i + 1) * all.len() / (2 * taken)].clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_evenly_spread() {
        let all: Vec<u32> = (0..10).collect();
        assert_eq!((spread(&all, 5), middles(&all, 5)), (vec![0, 2, 4, 6, 8], vec![1, 3, 5, 7, 9]));
        assert_eq!((spread(&all, 99), middles(&all, 99)), (all.clone(), all.clone()));
        assert_eq!((spread(&all, 0), middles::<u32>(&[], 3)), (vec![], vec![]));
    }
}
