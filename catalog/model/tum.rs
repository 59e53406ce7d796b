//! Poses as the TUM RGB-D benchmark (Sturm et al. 2012) writes them: a line for each, `seconds tx ty tz qx qy qz qw`.
//! Lines that begin with `#` are comments.

use crate::pose::Se3;
use crate::seconds::parse_seconds_ns;

/// A pose and its stamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TumPose {
    /// The stamp, seconds, as near as an `f64` comes.
    pub stamp_s: f64,
    /// The stamp to the nanosecond; `None` beyond the 292 years that an `i64` holds.
    pub stamp_ns: Option<i64>,
    /// The pose: the file's world from the camera or body that moves.
    pub world_from_here: Se3,
}

/// A line that is no pose, or no pose after the one before it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TumError {
    /// Not eight finite numbers.
    #[error("line {line}: expected 8 numbers 'seconds tx ty tz qx qy qz qw', found {found}")]
    NoPose {
        /// From 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A quaternion of length zero.
    #[error("line {line}: expected a rotation, found a quaternion of length 0")]
    NoRotation {
        /// From 1.
        line: usize,
    },
    /// Stamps that do not ascend.
    #[error(
        "line {line}: expected a stamp after {before_s} s, that of the pose before, found {stamp_s} s; sort the file \
         by time"
    )]
    OutOfOrder {
        /// From 1.
        line: usize,
        /// This stamp.
        stamp_s: f64,
        /// The one before.
        before_s: f64,
    },
}

/// The poses of a text in TUM form, in order. A text without any gives none.
///
/// # Errors
/// [`TumError`] with the line's number.
pub fn parse_tum(text: &str) -> Result<Vec<TumPose>, TumError> {
    let mut poses: Vec<TumPose> = Vec::new();
    for (line, content) in pose_lines(text) {
        let pose = parse_line(content).ok_or_else(|| TumError::NoPose { line, found: describe_line(content) })?;
        if !pose.world_from_here.rotation.iter().flatten().all(|value| value.is_finite()) {
            return Err(TumError::NoRotation { line });
        }
        let stamp_s = pose.stamp_s;
        if let Some(before_s) = poses.last().map(|before| before.stamp_s).filter(|before_s| *before_s >= stamp_s) {
            return Err(TumError::OutOfOrder { line, stamp_s, before_s });
        }
        poses.push(pose);
    }
    Ok(poses)
}

/// The lines of a file of poses that are neither blank nor comments, each with its number from 1.
pub fn pose_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    lines.filter(|(_, content)| !content.is_empty() && !content.starts_with('#'))
}

/// The numbers of a line; `None` where a word is no finite number.
pub fn finite_numbers(line: &str) -> Option<Vec<f64>> {
    line.split_whitespace().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect()
}

/// What an error says of a line that is no pose: how many numbers it has, or how it begins.
pub fn describe_line(line: &str) -> String {
    match finite_numbers(line) {
        Some(numbers) => format!("{} numbers", numbers.len()),
        None => format!("{:?}", line.chars().take(60).collect::<String>()),
    }
}

fn parse_line(line: &str) -> Option<TumPose> {
    let &[stamp_s, tx, ty, tz, qx, qy, qz, qw] = finite_numbers(line)?.as_slice() else { return None };
    let stamp_ns = line.split_whitespace().next().and_then(parse_seconds_ns);
    Some(TumPose { stamp_s, stamp_ns, world_from_here: Se3::from_quaternion([qx, qy, qz, qw], [tx, ty, tz]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_read_and_comments_skipped() {
        let poses =
            parse_tum("# t x y z q\n1317045935.500923136 1 2 3 0 0 0 2\n\n # more\n 1.4e9 1 2 4 0 0 0 1\n").unwrap();
        assert_eq!(poses.iter().map(|pose| pose.stamp_s).collect::<Vec<_>>(), [1317045935.5009232, 1.4e9]);
        assert_eq!(poses[0].stamp_ns, Some(1_317_045_935_500_923_136));
        assert_eq!(poses[1].world_from_here.translation_m, [1.0, 2.0, 4.0]);
        assert_eq!(poses[0].world_from_here.rotation, Se3::IDENTITY.rotation);
        assert_eq!(parse_tum("# nothing\n"), Ok(Vec::new()));
        assert_eq!(parse_tum("1e12 0 0 0 0 0 0 1").unwrap()[0].stamp_ns, None);
    }

    #[test]
    fn what_is_no_pose_is_refused_with_its_line() {
        let error = |text: &str| parse_tum(text).unwrap_err();
        assert_eq!(error("1 2 3\n"), TumError::NoPose { line: 1, found: "3 numbers".into() });
        assert_eq!(error("\n1 2 x\n"), TumError::NoPose { line: 2, found: "\"1 2 x\"".into() });
        assert!(matches!(error("1 nan 0 0 0 0 0 1\n"), TumError::NoPose { line: 1, .. }));
        assert_eq!(error("1 0 0 0 0 0 0 0\n"), TumError::NoRotation { line: 1 });
        let twice = "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
        assert_eq!(error(twice), TumError::OutOfOrder { line: 2, stamp_s: 1.0, before_s: 1.0 });
        let text = error("1 2 3\n").to_string();
        assert!(text.contains("line 1: expected 8 numbers") && text.contains("found 3 numbers"), "{text}");
    }
}
