//! Where the steps of the chain come from: odometry, or what the user knows in its place.

use crate::traversal::error::IngestError;
use furrow_catalog::records::TraversalRecord;
use furrow_model::{Se3, Step, Trajectory};
use furrow_odometry::compare::Track;
use serde::Serialize;
use std::fs;
use std::path::PathBuf;

/// Where the steps of a traversal's chain come from.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionSource {
    /// Stereo odometry.
    Odometry,
    /// A distance in metres from image to image, straight ahead: all that is known of pictures taken along a path.
    Spacing(f64),
    /// A file of camera poses in TUM's or KITTI's form; left camera, x right, y down, z forward.
    Poses(PathBuf),
}

const ODOMETRY: &str = "stereo-odometry/";

/// What a chain's table holds: since 1, every step's covariance.
const CHAIN_VERSION: u32 = 1;

/// A pose and an image belong together within this, seconds: files of poses print stamps to the microsecond or better.
const SAME_MOMENT_S: f64 = 1e-3;

/// What stands in for odometry, read and checked.
#[derive(Debug)]
pub(crate) enum GivenMotion {
    Spacing(f64),
    Poses { path: PathBuf, track: Track },
}

/// A given motion as part of a request's digest.
#[derive(Debug, Serialize)]
pub(crate) enum GivenIdentity {
    Spacing { metres: f64 },
    Poses { digest: furrow_model::ObjectId },
}

impl MotionSource {
    /// The source of steps and its version, as traversals record it. It is part of every request's identity, so that a
    /// better odometry makes new versions.
    pub(crate) fn version(&self) -> String {
        match self {
            Self::Odometry => format!("{ODOMETRY}{}.{CHAIN_VERSION}", furrow_odometry::ALGORITHM_VERSION),
            Self::Spacing(metres) => format!("given spacing of {metres} m"),
            Self::Poses(_) => "given poses".to_owned(),
        }
    }

    /// Reads and checks the motion that is given; `None` where odometry is asked for.
    pub(crate) fn read_given(&self) -> Result<Option<GivenMotion>, IngestError> {
        match self {
            Self::Odometry => Ok(None),
            Self::Spacing(metres) if *metres > 0.0 && metres.is_finite() => Ok(Some(GivenMotion::Spacing(*metres))),
            Self::Spacing(metres) => Err(IngestError::Request(format!(
                "a spacing of {metres} m between images: expected a number of metres greater than 0"
            ))),
            Self::Poses(path) => {
                let text = fs::read_to_string(path).map_err(IngestError::file(path))?;
                let wrong_poses = |error| IngestError::Request(format!("{}: {error}", path.display()));
                Ok(Some(GivenMotion::Poses { path: path.clone(), track: Track::parse(&text).map_err(wrong_poses)? }))
            }
        }
    }
}

impl GivenMotion {
    /// The chain through frames stamped `stamps_ns`, which have these `numbers` in a recording of `recorded` moments:
    /// what was not selected or could not be read counts, too. No step has matches or inliers: nothing was matched.
    pub(crate) fn chain(&self, stamps_ns: &[i64], numbers: &[u32], recorded: u32) -> Result<Trajectory, IngestError> {
        let poses = (stamps_ns.iter().zip(numbers))
            .map(|(&stamp_ns, &number)| self.pose(stamp_ns, number, recorded))
            .collect::<Result<Vec<Se3>, _>>()?;
        let step = |(stamps, poses): (&[i64], &[Se3])| Step {
            from_ns: stamps[0],
            to_ns: stamps[1],
            earlier_from_later: poses[0].inverse().compose(&poses[1]),
            matches: 0,
            inliers: 0,
            valid: true,
            covariance: None,
        };
        let steps = stamps_ns.windows(2).zip(poses.windows(2)).map(step).collect();
        Ok(Trajectory { start_ns: stamps_ns.first().copied(), steps })
    }

    /// The pose of moment `number`, stamped `stamp_ns`, of `recorded` ones.
    fn pose(&self, stamp_ns: i64, number: u32, recorded: u32) -> Result<Se3, IngestError> {
        let (path, track) = match self {
            Self::Spacing(metres) => {
                return Ok(Se3 { translation_m: [0.0, 0.0, metres * f64::from(number)], ..Se3::IDENTITY });
            }
            Self::Poses { path, track } => (path, track),
        };
        let Some(stamps_s) = &track.stamps_s else {
            return track.poses.get(number as usize).copied().ok_or_else(|| {
                let (path, poses) = (path.display(), track.poses.len());
                IngestError::Request(format!(
                    "{path}: {poses} poses without stamps, but {recorded} images: give a pose for each"
                ))
            });
        };
        let wanted_s = stamp_ns as f64 / 1e9;
        let after = stamps_s.partition_point(|stamp_s| *stamp_s < wanted_s);
        let near =
            |place: &usize| stamps_s.get(*place).is_some_and(|stamp_s| (stamp_s - wanted_s).abs() <= SAME_MOMENT_S);
        let found = [after, after.wrapping_sub(1)].into_iter().find(near).map(|place| track.poses[place]);
        found.ok_or_else(|| {
            let path = path.display();
            IngestError::Request(format!(
                "{path}: no pose within {SAME_MOMENT_S} s of the image stamped {stamp_ns} ns: give a pose for each \
                 image, or choose images with --frames A..B"
            ))
        })
    }
}

/// What the distances along a traversal's chain come from, in words. Outcomes store this text, so it must not change.
pub fn distance_source(traversal: &TraversalRecord) -> String {
    let motion = &traversal.odometry;
    if motion.starts_with(ODOMETRY) {
        "odometry chain of the live pass".to_owned()
    } else {
        format!("{motion} of the live pass")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAMPS: [i64; 3] = [0, 200_000_000, 400_000_000];

    #[test]
    fn images_that_the_selection_leaves_out_count_as_distance() {
        let chain = GivenMotion::Spacing(5.0).chain(&STAMPS, &[0, 2, 4], 6).unwrap();
        assert_eq!((chain.frames(), chain.length_m(), chain.failed_steps()), (3, 20.0, 0));
        assert!(chain.steps.iter().all(|step| step.inliers == 0));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(MotionSource::Spacing(wrong).read_given().unwrap_err().to_string().contains("greater than 0"));
        }
    }

    #[test]
    fn poses_are_found_by_stamp_or_by_number() {
        let given = |text: &str| GivenMotion::Poses { path: "p.tum".into(), track: Track::parse(text).unwrap() };
        let stamped = given("0 1 1 1 0 0 0 1\n0.2 1 1 3 0 0 0 1\n0.3 9 9 9 0 0 0 1\n0.4 1 1 7 0 0 0 1\n");
        let chain = stamped.chain(&STAMPS, &[0, 1, 2], 3).unwrap();
        assert_eq!(
            chain.steps.iter().map(|step| step.earlier_from_later.translation_m[2]).collect::<Vec<_>>(),
            [2.0, 4.0]
        );
        let said = stamped.chain(&[0, 150_000_000], &[0, 1], 2).unwrap_err().to_string();
        assert!(said.contains("p.tum") && said.contains("150000000"), "{said}");
        let bare = given("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n");
        assert_eq!(bare.chain(&STAMPS[..2], &[0, 1], 2).unwrap().length_m(), 2.0);
        assert!(bare.chain(&STAMPS, &[0, 1, 2], 3).unwrap_err().to_string().contains("2 poses"));
    }
}
