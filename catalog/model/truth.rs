//! The true poses of a traversal, from a file in TUM form, and which moments have one.

use crate::pose::Se3;
use crate::pose_lines::{finite_numbers, pose_lines};
use crate::tum::{TumError, parse_tum};

/// No pose is interpolated over a longer gap.
const GAP_NS: i128 = 1_000_000_000;
/// No pose is extrapolated farther than this.
const BEYOND_NS: i128 = 100_000_000;

/// True poses, in order of time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TruePoses {
    /// Nanoseconds, ascending.
    pub stamps_ns: Vec<i64>,
    /// The left camera in a world with x east, y north, z up; one for each stamp.
    pub world_from_left: Vec<Se3>,
}

/// Why a file holds no true poses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TruthError {
    /// No text in UTF-8.
    #[error("byte {at}: expected true poses as text, found other bytes{advice}")]
    NotText {
        /// How many bytes are text.
        at: usize,
        /// What to do; empty where nothing is known.
        advice: &'static str,
    },
    /// Not TUM's form.
    #[error(transparent)]
    Tum(#[from] TumError),
    /// KITTI's form.
    #[error(
        "line {line}: expected 8 numbers 'seconds tx ty tz qx qy qz qw', found 12, as KITTI's poses have: they carry no \
         stamps and stand in the first camera's frame; write them in TUM's form, in a world with z up (as motion in \
         place of odometry they go with --poses as they are)"
    )]
    Kitti {
        /// From 1.
        line: usize,
    },
    /// A stamp beyond any clock.
    #[error("line {line}: a stamp of {stamp_s} s is beyond any clock: are its stamps {unit}? TUM's are seconds")]
    Stamp {
        /// From 1.
        line: usize,
        /// As it stands there.
        stamp_s: f64,
        /// What the stamps most likely are.
        unit: &'static str,
    },
}

/// Two neighbouring true poses, and how far between them a moment is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Between {
    /// The earlier one.
    pub before: usize,
    /// The later one; the same where the moment is its own.
    pub after: usize,
    /// 0 at the earlier one, 1 at the later one; a little less or more beyond the ends.
    pub share: f64,
}

impl TruePoses {
    /// Reads a file of true poses.
    ///
    /// # Errors
    /// [`TruthError`] with the line.
    pub fn parse(bytes: &[u8]) -> Result<Self, TruthError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let is_utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
            let advice = if is_utf16 { ": it is UTF-16; `iconv -f UTF-16 -t UTF-8 FILE` gives UTF-8" } else { "" };
            TruthError::NotText { at: error.valid_up_to(), advice }
        })?;
        let poses = parse_tum(text).map_err(|error| match (error, pose_lines(text).next()) {
            (TumError::NoPose { line, .. }, Some((first, content)))
                if line == first && finite_numbers(content).is_some_and(|numbers| numbers.len() == 12) =>
            {
                TruthError::Kitti { line }
            }
            (error, _) => TruthError::Tum(error),
        })?;
        let mut truth = Self::default();
        for pose in poses {
            let (line, stamp_s) = (pose.line, pose.stamp_s);
            let beyond = || TruthError::Stamp { line, stamp_s, unit: likely_unit(stamp_s) };
            truth.stamps_ns.push(pose.stamp_ns.ok_or_else(beyond)?);
            truth.world_from_left.push(pose.world_from_here);
        }
        Ok(truth)
    }

    /// Where the left camera was at a moment, metres in the world: on the straight line between the poses beside it.
    pub fn position_m(&self, stamp_ns: i64) -> Option<[f64; 3]> {
        let Between { before, after, share } = between(&self.stamps_ns, stamp_ns)?;
        let [from, to] = [before, after].map(|place| self.world_from_left[place].translation_m);
        Some(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
    }

    /// Whether a moment has a true pose.
    pub fn has(&self, stamp_ns: i64) -> bool {
        between(&self.stamps_ns, stamp_ns).is_some()
    }
}

/// The unit in which a stamp would be of our time.
fn likely_unit(stamp: f64) -> &'static str {
    match stamp.abs() {
        size if size >= 1e17 => "nanoseconds",
        size if size >= 1e14 => "microseconds",
        _ => "milliseconds",
    }
}

/// Where a moment lies among ascending stamps; `None` outside of them (but for 0.1 s) or in a gap of over a second.
pub fn between(stamps_ns: &[i64], stamp_ns: i64) -> Option<Between> {
    let after = stamps_ns.partition_point(|stamp| *stamp < stamp_ns);
    if stamps_ns.get(after) == Some(&stamp_ns) {
        return Some(Between { before: after, after, share: 0.0 });
    }
    // Just beyond its ends the track goes on as it was: the first image often comes a moment before the first fix.
    let last = stamps_ns.len().checked_sub(1)?;
    let after = after.clamp(1, last.max(1));
    let before = after - 1;
    let [from, to, here] = [*stamps_ns.get(before)?, *stamps_ns.get(after)?, stamp_ns].map(i128::from);
    if to - from > GAP_NS || (from - here).max(here - to) > BEYOND_NS {
        return None;
    }
    Some(Between { before, after, share: (here - from) as f64 / (to - from) as f64 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_has_a_pose_between_two_that_are_near() {
        let stamps_ns = [0, 1_000_000_000, 5_000_000_000];
        let share = |stamp_ns| between(&stamps_ns, stamp_ns).map(|found| found.share);
        assert_eq!((share(0), share(250_000_000), share(-100_000_000)), (Some(0.0), Some(0.25), Some(-0.1)));
        for without in [-100_000_001, 1_000_000_001, 4_999_999_999, i64::MIN, i64::MAX] {
            assert_eq!(share(without), None, "{without}");
        }
        assert_eq!(between(&[i64::MIN, i64::MAX], 0), None);
        assert_eq!((between(&[], 0), between(&[7], 8)), (None, None));
        assert!(between(&[7], 7).is_some());
    }

    #[test]
    fn other_units_and_forms_are_named() {
        let said = |bytes: &[u8]| TruePoses::parse(bytes).unwrap_err().to_string();
        for (stamp, unit) in
            [("1700000000000000000", "nanoseconds"), ("1700000000000000", "microseconds"), ("1.7e12", "milliseconds")]
        {
            let text = format!("# poses\n{stamp} 0 0 0 0 0 0 1\n");
            assert!(said(text.as_bytes()).contains("line 2: a stamp of"), "{text}");
            assert!(said(text.as_bytes()).contains(unit), "{text}");
        }
        assert!(said(b"1 0 0 0 0 1 0 0 0 0 1 0\n").contains("KITTI"));
        assert!(said(b"\xff\xfe1\x00 \x00").contains("UTF-16"));
        assert_eq!(TruePoses::parse(b"# nothing\n"), Ok(TruePoses::default()));
    }
}
