use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_ingest::outing::{FrameSelection, IngestRequest, IngestSummary, MotionSource, ingest};
use furrow_model::{Purpose, TimeSlot};
use std::path::PathBuf;
use std::time::Instant;

/// Take a recording into the store: check, pair, rectify, run odometry, keep the experience.
///
/// Reads ROS1 .bag, MCAP, ROS2 .db3, rosbag2 folders and image folders: left and right images with calib.txt or calibration.json, or the
/// images of a single camera, which need --spacing-m or --poses. All of it enters the store or nothing; the same recording again adds nothing.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --pass experience\n  \
furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --pass evaluation --frames odd --json\n  \
furrow ingest autumn/ --site park --route loop --slot 12:00 --pass experience --spacing-m 5\n  \
furrow ingest lane/ --site orchard --route lane --slot 08:00 --pass experience --poses lane/groundtruth.tum"
)]
pub struct Ingest {
    /// The recording; several files are the parts of one split recording.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Where it was driven.
    #[arg(long)]
    site: String,
    /// Along which route.
    #[arg(long)]
    route: String,
    /// The time of day it stands for, HH:MM in local time.
    #[arg(long)]
    slot: TimeSlot,
    /// What it is for.
    #[arg(long = "pass", value_name = "experience|evaluation|vocabulary")]
    purpose: Purpose,
    /// The left images' topic, where it is not plain.
    #[arg(long, requires = "right", value_name = "TOPIC")]
    left: Option<String>,
    /// The right images' topic.
    #[arg(long, requires = "left", value_name = "TOPIC")]
    right: Option<String>,
    /// Which of its stereo pairs, or of a single camera's images, counted from 0.
    #[arg(long, default_value = "all", value_name = "all|even|odd|A..B")]
    frames: FrameSelection,
    /// Images are so many metres apart, straight on: no odometry is run. For pictures taken along a path.
    #[arg(long, value_name = "METRES", value_parser = metres, conflicts_with = "poses")]
    spacing_m: Option<f64>,
    /// Camera poses in TUM or KITTI form: no odometry is run.
    #[arg(long, value_name = "FILE")]
    poses: Option<PathBuf>,
    /// The horizontal field of view to assume of a single camera without a calibration file; recorded as assumed. 60 where left out.
    #[arg(long, value_name = "DEGREES", value_parser = field_of_view)]
    field_of_view: Option<f64>,
    /// A calibration to use instead of the recording's: a KITTI calib_cam_to_cam.txt, or ROS camera_info YAML (left, then right).
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    calibration: Vec<PathBuf>,
    /// True poses in TUM form; found by itself as FILE's name with .groundtruth.tum.
    #[arg(long, value_name = "FILE")]
    ground_truth: Option<PathBuf>,
    /// Keep images, chain and sensors, but not the recording's own bytes: half the disk. `reproduce` then cannot begin at the recording.
    #[arg(long)]
    no_recording: bool,
}

impl Ingest {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        for (what, name) in [("site", &self.site), ("route", &self.route)] {
            if name.trim().is_empty() {
                return Err(Failure::usage(format!("--{what} is empty: give the {what} a name")));
            }
        }
        let request = IngestRequest {
            files: self.files,
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
        };
        let bar = Bar::bytes();
        let began = Instant::now();
        let summary = ingest(&catalog, &request, &mut |progress| {
            bar.show(progress.stage, progress.bytes, progress.bytes_total);
            if progress.frames > 0 {
                let rate = progress.frames as f64 / began.elapsed().as_secs_f64();
                bar.note(format!("{} {} frames, {rate:.1} frames/s", progress.stage, progress.frames));
            }
        });
        bar.finish();
        let summary = summary?;
        if context.json {
            print_json(&summary)?;
        } else {
            print(&for_people(&summary))?;
        }
        Ok(Ending::Done)
    }
}

/// A distance between images.
fn metres(text: &str) -> Result<f64, String> {
    let metres = text.parse::<f64>().ok().filter(|metres| *metres > 0.0 && metres.is_finite());
    metres.ok_or_else(|| "expected a number of metres greater than 0, as in 5 or 0.4".to_owned())
}

/// An angle that a camera without mirrors may see.
fn field_of_view(text: &str) -> Result<f64, String> {
    let degrees = text.parse::<f64>().ok().filter(|degrees| *degrees > 0.0 && *degrees < 180.0);
    degrees.ok_or_else(|| "expected an angle in degrees between 0 and 180, as in 60".to_owned())
}

fn for_people(summary: &IngestSummary) -> String {
    let mut text = String::new();
    let mut line = |words: String| {
        text.push_str(&words);
        text.push('\n');
    };
    line(format!(
        "{} {}",
        if summary.known { "known already: traversal" } else { "ingested: traversal" },
        summary.traversal.short()
    ));
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
        line("  the camera's calibration is assumed, from a field of view".to_owned());
    }
    if chain.failed_steps > 0 {
        line(format!("  odometry failed on {} steps, which repeat the motion before", chain.failed_steps));
    }
    for frame in &summary.unpaired {
        line(format!("  the {} frame stamped {} ns has no partner", frame.side, frame.stamp_ns));
    }
    if summary.dropped > 0 {
        line(format!("  gaps in the stamps tell of {} dropped frames", summary.dropped));
    }
    if let Some(experience) = summary.experience {
        line(format!("  experience {}", experience.short()));
    }
    text
}
