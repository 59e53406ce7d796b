//! The order in which people count: frame2 before frame10.

use std::cmp::Ordering;

/// Compares names by their letters and by the values of their numbers; names alike in both by their bytes.
pub(super) fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        let (run_l, run_r) = (digits(left), digits(right));
        if run_l.is_empty() || run_r.is_empty() {
            let (Some(l), Some(r)) = (left.chars().next(), right.chars().next()) else {
                return left.len().cmp(&right.len()).then_with(|| a.cmp(b));
            };
            if l != r {
                return l.cmp(&r);
            }
            (left, right) = (&left[l.len_utf8()..], &right[r.len_utf8()..]);
            continue;
        }
        let (l, r) = (run_l.trim_start_matches('0'), run_r.trim_start_matches('0'));
        let order = l.len().cmp(&r.len()).then_with(|| l.cmp(r));
        if order != Ordering::Equal {
            return order;
        }
        (left, right) = (&left[run_l.len()..], &right[run_r.len()..]);
    }
}

/// The digits at the start.
fn digits(text: &str) -> &str {
    &text[..text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len())]
}

#[cfg(test)]
mod tests {
    use super::natural_order;
    use proptest::prelude::*;

    #[test]
    fn numbers_in_names_count() {
        let mut names = ["frame10", "b", "frame2", "frame1", "2", "frame", "10", "frame02", "1", "frame1a"];
        names.sort_by(|a, b| natural_order(a, b));
        assert_eq!(names, ["1", "2", "10", "b", "frame", "frame1", "frame1a", "frame02", "frame2", "frame10"]);
    }

    proptest! {
        #[test]
        fn counters_are_in_order_whatever_their_width(
            numbers in prop::collection::btree_set(0_u32..100_000, 1..50), width in 0_usize..6,
        ) {
            let counted: Vec<String> = numbers.iter().map(|n| format!("img_{n:0width$}.left")).collect();
            let mut names = counted.clone();
            names.sort();
            names.sort_by(|a, b| natural_order(a, b));
            prop_assert_eq!(names, counted);
        }

        #[test]
        fn it_is_an_order(a in "[a0-9]{0,6}", b in "[a0-9]{0,6}", c in "[a0-9]{0,6}") {
            prop_assert_eq!(natural_order(&a, &b), natural_order(&b, &a).reverse());
            if natural_order(&a, &b).is_le() && natural_order(&b, &c).is_le() {
                prop_assert!(natural_order(&a, &c).is_le());
            }
        }
    }
}
