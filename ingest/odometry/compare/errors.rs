//! Errors of a track, and their statistics.

use super::pairs::{Delta, distance_m};
use furrow_model::Se3;

/// Errors of poses or of motions between poses.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseErrors {
    /// Metres.
    pub translation_m: Vec<f64>,
    /// Degrees, 0 to 180.
    pub rotation_deg: Vec<f64>,
}

/// Statistics of errors, as evo reports them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Root mean square.
    pub rmse: f64,
    /// Mean.
    pub mean: f64,
    /// Median: the mean of the middle two of an even number.
    pub median: f64,
    /// Standard deviation of the population: divided by the number of errors.
    pub std: f64,
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
    /// Number of errors.
    pub count: usize,
}

/// Mean errors of all stretches of one length.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LengthError {
    /// Length of the stretches, metres of the reference.
    pub length_m: f64,
    /// Mean translation error as a fraction of the length.
    pub translation: f64,
    /// Mean rotation error, degrees per metre.
    pub rotation_deg_per_m: f64,
    /// Number of stretches.
    pub count: usize,
}

impl Spread {
    /// The statistics of `errors`. `None` if there are none.
    pub fn of(errors: &[f64]) -> Option<Spread> {
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        let count = sorted.len();
        let mean = errors.iter().sum::<f64>() / count as f64;
        let squares = |from: f64| errors.iter().map(|error| (error - from).powi(2)).sum::<f64>() / count as f64;
        Some(Spread {
            rmse: squares(0.0).sqrt(),
            mean,
            median: 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
            std: squares(mean).sqrt(),
            min,
            max,
            count,
        })
    }
}

/// Absolute pose errors (evo's APE) of an aligned estimate. With E_i = P_ref,i^-1 P_est,i: the length of its
/// translation and the angle of its rotation (Sturm et al. 2012, Eq. 4, has the inverse, of equal length and angle).
pub fn position_errors(reference: &[Se3], estimate: &[Se3]) -> PoseErrors {
    let errors = reference.iter().zip(estimate).map(|(r, e)| (distance_m(r, e), r.inverse().compose(e)));
    let (translation_m, rotation_deg) = errors.map(|(distance_m, error)| (distance_m, degrees(&error))).unzip();
    PoseErrors { translation_m, rotation_deg }
}

/// Relative pose errors (evo's RPE) over the pairs (i, j) of `delta` along the estimate: translation length and
/// rotation angle of E_ij = (P_ref,i^-1 P_ref,j)^-1 (P_est,i^-1 P_est,j) (Sturm et al. 2012, Eq. 1). They do not depend
/// on the alignment.
pub fn step_errors(reference: &[Se3], estimate: &[Se3], delta: Delta) -> PoseErrors {
    let errors = delta.pairs(estimate).into_iter().map(|pair| motion_error(reference, estimate, pair));
    let (translation_m, rotation_deg) = errors.map(|error| (error.distance_m(), degrees(&error))).unzip();
    PoseErrors { translation_m, rotation_deg }
}

/// KITTI's relative errors: the means of the translation length and the rotation angle of E_ij, divided by the
/// stretch's length (Geiger et al. 2012, Eqs. 2 and 1). A stretch begins at each pose i and ends at the first pose j
/// whose distance along the reference is greater than the length (the devkit's `lastFrameFromSegmentLength`). Lengths
/// without stretches are left out.
pub fn errors_per_length(reference: &[Se3], estimate: &[Se3], lengths_m: &[f64]) -> Vec<LengthError> {
    let mut travelled_m = vec![0.0];
    for pair in reference.windows(2) {
        travelled_m.push(travelled_m[travelled_m.len() - 1] + distance_m(&pair[0], &pair[1]));
    }
    let mean_errors = |&length_m: &f64| {
        let end = |from: usize| {
            let to = travelled_m.partition_point(|&m| m <= travelled_m[from] + length_m);
            (to < reference.len()).then_some((from, to))
        };
        let errors: Vec<Se3> =
            (0..reference.len()).filter_map(end).map(|pair| motion_error(reference, estimate, pair)).collect();
        let scale = 1.0 / (errors.len() as f64 * length_m);
        (!errors.is_empty()).then(|| LengthError {
            length_m,
            translation: errors.iter().map(Se3::distance_m).sum::<f64>() * scale,
            rotation_deg_per_m: errors.iter().map(degrees).sum::<f64>() * scale,
            count: errors.len(),
        })
    };
    lengths_m.iter().filter_map(mean_errors).collect()
}

/// E_ij: the estimate's motion from pose i to pose j, seen from the end of the reference's motion.
fn motion_error(reference: &[Se3], estimate: &[Se3], (from, to): (usize, usize)) -> Se3 {
    let motion = |track: &[Se3]| track[from].inverse().compose(&track[to]);
    motion(reference).inverse().compose(&motion(estimate))
}

/// The angle of a rotation in degrees. It is computed from sine and cosine: the arc cosine alone loses the digits of
/// small angles.
fn degrees(error: &Se3) -> f64 {
    let r = &error.rotation;
    let axis = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    let sine = axis.iter().map(|v| v * v).sum::<f64>().sqrt();
    let cosine = r[0][0] + r[1][1] + r[2][2] - 1.0;
    libm::atan2(sine, cosine).to_degrees()
}
