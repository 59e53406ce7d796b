//! What is known of an outing, line by line.

use crate::browse::BrowseError;
use crate::browse::store::Store;
use crate::wording;
use furrow_catalog::records::{self, TraversalRecord};
use furrow_catalog::{Cameras, ViewsRecord};
use furrow_model::CameraCalibration;
use serde::Serialize;

/// A line of facts; `doubtful` where someone should look.
#[derive(Serialize)]
pub(crate) struct Fact {
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

fn counted(name: &str, count: u32, doubtful: bool) -> Fact {
    Fact { doubtful: doubtful && count > 0, ..fact(name, wording::count(count)) }
}

/// Bytes as people read them.
pub(crate) fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["bytes", "kB", "MB", "GB", "TB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        (value, unit) = (value / 1000.0, unit + 1);
    }
    if unit == 0 { format!("{count} bytes") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// What was driven, and with which cameras; `seconds` from the first frame to the last.
pub(crate) fn facts(record: &TraversalRecord, seconds: Option<f64>) -> Vec<Fact> {
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
    facts.push(fact("Steps from", record.odometry.as_str()));
    facts
}

/// What ingest found, as far as it was recorded.
pub(crate) fn health(store: &Store, record: &TraversalRecord) -> Result<Vec<Fact>, BrowseError> {
    let counts = &record.counts;
    let unpaired = record.unpaired.len() as u32;
    let views: ViewsRecord = records::read(store.objects(), record.calibration)?;
    let (calibration, assumed) = match &views.calibration {
        Cameras::Pair(pair) => (
            match pair.stream_is_rectified {
                true => "the recording's images are rectified already".to_owned(),
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
        counted("Frames that the camera dropped", counts.dropped, true),
        counted("Frames without a partner", unpaired, true),
        counted("Messages out of order", counts.out_of_order, true),
        counted("Steps where odometry failed", counts.failed_steps, true),
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
    let flat = camera.coefficients.iter().all(|coefficient| *coefficient == 0.0);
    let model = match camera.distortion {
        furrow_model::Distortion::RadialTangential => "radial and tangential distortion",
        furrow_model::Distortion::Equidistant => "equidistant fisheye",
    };
    let bent =
        if flat { "no distortion".to_owned() } else { format!("{model}, {} coefficients", camera.coefficients.len()) };
    format!("{} x {} pixels, {bent}", camera.width, camera.height)
}

/// The stored objects that it consists of.
pub(crate) fn objects(record: &TraversalRecord) -> Vec<Fact> {
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

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn sizes_read_as_written_by_hand() {
        assert_eq!([bytes(999), bytes(1000), bytes(201_472_478)], ["999 bytes", "1.0 kB", "201.5 MB"]);
    }
}
