//! Matches of two images' keypoints, without any guess of the motion between them.

use super::features::Features;
use super::keypoint::{Descriptor, Keypoint};
use serde::{Deserialize, Serialize};

/// What may match.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MatchParams {
    /// A match is kept when its distance is below this fraction of the second best's, seen from both sides (Lowe 2004).
    pub ratio: f32,
    /// Greatest difference of columns searched, px.
    pub columns_px: f32,
    /// Greatest difference of rows searched, px.
    pub rows_px: f32,
}

/// Two keypoints that chose each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfMatch {
    /// Keypoint of the first image.
    pub a: usize,
    /// Keypoint of the second image.
    pub b: usize,
    /// Distance of their descriptors, 0 to 2.
    pub distance: f32,
}

/// The nearest and second nearest partner of every keypoint of one side, by the cosine of their descriptors.
struct Best {
    partner: Vec<usize>,
    first: Vec<f32>,
    second: Vec<f32>,
}

impl Best {
    fn of(count: usize) -> Self {
        Self { partner: vec![usize::MAX; count], first: vec![-1.0; count], second: vec![-1.0; count] }
    }

    fn offer(&mut self, i: usize, partner: usize, cosine: f32) {
        let better = cosine > self.first[i] || cosine == self.first[i] && partner < self.partner[i];
        if better {
            (self.second[i], self.first[i], self.partner[i]) = (self.first[i], cosine, partner);
        } else {
            self.second[i] = self.second[i].max(cosine);
        }
    }

    /// Distances compare as their squares, 2 - 2 cosine, do.
    fn is_distinct(&self, i: usize, ratio: f32) -> bool {
        1.0 - self.first[i] < ratio * ratio * (1.0 - self.second[i])
    }
}

/// Every pair of keypoints of equal sign that is mutually nearest within the search window and beats both second
/// nearest by the ratio, in the order of `a`. Ties go to the lower index.
pub fn mutual_best(a: &Features, b: &Features, params: &MatchParams) -> Vec<SurfMatch> {
    let (mut of_a, mut of_b) = (Best::of(a.keypoints.len()), Best::of(b.keypoints.len()));
    let by_rows = [-1, 1].map(|sign| sorted_by_rows(&b.keypoints, sign));
    for (i, p) in a.keypoints.iter().enumerate() {
        let others = &by_rows[usize::from(p.laplacian_sign > 0)];
        let first = others.partition_point(|other| other.y_px < p.y_px - params.rows_px);
        let in_rows = others[first..].iter().take_while(|other| other.y_px <= p.y_px + params.rows_px);
        for other in in_rows.filter(|other| (other.x_px - p.x_px).abs() <= params.columns_px) {
            let cosine = cosine(&a.descriptors[i], &b.descriptors[other.index]);
            of_a.offer(i, other.index, cosine);
            of_b.offer(other.index, i, cosine);
        }
    }
    let matched = |i: usize| {
        let j = of_a.partner[i];
        let mutual = of_b.partner.get(j) == Some(&i);
        let kept = mutual && of_a.is_distinct(i, params.ratio) && of_b.is_distinct(j, params.ratio);
        kept.then(|| SurfMatch { a: i, b: j, distance: (2.0 - 2.0 * of_a.first[i]).max(0.0).sqrt() })
    };
    (0..a.keypoints.len()).filter_map(matched).collect()
}

/// A keypoint's place.
struct Placed {
    x_px: f32,
    y_px: f32,
    index: usize,
}

/// The keypoints of a sign, from the top of the image down.
fn sorted_by_rows(keypoints: &[Keypoint], sign: i8) -> Vec<Placed> {
    let of_sign = keypoints.iter().enumerate().filter(|(_, keypoint)| (keypoint.laplacian_sign > 0) == (sign > 0));
    let mut placed: Vec<Placed> =
        of_sign.map(|(index, keypoint)| Placed { x_px: keypoint.x_px, y_px: keypoint.y_px, index }).collect();
    placed.sort_by(|a, b| a.y_px.total_cmp(&b.y_px).then(a.index.cmp(&b.index)));
    placed
}

