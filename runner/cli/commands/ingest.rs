use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::ingesting::{IngestOptions, ingest_and_print};
use std::path::PathBuf;

/// Ingest a recording: check it, pair and rectify its images, run odometry, and store traversal and experience.
///
/// Reads ROS1 .bag, MCAP, ROS2 .db3, rosbag2 folders and image folders. An image folder has left and right images with
/// calib.txt or calibration.json, or the images of a single camera with --spacing-m or --poses. All of a recording
/// enters the store or nothing; the same recording again adds nothing.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --purpose experience\n  \
furrow ingest row7.bag --site backsburg --route row7 --slot 08:00 --purpose evaluation --frames odd --json\n  \
furrow ingest autumn/ --site park --route loop --slot 12:00 --purpose experience --spacing-m 5\n  \
furrow ingest lane/ --site orchard --route lane --slot 08:00 --purpose experience --poses lane/groundtruth.tum")]
pub struct Ingest {
    /// The recording; several files are the parts of one split recording.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    options: IngestOptions,
}

impl Ingest {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        self.options.check()?;
        ingest_and_print(&catalog, &self.options.request(self.files), context)
    }
}
