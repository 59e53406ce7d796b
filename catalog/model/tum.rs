//! Poses as the TUM RGB-D benchmark (Sturm et al. 2012) writes them: a line for each, `seconds tx ty tz qx qy qz qw`.
//! Lines that begin with `#` are comments; a first line of the columns' names is passed over; commas or tabs may stand
//! for blanks.

use crate::pose::Se3;
use crate::pose_lines::other_columns;
pub use crate::pose_lines::{describe_line, finite_numbers, pose_lines, words};
use crate::seconds::parse_seconds_ns;
use std::cmp::Ordering;

/// A pose and its stamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TumPose {
    /// The line, from 1.
    pub line: usize,
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
    /// A line that names columns in another order.
    #[error(
        "line {line}: expected columns in TUM's order 'timestamp tx ty tz qx qy qz qw' with seconds, found {found}: the \
         file is of another form, such as EuRoC's with nanoseconds and qw first; write it in TUM's, the left camera's \
         poses (EuRoC's columns are turned by `awk -F, '!/^#/ {{print substr($1,1,10)\".\"substr($1,11), \
         $2,$3,$4,$6,$7,$8,$5}}' FILE`)"
    )]
    OtherColumns {
        /// From 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// Not eight finite numbers.
    #[error(
        "line {line}: expected 8 numbers 'seconds tx ty tz qx qy qz qw', found {found}; leave out lines that are no pose"
    )]
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
    /// The stamp of the pose before.
    #[error(
        "line {line}: a second pose stamped {stamp_s} s, as in the line before it: keep one of the two (`awk \
         '!seen[$1]++' FILE` keeps the first of each stamp)"
    )]
    Twice {
        /// From 1.
        line: usize,
        /// This stamp.
        stamp_s: f64,
    },
    /// Stamps that do not ascend.
    #[error(
        "line {line}: expected a stamp after {before_s} s, that of the pose before, found {stamp_s} s; sort the file \
         by time (`sort -g FILE`)"
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
    if let Some((line, columns)) = other_columns(text) {
        return Err(TumError::OtherColumns {
            line,
            found: format!("{:?}", columns.chars().take(80).collect::<String>()),
        });
    }
    let mut poses: Vec<TumPose> = Vec::new();
    for (line, content) in pose_lines(text) {
        let pose = parse_line(line, content).ok_or_else(|| TumError::NoPose { line, found: describe_line(content) })?;
        if !pose.world_from_here.rotation.iter().flatten().all(|value| value.is_finite()) {
            return Err(TumError::NoRotation { line });
        }
        if let Some(before) = poses.last() {
            let (stamp_s, before_s) = (pose.stamp_s, before.stamp_s);
            match order(before, &pose) {
                Ordering::Less => {}
                Ordering::Equal => return Err(TumError::Twice { line, stamp_s }),
                Ordering::Greater => return Err(TumError::OutOfOrder { line, stamp_s, before_s }),
            }
        }
        poses.push(pose);
    }
    Ok(poses)
}

/// The order of two poses in time: to the nanosecond, where both stamps are that near.
fn order(before: &TumPose, after: &TumPose) -> Ordering {
    match (before.stamp_ns, after.stamp_ns) {
        (Some(before), Some(after)) => before.cmp(&after),
        _ => before.stamp_s.total_cmp(&after.stamp_s),
    }
}

fn parse_line(line: usize, content: &str) -> Option<TumPose> {
    let &[stamp_s, tx, ty, tz, qx, qy, qz, qw] = finite_numbers(content)?.as_slice() else { return None };
    let stamp_ns = words(content).first().and_then(|word| parse_seconds_ns(word));
    Some(TumPose { line, stamp_s, stamp_ns, world_from_here: Se3::from_quaternion([qx, qy, qz, qw], [tx, ty, tz]) })
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
        assert_eq!(error(twice), TumError::Twice { line: 2, stamp_s: 1.0 });
        assert!(!error(twice).to_string().contains("sort"), "a stamp that stands twice is not mended by sorting");
        let back = "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
        assert_eq!(error(back), TumError::OutOfOrder { line: 2, stamp_s: 1.0, before_s: 2.0 });
        let text = error("1 2 3\n").to_string();
        assert!(text.contains("line 1: expected 8 numbers") && text.contains("found 3 numbers"), "{text}");
    }

    #[test]
    fn every_way_of_writing_a_pose_gives_the_same() {
        let plain = "1700000000.100000000 1 2 3 0 0 0 1\n1700000000.2 1 2 4 0 0 0 1\n";
        let stamps = |text: &str| parse_tum(text).unwrap().iter().map(|pose| pose.stamp_ns).collect::<Vec<_>>();
        let expected = [Some(1_700_000_000_100_000_000), Some(1_700_000_000_200_000_000)];
        let header = "timestamp tx ty tz qx qy qz qw\n";
        for text in [
            plain.to_owned(),
            plain.replace('\n', "\r\n"),
            plain.replace('\n', " \n"),
            plain.replace(' ', "\t"),
            plain.replace(' ', ","),
            plain.replace(' ', ", "),
            format!("\u{feff}{plain}"),
            format!("\u{feff}{header}{plain}"),
            format!("{}{}", header.replace(' ', ","), plain.replace(' ', ",")),
            format!("#{header}# more\n{plain}"),
            plain.replace("1700000000.100000000", "1.7000000001e9"),
        ] {
            assert_eq!(stamps(&text), expected, "{text:?}");
        }
    }

    #[test]
    fn a_quaternion_that_is_named_in_another_order_is_never_read() {
        for columns in
            ["#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z", "time x y z qw qx qy qz", "# t x y z w x y z qw qx qy qz"]
        {
            let error = parse_tum(&format!("{columns}\n1 0 0 0 1 0 0 0\n")).unwrap_err();
            assert!(matches!(error, TumError::OtherColumns { line: 1, .. }), "{error}");
        }
    }

    #[test]
    fn stamps_nearer_than_an_f64_tells_are_in_order() {
        let text = "1700000000.000000001 0 0 0 0 0 0 1\n1700000000.000000002 0 0 0 0 0 0 1\n";
        assert_eq!(parse_tum(text).unwrap().len(), 2);
    }
}
