//! What every source of images can do.

use crate::traversal::error::IngestError;
use crate::traversal::lost::LostImage;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use crate::traversal::sensors::SensorRow;
use furrow_catalog::images::{Depth, Side};
use furrow_catalog::records::ViewsRecord;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// What a source hands out, in the order of the recording.
pub(crate) enum Item {
    /// An image.
    Image {
        side: Side,
        /// The stamp by which it is paired: its own, or that of the partner which its folder found for it.
        pair_ns: i64,
        /// Its own stamp.
        stamp_ns: i64,
        /// When the recorder received it; `None` where nobody wrote that down.
        receive_ns: Option<i64>,
        picture: Picture,
    },
    /// An image without a stamp that can be read.
    Lost(LostImage),
    /// Another sensor's message.
    Sensor { topic: String, row: SensorRow },
}

/// An opened recording or folder.
pub(crate) trait ImageSource: Sync {
    /// What errors call it: the first of its files, or its folder.
    fn path(&self) -> &Path;

    /// The left images' topic or folder.
    fn left_name(&self) -> String;

    /// The right images' topic or folder; `None` for a single camera.
    fn right_name(&self) -> Option<String>;

    /// The file that an image lies in: the recording, or the folder's own file.
    fn file_of(&self, side: Side, stamp_ns: i64) -> PathBuf;

    /// How many bits of 16-bit pixels it uses: all its images are scaled alike.
    fn depth(&self) -> Depth {
        Depth::FULL
    }

    /// Whether one recorder received both sides, so that their receive times are of one clock.
    fn has_one_recorder(&self) -> bool {
        false
    }

    /// How its images become rectified views: by the request's calibration files, else by its own calibration. What is
    /// unusual about that is noted.
    fn calibrate(&self, request: &IngestRequest, notes: &Notes) -> Result<ViewsRecord, IngestError>;

    /// Hands every item to `each`, in order, until it breaks off. `progress` gets what is done and what there is in
    /// all.
    fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError>;
}
