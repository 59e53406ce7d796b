//! A folder of stereo pairs as a source.

use super::first_images::depth_note;
use super::image_source::{ImageSource, Item};
use crate::folder::{PairFiles, StereoFolder};
use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use furrow_catalog::images::{Depth, Side};
use furrow_catalog::records::{Cameras, ViewsRecord};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// An opened folder of stereo pairs.
pub(super) struct StereoFolderSource {
    path: PathBuf,
    folder: StereoFolder,
}

impl StereoFolderSource {
    /// Opens the folder `path`.
    pub(super) fn open(path: PathBuf, request: &IngestRequest) -> Result<Self, IngestError> {
        Ok(Self { folder: StereoFolder::open(&path, &request.calibration)?, path })
    }
}

impl ImageSource for StereoFolderSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn left_name(&self) -> String {
        "image folder, left".to_owned()
    }

    fn right_name(&self) -> Option<String> {
        Some("image folder, right".to_owned())
    }

    fn file_of(&self, side: Side, stamp_ns: i64) -> PathBuf {
        let own_stamp_ns = |pair: &PairFiles| if side == Side::Left { pair.stamp_ns } else { pair.right_stamp_ns };
        let pair = self.folder.pairs.iter().find(|pair| own_stamp_ns(pair) == stamp_ns);
        let file = pair.map(|pair| if side == Side::Left { &pair.left } else { &pair.right });
        file.unwrap_or(&self.path).clone()
    }

    fn depth(&self) -> Depth {
        self.folder.depth
    }

    fn calibrate(&self, _request: &IngestRequest, notes: &Notes) -> Result<ViewsRecord, IngestError> {
        depth_note(self.folder.depth).into_iter().for_each(|note| notes.add(note));
        let calibration = self.folder.calibration.clone();
        Ok(ViewsRecord { calibration: Cameras::Pair(Box::new(calibration)), left_bayer: None, right_bayer: None })
    }

    /// Pairs first, then the images without a partner.
    fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError> {
        let total = self.folder.pairs.len() as u64;
        let mut hand_over = |side, pair_ns, stamp_ns, path: &Path| {
            let bytes = fs::read(path).map_err(IngestError::file(path))?;
            each(Item::Image { side, pair_ns, stamp_ns, receive_ns: None, picture: Picture::Compressed(bytes) })
        };
        for (i, pair) in self.folder.pairs.iter().enumerate() {
            let right = (Side::Right, pair.right_stamp_ns, &pair.right);
            for (side, stamp_ns, path) in [(Side::Left, pair.stamp_ns, &pair.left), right] {
                if hand_over(side, pair.stamp_ns, stamp_ns, path)?.is_break() {
                    return Ok(());
                }
            }
            progress(i as u64 + 1, total);
        }
        for unpaired in &self.folder.unpaired {
            if hand_over(unpaired.side, unpaired.stamp_ns, unpaired.stamp_ns, &unpaired.path)?.is_break() {
                return Ok(());
            }
        }
        Ok(())
    }
}
