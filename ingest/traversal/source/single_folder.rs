//! A folder of a single camera's images as a source.

use super::first_images::depth_note;
use super::image_source::{ImageSource, Item};
use crate::folder::{ImageFile, SingleFolder};
use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use furrow_catalog::images::{Depth, Side};
use furrow_catalog::records::{Cameras, ViewsRecord};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// An opened folder of a single camera's images. They count as left ones.
pub(super) struct SingleFolderSource {
    path: PathBuf,
    folder: SingleFolder,
}

impl SingleFolderSource {
    /// Opens the folder `path`. A field of view stands in for a calibration that is not there.
    pub(super) fn open(path: PathBuf, request: &IngestRequest) -> Result<Self, IngestError> {
        Ok(Self { folder: SingleFolder::open(&path, request.field_of_view_deg, &request.calibration)?, path })
    }
}

impl ImageSource for SingleFolderSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn left_name(&self) -> String {
        "image folder".to_owned()
    }

    fn right_name(&self) -> Option<String> {
        None
    }

    fn file_of(&self, _side: Side, stamp_ns: i64) -> PathBuf {
        let image = self.folder.images.iter().find(|image| image.stamp_ns == stamp_ns);
        image.map_or(&self.path, |image| &image.path).clone()
    }

    fn depth(&self) -> Depth {
        self.folder.depth
    }

    fn calibrate(&self, _request: &IngestRequest, notes: &Notes) -> Result<ViewsRecord, IngestError> {
        depth_note(self.folder.depth).into_iter().for_each(|note| notes.add(note));
        let camera = Box::new(self.folder.camera.clone());
        Ok(ViewsRecord { calibration: Cameras::Single(camera), left_bayer: None, right_bayer: None })
    }

    fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError> {
        for (i, ImageFile { stamp_ns, path }) in self.folder.images.iter().enumerate() {
            let picture = Picture::Compressed(fs::read(path).map_err(IngestError::file(path))?);
            let (side, stamp_ns) = (Side::Left, *stamp_ns);
            if each(Item::Image { side, pair_ns: stamp_ns, stamp_ns, receive_ns: None, picture })?.is_break() {
                return Ok(());
            }
            progress(i as u64 + 1, self.folder.images.len() as u64);
        }
        Ok(())
    }
}
