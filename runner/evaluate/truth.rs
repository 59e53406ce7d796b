//! True positions of frames: from a file of poses that came with the recording, or from its satellite fixes where they
//! are good enough.

use crate::RunError;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Objects, tables};
use furrow_model::truth::between;
use furrow_model::{Se3, TruePoses, TruthError, is_satellite_fix};

/// A true pose on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPose {
    /// Metres east of the frame's origin.
    pub east_m: f64,
    /// Metres north.
    pub north_m: f64,
    /// Where the camera looks, radians counter-clockwise from east.
    pub heading_rad: f64,
}

/// What frame the positions stand in. Positions of two traversals compare only in the same frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// The world of a simulation or a surveyed site, as the pose file gives it.
    World,
    /// Latitude and longitude, projected about the track's first fix; see [`GroundTruth::in_frame_of`].
    Geodetic,
}

/// The true track of a traversal.
#[derive(Debug, Clone)]
pub struct GroundTruth {
    /// Shown beside every number that uses it.
    pub source: String,
    /// The frame of the positions.
    pub frame: Frame,
    stamps_ns: Vec<i64>,
    poses: Vec<GroundPose>,
    plane: Option<LocalPlane>,
}

/// A fix counts as ground truth when its standard deviation is at most this: a good localisation is one within 2.5 m.
const FIX_STD_M: f64 = 0.5;
/// WGS 84: semi-major axis and squared eccentricity.
const WGS84_A_M: f64 = 6_378_137.0;
const WGS84_E2: f64 = 6.694_379_990_14e-3;
/// The heading of a track without orientation is its direction over this distance.
const HEADING_BASE_M: f64 = 1.0;

impl GroundTruth {
    /// The best ground truth of a traversal; `None` where it has none.
    ///
    /// # Errors
    /// Where a table or the pose file cannot be read.
    pub fn of(objects: &Objects, traversal: &TraversalRecord) -> Result<Option<Self>, RunError> {
        if let Some(file) = traversal.ground_truth {
            return Self::from_tum(&objects.read(file)?).map(Some);
        }
        Self::by_fixes(objects, traversal, FIX_STD_M)
    }

    /// The track of a traversal's satellite fixes whose standard deviations are at most `std_m`; `None` where it has
    /// fewer than two.
    ///
    /// # Errors
    /// Where a table cannot be read.
    pub(crate) fn by_fixes(
        objects: &Objects,
        traversal: &TraversalRecord,
        std_m: f64,
    ) -> Result<Option<Self>, RunError> {
        for sensor in traversal.sensors.iter().filter(|sensor| sensor.kind == "nav_sat_fix") {
            let mut fixes = Vec::new();
            for part in &sensor.parts {
                let table = tables::from_parquet("satellite fixes", objects.read(*part)?)?;
                let (stamps, lat, lon) = (
                    tables::i64s(&table, "stamp_ns")?,
                    tables::f64s(&table, "latitude_deg")?,
                    tables::f64s(&table, "longitude_deg")?,
                );
                let variance = (tables::f64s(&table, "east_variance_m2")?, tables::f64s(&table, "north_variance_m2")?);
                let status = tables::f64s(&table, "status")?;
                // An unknown variance is NaN, which is not small.
                let small = std_m * std_m;
                let good = |i: &usize| {
                    let certain = [variance.0[*i], variance.1[*i]].iter().all(|v| (0.0..=small).contains(v));
                    certain && is_satellite_fix(status[*i], lat[*i], lon[*i])
                };
                fixes.extend((0..stamps.len()).filter(good).map(|i| (stamps[i], lat[i], lon[i])));
            }
            if fixes.len() >= 2 {
                return Ok(Some(Self::from_fixes(&sensor.topic, fixes)));
            }
        }
        Ok(None)
    }

