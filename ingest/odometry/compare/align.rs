//! Alignment of one track with another.

use furrow_model::Se3;
use nalgebra::{Matrix3, Vector3};

/// How an estimate is aligned with its reference before they are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alignment {
    /// Not at all: both tracks are in the same frame.
    None,
    /// The first poses coincide (evo's `--align_origin`).
    First,
    /// The rotation and translation of least squared distance (Umeyama 1991; evo's `--align`).
    Rigid,
    /// The same with a scale, for tracks of unknown scale (evo's `--align --correct_scale`).
    Scaled,
}

/// The aligned estimate and its scale. Reference and estimate have the same number of poses. `None` if the positions
/// lie on a line or in a point, so that the rotation is not determined.
pub fn align(reference: &[Se3], estimate: &[Se3], alignment: Alignment) -> Option<(Vec<Se3>, f64)> {
    let moved = |motion: &Se3, scale: f64| {
        let scaled = |pose: &Se3| Se3 { translation_m: pose.translation_m.map(|v| v * scale), ..*pose };
        estimate.iter().map(|pose| motion.compose(&scaled(pose))).collect()
    };
    match alignment {
        Alignment::None => Some((estimate.to_vec(), 1.0)),
        Alignment::First => {
            let motion = reference.first()?.compose(&estimate.first()?.inverse());
            Some((moved(&motion, 1.0), 1.0))
        }
        Alignment::Rigid | Alignment::Scaled => {
            let (motion, scale) = umeyama(reference, estimate, alignment == Alignment::Scaled)?;
            Some((moved(&motion, scale), scale))
        }
    }
}

/// The rotation, translation and scale that minimise the squared distance of reference and scale * rotation * estimate
/// + translation (Umeyama 1991; the equation numbers below are his).
fn umeyama(reference: &[Se3], estimate: &[Se3], with_scale: bool) -> Option<(Se3, f64)> {
    let count = reference.len() as f64;
    let points = |track: &[Se3]| track.iter().map(|pose| Vector3::from(pose.translation_m)).collect::<Vec<_>>();
    let (to, from) = (points(reference), points(estimate));
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / count;
    // Eqs. 34 and 35.
    let (mean_to, mean_from) = (mean(&to), mean(&from));
    // Eqs. 38 and 36.
    let mut covariance = Matrix3::zeros();
    let mut variance = 0.0;
    for (to, from) in to.iter().zip(&from) {
        covariance += (to - mean_to) * (from - mean_from).transpose() / count;
        variance += (from - mean_from).norm_squared() / count;
    }
    let svd = covariance.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let rank = svd.singular_values.iter().filter(|&&value| value > f64::EPSILON).count();
    if rank < 2 {
        return None;
    }
    // Eq. 43.
    let mut signs = Vector3::new(1.0, 1.0, 1.0);
    if u.determinant() * v_t.determinant() < 0.0 {
        signs[2] = -1.0;
    }
    // Eqs. 40, 42 and 41.
    let rotation = u * Matrix3::from_diagonal(&signs) * v_t;
    let scale = if with_scale { svd.singular_values.dot(&signs) / variance } else { 1.0 };
    let translation = mean_to - rotation * mean_from * scale;
    let rotation = std::array::from_fn(|i| std::array::from_fn(|j| rotation[(i, j)]));
    Some((Se3 { rotation, translation_m: translation.into() }, scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track() -> Vec<Se3> {
        let pose = |i: usize| {
            let t = i as f64;
            Se3::from_quaternion([0.02 * t, 0.1, 0.03 * t, 1.0], [t.sin() * 3.0, 0.4 * t, (1.3 * t).cos()])
        };
        (0..20).map(pose).collect()
    }

    #[test]
    fn a_moved_and_scaled_track_is_aligned() {
        let reference = track();
        let motion = Se3::from_quaternion([0.3, -0.2, 0.5, 0.7], [4.0, -7.0, 0.3]);
        for (alignment, factor) in [(Alignment::First, 1.0), (Alignment::Rigid, 1.0), (Alignment::Scaled, 2.5)] {
            let moved = |pose: &Se3| {
                let pose = motion.compose(pose);
                Se3 { translation_m: pose.translation_m.map(|v| v / factor), ..pose }
            };
            let estimate: Vec<Se3> = reference.iter().map(moved).collect();
            let (found, scale) = align(&reference, &estimate, alignment).unwrap();
            assert!((scale - factor).abs() < 1e-12, "{alignment:?} {scale}");
            for (a, b) in found.iter().zip(&reference) {
                assert!(a.inverse().compose(b).distance_m() < 1e-12, "{alignment:?}");
            }
        }
    }

    #[test]
    fn a_track_on_a_line_determines_no_rotation() {
        let line: Vec<Se3> = (0..5).map(|i| Se3 { translation_m: [f64::from(i), 0.0, 0.0], ..Se3::IDENTITY }).collect();
        assert!(align(&line, &line, Alignment::Rigid).is_none());
        assert!(align(&[], &[], Alignment::First).is_none());
    }
}
