//! Tracks in the file formats of TUM and KITTI.

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
    /// A line that is neither in the TUM nor in the KITTI format.
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
    /// Both formats in one file.
    #[error("line {line}: {found} numbers, but the lines before have {expected}")]
    Mixed {
        /// From 1.
        line: usize,
        /// Numbers of the first line.
        expected: usize,
        /// Numbers of this line.
        found: usize,
    },
    /// A quaternion of length zero, or a matrix that is no rotation.
    #[error("line {line}: the orientation is not a rotation")]
    NoRotation {
        /// From 1.
        line: usize,
    },
    /// Stamps that do not ascend.
    #[error("line {line}: stamp {stamp_s} s is not after {before_s} s, that of the pose before; sort the file by time")]
    OutOfOrder {
        /// From 1.
        line: usize,
        /// The stamp of the line.
        stamp_s: f64,
        /// The stamp before.
        before_s: f64,
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
        let (mut stamps_s, mut poses) = (Vec::new(), Vec::new());
        let mut first_len = None;
        for (index, content) in text.lines().enumerate() {
            let (line, content) = (index + 1, content.trim());
            if content.is_empty() || content.starts_with('#') {
                continue;
            }
            let numbers = parse_numbers(content).ok_or_else(|| no_pose_error(line, content))?;
            let expected = *first_len.get_or_insert(numbers.len());
            if numbers.len() != expected {
                return Err(TrackError::Mixed { line, expected, found: numbers.len() });
            }
            let pose = match numbers.as_slice() {
                &[stamp_s, tx, ty, tz, qx, qy, qz, qw] => {
                    if let Some(&before_s) = stamps_s.last().filter(|&&before_s| before_s >= stamp_s) {
                        return Err(TrackError::OutOfOrder { line, stamp_s, before_s });
                    }
                    stamps_s.push(stamp_s);
                    Se3::from_quaternion([qx, qy, qz, qw], [tx, ty, tz])
                }
                matrix if matrix.len() == 12 => Se3 {
                    rotation: std::array::from_fn(|i| std::array::from_fn(|j| matrix[4 * i + j])),
                    translation_m: std::array::from_fn(|i| matrix[4 * i + 3]),
                },
                _ => return Err(no_pose_error(line, content)),
            };
            if !is_rotation(&pose) {
                return Err(TrackError::NoRotation { line });
            }
            poses.push(pose);
        }
        match first_len {
            None => Err(TrackError::Empty),
            Some(8) => Ok(Track { stamps_s: Some(stamps_s), poses }),
            Some(_) => Ok(Track { stamps_s: None, poses }),
        }
    }
}

fn parse_numbers(line: &str) -> Option<Vec<f64>> {
    line.split_whitespace().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect()
}

fn no_pose_error(line: usize, content: &str) -> TrackError {
    let words = content.split_whitespace().count();
    let found = if parse_numbers(content).is_some() {
        format!("{words} numbers")
    } else {
        let shown: String = content.chars().take(60).collect();
        format!("{shown:?}")
    };
    TrackError::NoPose { line, found }
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
        assert_eq!(error("1 0 0 0 0 0 0 0\n"), TrackError::NoRotation { line: 1 });
        assert_eq!(error("-1 0 0 7 0 1 0 8 0 0 1 9\n"), TrackError::NoRotation { line: 1 });
        let twice = "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
        assert_eq!(error(twice), TrackError::OutOfOrder { line: 2, stamp_s: 1.0, before_s: 1.0 });
        let mixed = "1 0 0 0 0 0 0 1\n1 0 0 7 0 1 0 8 0 0 1 9\n";
        assert_eq!(error(mixed), TrackError::Mixed { line: 2, expected: 8, found: 12 });
        assert!(matches!(error("1 nan 0 0 0 0 0 1\n"), TrackError::NoPose { line: 1, .. }));
    }
}