    /// Poses in TUM form: `seconds tx ty tz qx qy qz qw`, the left camera in a world with x east, y north, z up.
    ///
    /// # Errors
    /// Names the line that is not of that form.
    pub fn from_tum(bytes: &[u8]) -> Result<Self, RunError> {
        let unreadable = |error: TruthError| {
            RunError::GroundTruth(format!("{error}; mend the file and replace it with `furrow attach-truth`"))
        };
        let TruePoses { stamps_ns, world_from_left } = TruePoses::parse(bytes).map_err(unreadable)?;
        let on_ground = |Se3 { rotation, translation_m: [east_m, north_m, _] }: Se3| {
            let forward = rotation.map(|row| row[2]);
            GroundPose { east_m, north_m, heading_rad: libm::atan2(forward[1], forward[0]) }
        };
        let poses = world_from_left.into_iter().map(on_ground).collect();
        Ok(Self {
            source: "true poses of the recording".to_owned(),
            frame: Frame::World,
            stamps_ns,
            poses,
            plane: None,
        })
    }

    fn from_fixes(topic: &str, mut fixes: Vec<(i64, f64, f64)>) -> Self {
        fixes.sort_by_key(|fix| fix.0);
        fixes.dedup_by_key(|fix| fix.0);
        let plane = LocalPlane::about(fixes[0].1, fixes[0].2);
        let points: Vec<(f64, f64)> = fixes.iter().map(|(_, lat, lon)| plane.project(*lat, *lon)).collect();
        let poses = points
            .iter()
            .enumerate()
            .map(|(i, point)| GroundPose { east_m: point.0, north_m: point.1, heading_rad: direction(&points, i) })
            .collect();
        Self {
            source: format!("satellite fixes of the recording ({topic})"),
            frame: Frame::Geodetic,
            stamps_ns: fixes.iter().map(|fix| fix.0).collect(),
            poses,
            plane: Some(plane),
        }
    }

    /// The same track in the frame of `other`: fixes projected about the other's first one. Pose files share one world
    /// already.
    pub fn in_frame_of(mut self, other: &GroundTruth) -> Self {
        if let (Some(own), Some(plane)) = (self.plane, other.plane) {
            for pose in &mut self.poses {
                let (lat, lon) = own.unproject(pose.east_m, pose.north_m);
                (pose.east_m, pose.north_m) = plane.project(lat, lon);
            }
            self.plane = Some(plane);
        }
        self
    }

    /// The pose at a moment, interpolated; `None` outside the track (but for 0.1 s) or in a gap of over a second.
    pub fn at(&self, stamp_ns: i64) -> Option<GroundPose> {
        let found = between(&self.stamps_ns, stamp_ns)?;
        let (a, b, share) = (*self.poses.get(found.before)?, *self.poses.get(found.after)?, found.share);
        if found.before == found.after {
            return Some(a);
        }
        let turn = wrap(b.heading_rad - a.heading_rad);
        Some(GroundPose {
            east_m: a.east_m + share * (b.east_m - a.east_m),
            north_m: a.north_m + share * (b.north_m - a.north_m),
            heading_rad: wrap(a.heading_rad + share * turn),
        })
    }

    /// Where its first fix lies, degrees north and east; `None` of a file of poses.
    pub(crate) fn place(&self) -> Option<[f64; 2]> {
        self.plane.map(|plane| [plane.latitude_deg, plane.longitude_deg])
    }

    /// Latitude and longitude of a pose of this track, degrees; `None` of a file of poses.
    pub(crate) fn geodetic_deg(&self, pose: GroundPose) -> Option<[f64; 2]> {
        self.plane.map(|plane| plane.unproject(pose.east_m, pose.north_m).into())
    }

    /// Every true pose, in order.
    pub fn poses(&self) -> &[GroundPose] {
        &self.poses
    }
}

/// An angle between -pi and pi.
pub fn wrap(angle_rad: f64) -> f64 {
    let turns = (angle_rad / std::f64::consts::TAU).round();
    angle_rad - turns * std::f64::consts::TAU
}

