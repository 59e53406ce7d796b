//! What the commands share that bring a recording into the store: their options, the progress bar, the summary.

use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::progress::Bar;
use furrow_catalog::Catalog;
use furrow_ingest::traversal::{
    FrameSelection, Imported, IngestRequest, IngestStage, IngestSummary, MotionSource, ingest,
};
use furrow_model::{Purpose, TimeSlot, shown};
use std::path::PathBuf;
use std::time::Instant;

/// The options of an ingest.
#[derive(Debug, clap::Args)]
pub struct IngestOptions {
    /// The site where it was recorded.
    #[arg(long)]
    site: String,
    /// The route of the site.
    #[arg(long)]
    route: String,
    /// The time slot: a time of day, in the site's local time.
    #[arg(long, value_name = "HH:MM")]
    slot: TimeSlot,
    /// What the traversal is for: to localise against, to be localised, or to train the vocabulary on.
    #[arg(long, visible_alias = "pass", value_name = "experience|evaluation|vocabulary")]
    purpose: Purpose,
    /// The topic of the left images. [default: found by type and name]
    #[arg(long, requires = "right", value_name = "TOPIC")]
    left: Option<String>,
    /// The topic of the right images. [default: found by type and name]
    #[arg(long, requires = "left", value_name = "TOPIC")]
    right: Option<String>,
    /// The topic of the left camera's CameraInfo. [default: found by the images' name]
    #[arg(long, value_name = "TOPIC")]
    left_info: Option<String>,
    /// The topic of the right camera's CameraInfo. [default: found by the images' name]
    #[arg(long, value_name = "TOPIC")]
    right_info: Option<String>,
    /// Which stereo pairs to use, or images of a single camera, counted from 0.
    #[arg(long, default_value = "all", value_name = "all|even|odd|A..B")]
    frames: FrameSelection,
    /// Run no odometry: the images are so many metres apart on a straight line. For pictures taken along a path.
    #[arg(long, value_name = "METRES", value_parser = parse_metres, conflicts_with = "poses")]
    spacing_m: Option<f64>,
    /// Run no odometry: take the camera poses from a file in TUM or KITTI form.
    #[arg(long, value_name = "FILE")]
    poses: Option<PathBuf>,
    /// Assume this horizontal field of view for a single camera; the calibration is stored as assumed.
    /// [default: the calibration file's, else 60]
    #[arg(long, value_name = "DEGREES", value_parser = parse_field_of_view)]
    field_of_view: Option<f64>,
    /// Use this calibration, scaled to the images: YAML of ROS, OpenCV or EuRoC (left, then right), Kalibr's camchain,
    /// or KITTI's text; one camera's for a single camera. [default: the recording's]
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    calibration: Vec<PathBuf>,
    /// True poses in TUM form. [default: the recording's name with .groundtruth.tum, if there is such a file]
    #[arg(long, value_name = "FILE")]
    ground_truth: Option<PathBuf>,
    /// Do not keep the recording's own bytes: half the disk space. `furrow reproduce` then cannot start from them.
    #[arg(long)]
    no_recording: bool,
    /// Refuse a recording with an unreadable image. [default: the image costs its frame, is counted and named]
    #[arg(long)]
    strict: bool,
    /// The files are parts of one recording although they do not follow each other in time, or their cameras differ.
    #[arg(long)]
    parts: bool,
    /// Enter the recording although odometry failed on most steps, or its cameras seem to be exchanged.
    #[arg(long)]
    accept_failed_odometry: bool,
}

impl IngestOptions {
    /// Refuses empty names.
    pub fn check(&self) -> Result<(), Failure> {
        for (what, name) in [("site", &self.site), ("route", &self.route)] {
            if name.trim().is_empty() {
                return Err(Failure::usage(format!("--{what} is empty: give the {what} a name")));
            }
        }
        Ok(())
    }