/// The product of two unit vectors, summed in lanes, so that the compiler may use wide registers without changing a
/// bit.
fn cosine(a: &Descriptor, b: &Descriptor) -> f32 {
    const LANES: usize = 16;
    let mut sums = [0.0_f32; LANES];
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ANYWHERE: MatchParams = MatchParams { ratio: 0.8, columns_px: 1e6, rows_px: 1e6 };

    /// Keypoints at places, with descriptors that differ in their first four numbers.
    fn features(of: &[(f32, f32, bool, [i8; 4])]) -> Features {
        let keypoint = |&(x_px, y_px, dark, _): &(f32, f32, bool, [i8; 4])| Keypoint {
            x_px,
            y_px,
            size_px: 20.0,
            angle_deg: 270.0,
            response: 500.0,
            octave: 0,
            laplacian_sign: if dark { 1 } else { -1 },
        };
        let descriptor = |&(_, _, _, numbers): &(f32, f32, bool, [i8; 4])| {
            let norm = numbers.iter().map(|&n| f32::from(n).powi(2)).sum::<f32>().sqrt().max(1.0);
            std::array::from_fn(|k| numbers.get(k).map_or(0.0, |&n| f32::from(n) / norm))
        };
        Features { keypoints: of.iter().map(keypoint).collect(), descriptors: of.iter().map(descriptor).collect() }
    }

    fn any_features() -> impl Strategy<Value = Features> {
        let one = (0.0_f32..100.0, 0.0_f32..60.0, any::<bool>(), proptest::array::uniform4(-9_i8..9));
        proptest::collection::vec(one, 0..40).prop_map(|of| features(&of))
    }

    proptest! {
        /// By looking at all pairs, with distances as they are defined.
        #[test]
        fn matches_equal_brute_force(a in any_features(), b in any_features(), reach in 5.0_f32..120.0) {
            let params = MatchParams { ratio: 0.8, columns_px: reach, rows_px: reach / 2.0 };
            let apart = |i: usize, j: usize| -> Option<f32> {
                let (p, q) = (&a.keypoints[i], &b.keypoints[j]);
                let near = (p.x_px - q.x_px).abs() <= reach && (p.y_px - q.y_px).abs() <= reach / 2.0;
                let squares = a.descriptors[i].iter().zip(&b.descriptors[j]).map(|(x, y)| (x - y).powi(2));
                (near && p.laplacian_sign == q.laplacian_sign).then(|| squares.sum::<f32>().sqrt())
            };
            for found in mutual_best(&a, &b, &params) {
                let here = apart(found.a, found.b).unwrap();
                prop_assert!((here - found.distance).abs() < 1e-3, "{here} {}", found.distance);
                let rivals = (0..b.keypoints.len()).filter(|&j| j != found.b).filter_map(|j| apart(found.a, j));
                let others = (0..a.keypoints.len()).filter(|&i| i != found.a).filter_map(|i| apart(i, found.b));
                prop_assert!(rivals.chain(others).all(|rival| here <= 0.8 * rival + 1e-3));
            }
        }
    }

    #[test]
    fn every_keypoint_finds_itself_and_signs_are_told_apart() {
        let of = [(5.0, 5.0, true, [1, 0, 0, 0]), (9.0, 5.0, false, [1, 0, 0, 0]), (50.0, 9.0, true, [0, 1, 3, 0])];
        let image = features(&of);
        let pairs: Vec<(usize, usize)> = mutual_best(&image, &image, &ANYWHERE).iter().map(|m| (m.a, m.b)).collect();
        assert_eq!(pairs, [(0, 0), (1, 1), (2, 2)]);
        let narrow = MatchParams { columns_px: 3.0, ..ANYWHERE };
        let far = features(&of.map(|(x, y, dark, numbers)| (x + 4.0, y, dark, numbers)));
        assert!(mutual_best(&image, &far, &narrow).is_empty());
        assert!(mutual_best(&image, &Features::default(), &ANYWHERE).is_empty());
    }
}
