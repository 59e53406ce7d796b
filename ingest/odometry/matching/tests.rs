//! Every way to match gives the matches of brute force.

use super::best::{Best, Key, Match, key_distance};
use super::mutual::{compare, match_mutually};
use super::{four_lanes, match_whole_image};
use crate::features::{Index, WholeImage, Window, bin_order};
use proptest::prelude::*;

type Point = (u8, i16, i16, u8);

/// Points with descriptors of few different values, so that there are ties.
fn indexed<const N: usize>(mut points: Vec<Point>) -> Index<N> {
    let places: Vec<_> = points.iter().map(|p| (p.0, p.1, p.2)).collect();
    points = bin_order(&places, 100, 60).into_iter().map(|i| points[i as usize]).collect();
    let places: Vec<_> = points.iter().map(|p| (p.0, p.1, p.2)).collect();
    let describe = |p: &Point| std::array::from_fn(|k| p.3.wrapping_mul(k as u8 | 1) & 7);
    Index::new(&places, points.iter().map(describe).collect(), 100, 60)
}

/// The matches by comparing all pairs.
fn brute<const N: usize>(a: &Index<N>, b: &Index<N>, ratio: f64, reach: i32) -> Vec<Match> {
    let apart = |i: usize, j: usize| -> u32 {
        a.descriptors[i].iter().zip(&b.descriptors[j]).map(|(x, y)| u32::from(x.abs_diff(*y))).sum()
    };
    let near = |i: usize, j: usize| {
        let off = |x: i16, y: i16| (i32::from(x) - i32::from(y)).abs() <= reach;
        a.class[i] == b.class[j] && off(a.u[i], b.u[j]) && off(a.v[i], b.v[j])
    };
    let two_best = |mut all: Vec<(u32, usize)>| {
        all.sort_unstable();
        let distinct = all.len() < 2 || ratio >= 1.0 || f64::from(all[0].0) < ratio * f64::from(all[1].0);
        all.first().map(|best| (best.1, distinct))
    };
    let best_of_a = |i: usize| two_best((0..b.len()).filter(|&j| near(i, j)).map(|j| (apart(i, j), j)).collect());
    let best_of_b = |j: usize| two_best((0..a.len()).filter(|&i| near(i, j)).map(|i| (apart(i, j), i)).collect());
    let mutual = |i: usize| {
        let (j, distinct) = best_of_a(i)?;
        let (back, back_distinct) = best_of_b(j)?;
        let matched = Match { a: i as u32, b: j as u32, distance: apart(i, j) };
        (back == i && distinct && back_distinct).then_some(matched)
    };
    (0..a.len()).filter_map(mutual).collect()
}

fn points() -> impl Strategy<Value = Vec<Point>> {
    proptest::collection::vec((0_u8..4, 0_i16..100, 0_i16..60, 0_u8..20), 0..120)
}

proptest! {
    #[test]
    fn matches_equal_brute_force(a in points(), b in points(), has_ratio_test: bool, reach in 0_i32..80) {
        let ratio = if has_ratio_test { 0.9 } else { 1.0 };
        let (a32, b32) = (indexed::<32>(a.clone()), indexed::<32>(b.clone()));
        let (a64, b64) = (indexed::<64>(a), indexed::<64>(b));
        let around = |u: &[i16], v: &[i16], i: usize| Some(Window::around(u[i].into(), v[i].into(), reach, reach));
        let found = match_mutually(&a32, &b32, ratio, |i| around(&a32.u, &a32.v, i));
        prop_assert_eq!(found, brute(&a32, &b32, ratio, reach));
        let found = match_mutually(&a64, &b64, ratio, |i| around(&a64.u, &a64.v, i));
        prop_assert_eq!(found, brute(&a64, &b64, ratio, reach));
        let found = match_whole_image(&a32, &WholeImage::new(&b32, (100, 60)), 0.9, |i| around(&a32.u, &a32.v, i));
        prop_assert_eq!(found, brute(&a32, &b32, 0.9, reach));
        let found = match_whole_image(&a64, &WholeImage::new(&b64, (100, 60)), 0.9, |i| around(&a64.u, &a64.v, i));
        prop_assert_eq!(found, brute(&a64, &b64, 0.9, reach));
        let (mut best_of_a, mut best_of_b) = (Best::none(a32.len()), Best::none(b32.len()));
        compare(&a32, &b32, |i| around(&a32.u, &a32.v, i), &mut best_of_a, &mut best_of_b);
        let (mut lanes_a, mut lanes_b) = (Best::none(a32.len()), Best::none(b32.len()));
        if four_lanes::is_available(&a32, &b32) {
            four_lanes::compare(&a32, &b32, |i| around(&a32.u, &a32.v, i), &mut lanes_a, &mut lanes_b);
            prop_assert_eq!((best_of_a.first, best_of_b.first), (lanes_a.first, lanes_b.first));
            let distances = |keys: Vec<Key>| keys.into_iter().map(key_distance).collect::<Vec<_>>();
            prop_assert_eq!(distances(best_of_a.second), distances(lanes_a.second));
            prop_assert_eq!(distances(best_of_b.second), distances(lanes_b.second));
        }
    }
}
