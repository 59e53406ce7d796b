//! Which source a request names.

use super::image_source::ImageSource;
use super::imported::ImportedSource;
use super::recording::RecordingSource;
use super::single_folder::SingleFolderSource;
use super::stereo_folder::StereoFolderSource;
use crate::folder::holds_pairs;
use crate::traversal::error::IngestError;
use crate::traversal::folders::{bags_inside, holds_recording};
use crate::traversal::notes::Notes;
use crate::traversal::request::IngestRequest;
use std::sync::Arc;

/// Opens what a request names. A folder of rosbag2's files is a recording, any other a folder of images.
pub(crate) fn open_source(request: &IngestRequest, notes: &Notes) -> Result<Box<dyn ImageSource>, IngestError> {
    if let Some(layout) = &request.imported.layout {
        return Ok(Box::new(ImportedSource::new(Arc::clone(layout), notes)));
    }
    let path = request.files.first().cloned().unwrap_or_default();
    let is_image_folder = path.is_dir() && !holds_recording(&path);
    if is_image_folder && let Some(error) = bags_inside(&path) {
        return Err(error);
    }
    if is_image_folder && holds_pairs(&path)? {
        return Ok(Box::new(StereoFolderSource::open(path, request)?));
    }
    if is_image_folder {
        return Ok(Box::new(SingleFolderSource::open(path, request)?));
    }
    if request.field_of_view_deg.is_some() {
        return Err(IngestError::Request(
            "a field of view is assumed of a folder with a single camera's images only".to_owned(),
        ));
    }
    Ok(Box::new(RecordingSource::open(path, request, notes)?))
}
