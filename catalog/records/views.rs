//! The cameras of a traversal: all that turns its stored images into rectified ones.

use super::record::Record;
use crate::images::{BayerPattern, SingleCamera, StereoCalibration};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

/// What turns the stored images of one camera pair, or of a single camera, into rectified ones.
///
/// The calibration's keys tell a pair from a single camera; single cameras came later, and nothing else says which it
/// is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewsRecord {
    /// The cameras.
    pub calibration: Cameras,
    /// The mosaic of the stored left images, where they are one.
    pub left_bayer: Option<BayerPattern>,
    /// The mosaic of the stored right images, where they are one.
    pub right_bayer: Option<BayerPattern>,
}

impl Record for ViewsRecord {
    const KIND: &'static str = "views";
    const VERSION: u32 = 1;
}

/// What took the images.
#[derive(Debug, Clone, PartialEq)]
pub enum Cameras {
    /// Two cameras side by side: the keys `left`, `right` and so on.
    Pair(Box<StereoCalibration>),
    /// One camera: the keys `camera` and `is_assumed`.
    Single(Box<SingleCamera>),
}

impl Serialize for Cameras {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Cameras::Pair(pair) => pair.serialize(serializer),
            Cameras::Single(single) => single.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Cameras {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let calibration = Value::deserialize(deserializer)?;
        let has = |key: &str| calibration.get(key).is_some();
        match (has("left") || has("right"), has("camera")) {
            (true, false) => serde_json::from_value(calibration).map(Cameras::Pair).map_err(D::Error::custom),
            (false, true) => serde_json::from_value(calibration).map(Cameras::Single).map_err(D::Error::custom),
            _ => {
                Err(D::Error::custom("expected the calibration of a pair (left, right) or of a single camera (camera)"))
            }
        }
    }
}
