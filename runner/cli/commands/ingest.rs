use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_ingest::outing::{FrameSelection, IngestRequest, IngestSummary, ingest};
use furrow_model::{Purpose, TimeSlot};
use std::path::PathBuf;
use std::time::Instant;

/// Take a recording into the store: check, pair, rectify, run odometry, keep the experience.
///
/// Reads ROS1 .bag, MCAP, ROS2 .db3, rosbag2 folders and image folders (calib.txt with left and right images). All of it enters the store or
/// nothing; the same recording again adds nothing.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --pass experience\n  \
furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --pass evaluation --frames odd --json"
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
    /// Which of its stereo pairs, counted from 0.
    #[arg(long, default_value = "all", value_name = "all|even|odd|A..B")]
    frames: FrameSelection,
    /// A calibration to use instead of the recording's: a KITTI calib_cam_to_cam.txt, or ROS camera_info YAML (left, then right).
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    calibration: Vec<PathBuf>,
    /// True poses in TUM form; found by itself as FILE's name with .groundtruth.tum.
    #[arg(long, value_name = "FILE")]
    ground_truth: Option<PathBuf>,
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
        "  {} stereo pairs, {} on the chain of {:.1} m, {} keyframes",
        summary.pairs, chain.frames, chain.length_m, summary.keyframes
    ));
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
