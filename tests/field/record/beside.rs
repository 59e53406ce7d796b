//! The files beside a recording: ground truth, sun and exposure per frame, and the pass that was driven.

use super::RecordError;
use super::fresh::FreshFile;
use crate::simulate::{Frame, Outing};
use crate::sun::sun_position;
use furrow_model::Se3;
use serde_json::json;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// What is noted during a pass.
pub struct Beside {
    start_ns: i64,
    region_m: [f64; 2],
    truth: String,
    table: String,
    path_m: f64,
    last: Option<Se3>,
    frames: u64,
    stamps_ns: (i64, i64),
    sun: Box<dyn Fn(f64) -> (f64, f64)>,
}

impl Beside {
    /// Nothing noted yet of `outing`.
    pub fn of(outing: &Outing) -> Beside {
        let (site, day, start_s) = (outing.pass().site, outing.pass().date.day_of_year(), outing.pass().start_s());
        Beside {
            start_ns: outing.pass().start_ns(),
            region_m: outing.pass().region_m(),
            truth: "# timestamp tx ty tz qx qy qz qw (world from left camera; camera x right, y down, z forward; world x east, y north, z up; metres)\n"
                .to_owned(),
            table: "index,stamp_ns,sun_elevation_deg,sun_azimuth_deg,exposure_s,gain\n".to_owned(),
            path_m: 0.0,
            last: None,
            frames: 0,
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
        let (seconds, rest) = (frame.stamp_ns / 1_000_000_000, frame.stamp_ns % 1_000_000_000);
        let (elevation, azimuth) = (self.sun)((frame.stamp_ns - self.start_ns) as f64 / 1e9);
        // Writing to a string cannot fail.
        let _ = writeln!(self.truth, "{seconds}.{rest:09} {x:.9} {y:.9} {z:.9} {qx:.9} {qy:.9} {qz:.9} {qw:.9}");
        let (index, stamp_ns) = (frame.index, frame.stamp_ns);
        let _ = writeln!(
            self.table,
            "{index},{stamp_ns},{elevation:.4},{azimuth:.4},{:.7},{:.4}",
            frame.exposure.time_s, frame.exposure.gain
        );
        self.path_m += self.last.map_or(0.0, |last| last.inverse().compose(&pose).distance_m());
        self.stamps_ns = (if self.frames == 0 { frame.stamp_ns } else { self.stamps_ns.0 }, frame.stamp_ns);
        self.last = Some(pose);
        self.frames += 1;
    }

    /// Frames noted.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Length of the path in metres.
    pub fn length_m(&self) -> f64 {
        self.path_m
    }

    /// First and last stamp.
    pub fn stamps_ns(&self) -> (i64, i64) {
        self.stamps_ns
    }

    /// Writes the files beside `output`; gives their names.
    pub fn write(&self, outing: &Outing, output: &Path) -> Result<Vec<PathBuf>, RecordError> {
        let pass = outing.pass();
        let (rig, sun) = (outing.rig(), pass.sun());
        let about = json!({
            "kind": "furrow simulated pass", "version": 1,
            "site": pass.site.to_string(), "route": pass.route, "slot": pass.slot, "date": pass.date.to_string(),
            "weather": pass.weather.to_string(), "seed": pass.seed, "number": pass.number, "world_seed": pass.world_seed(),
            "start_ns": pass.start_ns(), "pairs": self.frames, "path_m": self.path_m,
            "sun": {"elevation_deg": sun.elevation_deg, "azimuth_deg": sun.azimuth_deg},
            "rig": rig,
            "axes": {"camera": "x right, y down, z forward", "world": "x east, y north, z up", "pixel_centre": "integer"},
        });
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
