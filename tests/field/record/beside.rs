//! The files beside a recording: ground truth, sun and exposure per frame, and the traversal that was simulated.

use super::error::RecordError;
use super::fresh::FreshFile;
use crate::camera::Exposure;
use crate::simulation::{Frame, Simulation};
use crate::sun::sun_position;
use furrow_model::Se3;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Head of the ground truth. The pose of a frame is the true one in the middle of its exposure, under the name that the
/// recording gives it: the stamp of its left image, by the camera's clock. Frames whose images were lost have theirs
/// too.
const TRUTH: &str = "# timestamp tx ty tz qx qy qz qw (world from rectified left camera; camera x right, y down, \
    z forward; world x east, y north, z up; metres; timestamp: the left image's stamp in seconds, by the camera's own \
    clock; frames.csv has the true times)\n";
/// Head of the table: stamps by the camera's clock, `true_ns` the true time of the exposure's middle, `motion_px` how
/// far the left image moved for motion blur, and whether (1 or 0) each image is in the recording.
const TABLE: &str = "index,stamp_ns,sun_elevation_deg,sun_azimuth_deg,exposure_s,gain,true_ns,right_stamp_ns,\
    left_recorded,right_recorded,motion_px\n";

/// What is noted during a traversal.
pub struct Beside {
    start_ns: i64,
    region_m: [f64; 2],
    truth: String,
    table: String,
    path_m: f64,
    last: Option<Se3>,
    frames: u64,
    images: [u64; 2],
    pairs: u64,
    stamps_ns: (i64, i64),
    sun: Box<dyn Fn(f64) -> (f64, f64)>,
}

impl Beside {
    /// Nothing noted yet of `simulation`.
    pub fn of(simulation: &Simulation) -> Beside {
        let (site, day, start_s) =
            (simulation.traversal().site, simulation.traversal().date.day_of_year(), simulation.traversal().start_s());
        Beside {
            start_ns: simulation.traversal().start_ns(),
            region_m: simulation.traversal().region_m(),
            truth: TRUTH.to_owned(),
            table: TABLE.to_owned(),
            path_m: 0.0,
            last: None,
            frames: 0,
            images: [0; 2],
            pairs: 0,
            stamps_ns: (0, 0),
            sun: Box::new(move |time_s| {
                let sun = sun_position(site.place(), day, (start_s + time_s) / 3600.0);
                (sun.elevation_deg, sun.azimuth_deg)
            }),
        }
    }

    /// Notes a frame.
    pub fn note(&mut self, frame: &Frame) {
        let pose = frame.world_from_left;
        let ([x, y, z], [qx, qy, qz, qw]) = (pose.translation_m, pose.quaternion_xyzw());
        let (x, y) = (x + self.region_m[0], y + self.region_m[1]);
        let ([stamp_ns, right_stamp_ns], true_ns) = (frame.stamps_ns, frame.true_ns);
        let (seconds, rest) = (stamp_ns / 1_000_000_000, stamp_ns % 1_000_000_000);
        let (elevation, azimuth) = (self.sun)((true_ns - self.start_ns) as f64 / 1e9);
        let [left, right] = [&frame.left, &frame.right].map(|image| u64::from(image.is_some()));
        let Exposure { time_s, gain } = frame.exposure;
        let (index, motion_px) = (frame.index, frame.motion_px);
        // Writing to a string cannot fail.
        let _ = writeln!(self.truth, "{seconds}.{rest:09} {x:.9} {y:.9} {z:.9} {qx:.9} {qy:.9} {qz:.9} {qw:.9}");
        let _ = writeln!(
            self.table,
            "{index},{stamp_ns},{elevation:.4},{azimuth:.4},{time_s:.7},{gain:.4},{true_ns},{right_stamp_ns},{left},\
             {right},{motion_px:.2}"
        );
        self.path_m += self.last.map_or(0.0, |last| last.inverse().compose(&pose).distance_m());
        self.stamps_ns = (if self.frames == 0 { stamp_ns } else { self.stamps_ns.0 }, stamp_ns);
        self.last = Some(pose);
        self.frames += 1;
        self.pairs += left & right;
        self.images = [self.images[0] + left, self.images[1] + right];
    }

    /// Frames noted.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Those of them of which both images were recorded.
    pub fn pairs(&self) -> u64 {
        self.pairs
    }

    /// Length of the path in metres.
    pub fn length_m(&self) -> f64 {
        self.path_m
    }

    /// First and last stamp of a left image, recorded or lost.
    pub fn stamps_ns(&self) -> (i64, i64) {
        self.stamps_ns
    }

    /// Writes the files beside `output`; gives their names.
    pub fn write(&self, simulation: &Simulation, output: &Path) -> Result<Vec<PathBuf>, RecordError> {
        let traversal = simulation.traversal();
        let (rig, sun) = (simulation.rig(), traversal.sun());
        let result = json!({
            "world_seed": traversal.world_seed(), "start_ns": traversal.start_ns(), "path_m": self.path_m,
            "frames": self.frames, "pairs": self.pairs, "left_images": self.images[0], "right_images": self.images[1],
            "sun": {"elevation_deg": sun.elevation_deg, "azimuth_deg": sun.azimuth_deg},
            "rig": rig, "calibrations": simulation.calibrations(),
            "axes": {
                "camera": "x right, y down, z forward", "world": "x east, y north, z up", "pixel_centre": "integer",
            },
        });
        let mut about = traversal.description();
        if let (Some(about), Value::Object(result)) = (about.as_object_mut(), result) {
            about.extend(result);
        }
        let files = [
            ("groundtruth.tum", self.truth.clone()),
            ("frames.csv", self.table.clone()),
            ("pass.json", format!("{about:#}\n")),
        ];
        let mut written = Vec::new();
        for (ending, text) in files {
            let path = output.with_extension(ending);
            let mut file = FreshFile::create(&path)?;
            file.write_all(text.as_bytes()).map_err(|source| RecordError::Write { path: path.clone(), source })?;
            file.publish()?;
            written.push(path);
        }
        Ok(written)
    }
}