    /// The request to ingest `files`.
    pub fn request(self, files: Vec<PathBuf>) -> IngestRequest {
        IngestRequest {
            files,
            site: self.site,
            route: self.route,
            slot: self.slot,
            purpose: self.purpose,
            selection: self.frames,
            left: self.left,
            right: self.right,
            calibration: self.calibration,
            ground_truth: self.ground_truth,
            motion: match (self.spacing_m, self.poses) {
                (Some(metres), _) => MotionSource::Spacing(metres),
                (None, Some(file)) => MotionSource::Poses(file),
                (None, None) => MotionSource::Odometry,
            },
            field_of_view_deg: self.field_of_view,
            keep_recording: !self.no_recording,
            left_info: self.left_info,
            right_info: self.right_info,
            strict: self.strict,
            insist_on_parts: self.parts,
            accept_failed_odometry: self.accept_failed_odometry,
            imported: Imported::default(),
        }
    }
}

/// Ingests with a progress bar and prints what became of it. Frames that are known already, but not as asked, end with
/// exit code 3.
pub fn ingest_and_print(catalog: &Catalog, request: &IngestRequest, context: &Context) -> Result<Ending, Failure> {
    let summary = ingest_with_bar(catalog, request)?;
    if context.json {
        print_json(&summary)?;
    } else {
        print(&summary_text(&summary))?;
    }
    Ok(Ending::with_faults_if(!summary.differs.is_empty()))
}

fn ingest_with_bar(catalog: &Catalog, request: &IngestRequest) -> Result<IngestSummary, Failure> {
    let bar = Bar::bytes();
    let began = Instant::now();
    let summary = ingest(catalog, request, &mut |progress| {
        let stage = match progress.stage {
            IngestStage::Digest => "reading",
            IngestStage::Frames => "odometry",
        };
        bar.show(stage, progress.bytes, progress.bytes_total);
        if progress.frames > 0 {
            let rate = progress.frames as f64 / began.elapsed().as_secs_f64();
            bar.note(format!("{stage} {} frames, {rate:.1} frames/s", progress.frames));
        }
    });
    bar.finish();
    Ok(summary?)
}

/// Reads a distance between images.
fn parse_metres(text: &str) -> Result<f64, String> {
    let metres = text.parse::<f64>().ok().filter(|metres| *metres > 0.0 && metres.is_finite());
    metres.ok_or_else(|| "expected a number of metres greater than 0, as in 5 or 0.4".to_owned())
}

/// Reads an angle that a camera can see.
fn parse_field_of_view(text: &str) -> Result<f64, String> {
    let degrees = text.parse::<f64>().ok().filter(|degrees| *degrees > 0.0 && *degrees < 180.0);
    degrees.ok_or_else(|| "expected an angle in degrees between 0 and 180, as in 60".to_owned())
}

fn summary_text(summary: &IngestSummary) -> String {
    let mut text = String::new();
    let mut line = |said: String| {
        text.push_str(&said);
        text.push('\n');
    };
    line(format!(
        "{} {}",
        if summary.known { "known already: traversal" } else { "ingested: traversal" },
        summary.traversal.short()
    ));
    if summary.known {
        line(format!("  its label is {}", summary.label));
        line(format!("  it came as {}; what follows is of that ingest", shown(&summary.recording_name)));
    }
    for difference in &summary.differs {
        line(format!("  it is not as asked: {difference}"));
    }
    let chain = &summary.trajectory;
    line(format!(
        "  {} {}, {} on the chain of {:.1} m, {} keyframes",
        summary.pairs,
        if summary.camera == "stereo" { "stereo pairs" } else { "images of a single camera" },
        chain.frames,
        chain.length_m,
        summary.keyframes
    ));
    if summary.motion.starts_with("given") {
        line(format!("  no odometry was run: {}", summary.motion));
    }
    if summary.calibration_assumed {
        line("  the calibration is assumed, from a field of view".to_owned());
    }
    if chain.failed_steps > 0 {
        line(format!("  odometry failed on {} steps: each repeats the motion before it", chain.failed_steps));
    }
    for frame in &summary.unpaired {
        line(format!("  the {} frame stamped {} ns has no partner", frame.side, frame.stamp_ns));
    }
    if summary.dropped > 0 {
        line(format!("  {} frames were dropped, judged by gaps in the stamps", summary.dropped));
    }
    for note in &summary.notes {
        line(format!("  {}: {note}", if summary.known { "noted then" } else { "note" }));
    }
    if let Some(experience) = summary.experience {
        line(format!("  experience {}", experience.short()));
    }
    text
}