/// A plane that touches the WGS 84 ellipsoid: flat enough over a field.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LocalPlane {
    latitude_deg: f64,
    longitude_deg: f64,
    /// Metres per radian of longitude and of latitude there.
    metres: (f64, f64),
}

impl LocalPlane {
    fn about(latitude_deg: f64, longitude_deg: f64) -> Self {
        let sin = libm::sin(latitude_deg.to_radians());
        let w2 = 1.0 - WGS84_E2 * sin * sin;
        let east = WGS84_A_M / w2.sqrt() * libm::cos(latitude_deg.to_radians());
        let north = WGS84_A_M * (1.0 - WGS84_E2) / (w2 * w2.sqrt());
        Self { latitude_deg, longitude_deg, metres: (east, north) }
    }

    fn project(&self, latitude_deg: f64, longitude_deg: f64) -> (f64, f64) {
        let (east, north) = (longitude_deg - self.longitude_deg, latitude_deg - self.latitude_deg);
        (east.to_radians() * self.metres.0, north.to_radians() * self.metres.1)
    }

    fn unproject(&self, east_m: f64, north_m: f64) -> (f64, f64) {
        let (east, north) = ((east_m / self.metres.0).to_degrees(), (north_m / self.metres.1).to_degrees());
        (self.latitude_deg + north, self.longitude_deg + east)
    }
}

/// The direction of a track at point i: between the last point a metre before and the first a metre after.
fn direction(points: &[(f64, f64)], i: usize) -> f64 {
    let far = |j: &usize| {
        let (dx, dy) = (points[*j].0 - points[i].0, points[*j].1 - points[i].1);
        dx * dx + dy * dy >= HEADING_BASE_M * HEADING_BASE_M
    };
    let before = (0..i).rev().find(far).unwrap_or(i);
    let after = (i + 1..points.len()).find(far).unwrap_or(i);
    libm::atan2(points[after].1 - points[before].1, points[after].0 - points[before].0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_looking_north_has_heading_ninety_degrees() {
        // Camera z to world y (north), camera y to world -z (down), camera x to world x (east).
        let half = std::f64::consts::FRAC_PI_4;
        let text =
            format!("0 1 2 0 {} 0 0 {}\n1.0 1 4 0 {} 0 0 {}\n", -half.sin(), half.cos(), -half.sin(), half.cos());
        let truth = GroundTruth::from_tum(text.as_bytes()).unwrap();
        let middle = truth.at(500_000_000).unwrap();
        assert!((middle.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{middle:?}");
        assert_eq!((middle.east_m, middle.north_m), (1.0, 3.0));
        assert_eq!(truth.at(1_100_000_001), None);
        assert!((truth.at(1_050_000_000).unwrap().north_m - 4.1).abs() < 1e-9);
    }

    #[test]
    fn tracks_of_one_site_meet_in_one_frame() {
        let live = GroundTruth::from_fixes("/fix", vec![(0, 49.0999, 8.05), (1, 49.1001, 8.05)]);
        let map = GroundTruth::from_fixes("/fix", vec![(0, 49.1001, 8.05), (1, 49.1002, 8.05)]).in_frame_of(&live);
        let (a, b) = (live.poses()[1], map.poses()[0]);
        assert!((a.east_m - b.east_m).abs() < 1e-6 && (a.north_m - b.north_m).abs() < 1e-6, "{a:?} {b:?}");
    }

    #[test]
    fn fixes_become_metres() {
        // One ten-thousandth of a degree of latitude at 49 degrees north is 11.12 m.
        let truth = GroundTruth::from_fixes("/fix", vec![(0, 49.05, 8.05), (1, 49.0501, 8.05)]);
        let (a, b) = (truth.poses()[0], truth.poses()[1]);
        assert!((b.north_m - a.north_m - 11.12).abs() < 0.02, "{}", b.north_m - a.north_m);
        assert!((b.east_m - a.east_m).abs() < 1e-9);
        assert!((b.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    }
}
