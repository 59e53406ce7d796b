//! What was asked of an ingest, as far as the traversal's record does not say it.

use super::record::Record;
use furrow_model::ObjectId;
use serde::{Deserialize, Serialize};

/// The options of an ingest that are needed to repeat it. None is stored where none was given.
///
/// Version 1 had no topics of CameraInfo.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RequestRecord {
    /// The topic or folder of the left images.
    pub left: Option<String>,
    /// The topic or folder of the right images.
    pub right: Option<String>,
    /// The topic of the left camera's CameraInfo.
    pub left_info: Option<String>,
    /// The topic of the right camera's CameraInfo.
    pub right_info: Option<String>,
    /// Calibration files: name and bytes.
    pub calibration: Vec<(String, ObjectId)>,
    /// The file of given poses: name and bytes.
    pub poses: Option<(String, ObjectId)>,
    /// The given distance between images, in metres.
    pub spacing_m: Option<f64>,
    /// The given field of view of a camera without calibration, in degrees.
    pub field_of_view_deg: Option<f64>,
}

impl Record for RequestRecord {
    const KIND: &'static str = "asked";
    const VERSION: u32 = 2;
}
