//! Tracks in the file formats of TUM and KITTI.

use furrow_model::tum::{TumError, describe_line, finite_numbers, parse_tum, pose_lines};
use furrow_model::{Se3, Trajectory};

/// Poses in one world frame (world from camera, metres), with stamps where the file has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Seconds, ascending. `None` for the KITTI format, which has no stamps.
    pub stamps_s: Option<Vec<f64>>,
    /// The poses.
    pub poses: Vec<Se3>,
}

/// Why a text is not a track.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrackError {
    /// Not what a file in the TUM format holds.
    #[error(transparent)]
    Tum(#[from] TumError),
    /// A first line that is neither in the TUM nor in the KITTI format.
    #[error(
        "line {line}: expected 8 numbers (TUM: seconds tx ty tz qx qy qz qw) or 12 \
         (KITTI: the 3x4 pose by rows), found {found}"
    )]
    NoPose {
        /// From 1.
        line: usize,
        /// What the line holds.
        found: String,
    },
    /// A later line that is not in the KITTI format.
    #[error("line {line}: expected 12 numbers (KITTI: the 3x4 pose by rows), as in the lines before, found {found}")]
    NotKitti {
        /// From 1.
        line: usize,
        /// What the line holds.
        found: String,
    },
    /// A matrix that is no rotation.
    #[error("line {line}: expected a rotation, found a matrix whose rows are not of unit length and at right angles")]
    NoRotation {
        /// From 1.
        line: usize,
    },
    /// No pose.
    #[error("the file holds no pose (lines that begin with # are comments)")]
    Empty,
}

/// Tolerance for the products of a rotation's rows: files have at least six digits.
const ROTATION_TOLERANCE: f64 = 1e-3;

impl Track {
    /// The poses of a chain, in the frame of its first pose.
    pub fn of_chain(chain: &Trajectory) -> Track {
        let poses = chain.poses();
        Track {
            stamps_s: Some(poses.iter().map(|pose| pose.stamp_ns as f64 / 1e9).collect()),
            poses: poses.iter().map(|pose| pose.start_from_here).collect(),
        }
    }

    /// Reads text in the TUM or KITTI format. The first pose decides which. Errors name the line.
    pub fn parse(text: &str) -> Result<Track, TrackError> {
        let (line, first) = pose_lines(text).next().ok_or(TrackError::Empty)?;
        match finite_numbers(first).map(|numbers| numbers.len()) {
            Some(8) => {
                let poses = parse_tum(text)?;
                let stamps_s = poses.iter().map(|pose| pose.stamp_s).collect();
                Ok(Track { stamps_s: Some(stamps_s), poses: poses.iter().map(|pose| pose.world_from_here).collect() })
            }
            Some(12) => Ok(Track { stamps_s: None, poses: parse_kitti(text)? }),
            _ => Err(TrackError::NoPose { line, found: describe_line(first) }),
        }
    }
}

/// KITTI's poses: the first three rows of a homogeneous matrix, one pose a line.
fn parse_kitti(text: &str) -> Result<Vec<Se3>, TrackError> {
    let pose = |(line, content): (usize, &str)| {
        let matrix = finite_numbers(content).filter(|numbers| numbers.len() == 12);
        let matrix = matrix.ok_or_else(|| TrackError::NotKitti { line, found: describe_line(content) })?;
        let pose = Se3 {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| matrix[4 * i + j])),
            translation_m: std::array::from_fn(|i| matrix[4 * i + 3]),
        };
        if is_rotation(&pose) { Ok(pose) } else { Err(TrackError::NoRotation { line }) }
    };
    pose_lines(text).map(pose).collect()
}

/// Whether the rows are orthonormal and right-handed. NaN is no rotation.
fn is_rotation(pose: &Se3) -> bool {
    let r = &pose.rotation;
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let is_close = |value: f64, wanted: f64| (value - wanted).abs() <= ROTATION_TOLERANCE;
    let is_orthonormal = (0..3).all(|i| (0..=i).all(|j| is_close(dot(r[i], r[j]), if i == j { 1.0 } else { 0.0 })));
    let cross = [
        r[0][1] * r[1][2] - r[0][2] * r[1][1],
        r[0][2] * r[1][0] - r[0][0] * r[1][2],
        r[0][0] * r[1][1] - r[0][1] * r[1][0],
    ];
    is_orthonormal && dot(cross, r[2]) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_are_read_and_comments_skipped() {
        let tum = Track::parse("# t x y z q\n1.5 1 2 3 0 0 0 2\n\n 2.5 1 2 4 0 0 0 1\n").unwrap();
        assert_eq!(tum.stamps_s, Some(vec![1.5, 2.5]));
        assert_eq!(tum.poses[1].translation_m, [1.0, 2.0, 4.0]);
        assert_eq!(tum.poses[0].rotation, Se3::IDENTITY.rotation);
        let kitti = Track::parse("1 0 0 7 0 1 0 8 0 0 1 9\n").unwrap();
        assert_eq!((kitti.stamps_s, kitti.poses[0].translation_m), (None, [7.0, 8.0, 9.0]));
    }

    #[test]
    fn malformed_text_is_refused_with_its_line() {
        let error = |text: &str| Track::parse(text).unwrap_err();
        assert_eq!(error("# only words\n"), TrackError::Empty);
        assert_eq!(error("1 2 3\n"), TrackError::NoPose { line: 1, found: "3 numbers".into() });
        assert_eq!(error("\n1 2 x\n"), TrackError::NoPose { line: 2, found: "\"1 2 x\"".into() });
        assert!(matches!(error("1 nan 0 0 0 0 0 1\n"), TrackError::NoPose { line: 1, .. }));
        assert_eq!(error("1 0 0 0 0 0 0 0\n"), TrackError::Tum(TumError::NoRotation { line: 1 }));
        assert_eq!(error("-1 0 0 7 0 1 0 8 0 0 1 9\n"), TrackError::NoRotation { line: 1 });
        let mixed = "1 0 0 0 0 0 0 1\n1 0 0 7 0 1 0 8 0 0 1 9\n";
        assert_eq!(error(mixed), TrackError::Tum(TumError::NoPose { line: 2, found: "12 numbers".into() }));
        let mixed = "1 0 0 7 0 1 0 8 0 0 1 9\n1 0 0 0 0 0 0 1\n";
        assert_eq!(error(mixed), TrackError::NotKitti { line: 2, found: "8 numbers".into() });
    }
}
