//! An outing: player, what ingest found, and where its bytes come from.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::cards::{site_key, tones};
use crate::browse::map::{Canvas, Line, Map, dash};
use crate::browse::store::Store;
use crate::browse::track::Track;
use crate::wording;
use furrow_catalog::records::{self, TraversalRecord};
use furrow_catalog::{Cameras, Catalog, ViewsRecord};
use furrow_model::{CameraCalibration, Outcome, TraversalId};
use serde::Serialize;

/// Runs that are searched for answers to this pass, the latest first, and answers that are offered.
const RUNS: usize = 10;
const ANSWERS: usize = 40;
/// Frames without a partner that are named.
const NAMED: usize = 12;

#[derive(Serialize)]
struct View {
    id: String,
    short: String,
    site: String,
    site_key: String,
    route: String,
    slot: String,
    purpose: String,
    day: String,
    frames: usize,
    middle: usize,
    width: u32,
    height: u32,
    has_right: bool,
    map: Map,
    answers: Vec<AnswerLine>,
    facts: Vec<Fact>,
    health: Vec<Fact>,
    unpaired: Vec<String>,
    more_unpaired: usize,
    experience: Option<(String, String)>,
    recording: Option<RecordingView>,
    objects: Vec<Fact>,
}

/// A line of facts; `doubtful` where someone should look.
#[derive(Serialize)]
struct Fact {
    name: String,
    value: String,
    code: bool,
    doubtful: bool,
}

/// A run's cell that was asked about this pass.
#[derive(Serialize)]
struct AnswerLine {
    cell: String,
    label: String,
}

#[derive(Serialize)]
struct RecordingView {
    id: String,
    name: String,
    bytes: String,
    parts: Vec<(String, String, String)>,
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

pub(crate) fn page(store: &Store, typed: String) -> Result<Answer, BrowseError> {
    let catalog = store.catalog()?;
    let (id, record) = store.pass(&catalog, &typed)?;
    let frames = store.frames(&record)?;
    let first = frames.first().map(|frame| frame.stamp_ns);
    let recording = catalog.recording(record.recording)?.map(|row| RecordingView {
        id: row.id.to_string(),
        name: wording::shown(&row.name),
        bytes: bytes(row.bytes),
        parts: row
            .parts
            .iter()
            .map(|part| (wording::shown(&part.name), bytes(part.bytes), part.digest.to_string()))
            .collect(),
    });
    let names = record.unpaired.iter().take(NAMED);
    let view = View {
        id: id.to_string(),
        short: id.short(),
        site: wording::shown(&record.site),
        site_key: site_key(&record.site),
        route: wording::shown(&record.route),
        slot: record.slot.to_string(),
        purpose: record.purpose.to_string(),
        day: first.map_or("–".to_owned(), |stamp| store.insight.day(stamp, record.slot)),
        frames: frames.len(),
        middle: frames.len() / 2,
        width: record.rig.width,
        height: record.rig.height,
        has_right: frames.first().is_some_and(|frame| frame.right.is_some()),
        map: map(store, &catalog, &record)?,
        answers: answers(&catalog, id, &record)?,
        facts: facts(&record, frames.first().zip(frames.last()).map(|(a, b)| (b.stamp_ns - a.stamp_ns) as f64 * 1e-9)),
        health: health(store, &record)?,
        unpaired: names
            .map(|one| format!("{} ns: only the {} image", one.stamp_ns, wording::shown(&one.side)))
            .collect(),
        more_unpaired: record.unpaired.len().saturating_sub(NAMED),
        experience: record.experience.map(|id| (id.to_string(), id.short())),
        recording,
        objects: objects(&record),
    };
    store.render("outing.html", view)
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

fn map(store: &Store, catalog: &Catalog, record: &TraversalRecord) -> Result<Map, BrowseError> {
    let track = Track::of(store, record, None)?;
    let canvas = Canvas::around(track.points.iter().flatten());
    let line = Line {
        d: canvas.path(&track.points),
        tone: tones(&catalog.places()?).of(record.slot).class,
        dash: dash(record.purpose),
        start: track.points.iter().flatten().next().map(|point| canvas.at(*point)),
        outing: String::new(),
        title: format!("The track of this outing, {} metres", wording::tenths(record.counts.length_m)),
    };
    Ok(canvas.map("Track of this outing".to_owned(), track.caption(), track.is_true(), vec![line]))
}

/// Cells of the latest runs whose live pass this is.
fn answers(catalog: &Catalog, id: TraversalId, record: &TraversalRecord) -> Result<Vec<AnswerLine>, BrowseError> {
    let mut lines: Vec<AnswerLine> = Vec::new();
    for row in catalog.runs()?.iter().rev().take(RUNS) {
        let run = catalog.run(row.id)?;
        if !run.passes.is_empty() && !run.passes.contains(&id) {
            continue;
        }
        for cell in run.cells.iter().filter(|cell| cell.live == record.slot) {
            if lines.len() == ANSWERS {
                return Ok(lines);
            }
            let known = lines.iter().any(|line| line.cell == cell.key.to_string());
            let Some(outcome) = (if known { None } else { catalog.outcome(cell.key)? }) else { continue };
            if outcome.live_traversal == id {
                lines.push(AnswerLine {
                    cell: cell.key.to_string(),
                    label: label(&run.name, &outcome.named(&cell.experience), &cell.setting),
                });
            }
        }
    }
    Ok(lines)
}

fn label(run: &str, outcome: &Outcome, setting: &str) -> String {
    let setting = if setting.is_empty() { String::new() } else { format!(" [{}]", wording::shown(setting)) };
    let (run, against) = (wording::shown(run), wording::shown(&outcome.experience));
    format!("{run}: against {against}{setting}, {} of {} localised", outcome.evaluation.good, outcome.evaluation.frames)
}

fn facts(record: &TraversalRecord, seconds: Option<f64>) -> Vec<Fact> {
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
fn health(store: &Store, record: &TraversalRecord) -> Result<Vec<Fact>, BrowseError> {
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

fn objects(record: &TraversalRecord) -> Vec<Fact> {
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
