//! What is known of a traversal, line by line.

use super::error::BrowseError;
use super::store::Store;
use crate::wording;
use furrow_catalog::records::{self, TraversalRecord};
use furrow_catalog::records::{Cameras, ViewsRecord};
use furrow_model::CameraCalibration;
use serde::Serialize;

/// A line of facts; `doubtful` where a person should look.
#[derive(Serialize)]
pub(super) struct Fact {
    name: String,
    value: String,
    code: bool,
    doubtful: bool,
}

fn fact(name: &str, value: impl Into<String>) -> Fact {
    Fact { name: name.to_owned(), value: wording::shown(&value.into()), code: false, doubtful: false }
}

fn digest(name: &str, value: impl ToString) -> Fact {
    Fact { code: true, ..fact(name, value.to_string()) }
}

/// A count of faults.
fn faults(name: &str, count: u32) -> Fact {
    Fact { doubtful: count > 0, ..fact(name, wording::count(count)) }
}

/// Length, frames and cameras; `seconds` from the first frame to the last.
pub(super) fn facts(record: &TraversalRecord, seconds: Option<f64>) -> Vec<Fact> {
    let (counts, rig) = (&record.counts, &record.rig);
    let mut facts = vec![
        fact("Length", format!("{} m along the chain", wording::tenths(counts.length_m))),
        fact(
            "Frames",
            format!(
                "{} on the chain, of {} in the recording (selection: {})",
                counts.frames, counts.pairs, record.selection
            ),
        ),
    ];
    if let Some(seconds) = seconds {
        let rate = f64::from(counts.frames.saturating_sub(1)) / seconds.max(1e-9);
        facts.push(fact("Duration", format!("{seconds:.1} s, {rate:.1} frames a second")));
    }
    facts.push(fact(
        "Keyframes",
        format!("{}, every {} m or {} rad", counts.keyframes, record.keyframes.distance_m, record.keyframes.yaw_rad),
    ));
    facts.push(fact(
        "Rectified rig",
        format!(
            "{} x {} pixels, focal length {:.1} pixels, {}",
            rig.width,
            rig.height,
            rig.focal_px,
            match rig.is_pair() {
                true => format!("baseline {:.1} mm", 1000.0 * rig.baseline_m),
                false => "a single camera".to_owned(),
            }
        ),
    ));
    facts.push(fact("Left images", record.left_source.as_str()));
    facts.push(fact("Right images", record.right_source.as_deref().unwrap_or("none: a single camera")));
    facts.push(fact("Odometry", record.odometry.as_str()));
    facts
}

/// What ingest found, as far as it was recorded.
pub(super) fn health(store: &Store, record: &TraversalRecord) -> Result<Vec<Fact>, BrowseError> {
    let counts = &record.counts;
    let unpaired = record.unpaired.len() as u32;
    let views: ViewsRecord = records::read(store.objects(), record.calibration)?;
    let (calibration, assumed) = match &views.calibration {
        Cameras::Pair(pair) => (
            match pair.stream_is_rectified {
                true => "the images of the recording are already rectified".to_owned(),
                false => format!(
                    "undistorted and rectified by furrow: left {}; right {}",
                    lens(&pair.left),
                    lens(&pair.right)
                ),
            },
            false,
        ),
        Cameras::Single(single) => (lens(&single.camera), single.is_assumed),
    };
    let mut health = vec![
        faults("Frames dropped by the camera", counts.dropped),
        faults("Frames without a stereo partner", unpaired),
        faults("Messages out of order", counts.out_of_order),
        faults("Steps where odometry failed", counts.failed_steps),
        fact("Calibration", calibration),
    ];
    if assumed {
        health.push(Fact { doubtful: true, ..fact("Field of view", "assumed, not calibrated") });
    }
    health.push(fact(
        "Ground truth",
        if record.ground_truth.is_some() { "a file of true poses" } else { "no file of true poses" },
    ));
    for sensor in &record.sensors {
        health.push(fact("Other sensors", format!("{} ({}), {} rows", sensor.topic, sensor.kind, sensor.rows)));
    }
    Ok(health)
}

fn lens(camera: &CameraCalibration) -> String {
    let model = match camera.distortion {
        furrow_model::Distortion::RadialTangential => "radial and tangential distortion",
        furrow_model::Distortion::Equidistant => "equidistant fisheye",
    };
    let distortion = match camera.coefficients.iter().all(|coefficient| *coefficient == 0.0) {
        true => "no distortion".to_owned(),
        false => format!("{model}, {} coefficients", camera.coefficients.len()),
    };
    format!("{} x {} pixels, {distortion}", camera.width, camera.height)
}

/// The stored objects that it consists of.
pub(super) fn objects(record: &TraversalRecord) -> Vec<Fact> {
    let mut objects = vec![
        digest("Calibration", record.calibration),
        digest("Table of frames (Parquet)", record.frames),
        digest("Chain of steps (Parquet)", record.chain),
    ];
    objects.extend(record.ground_truth.map(|file| digest("True poses (TUM)", file)));
    for sensor in &record.sensors {
        objects.extend(sensor.parts.iter().map(|part| digest(&sensor.topic, part)));
    }
    objects
}
