//! The calibrated inlier threshold.

use crate::{CatalogError, Objects, to_json};
use furrow_model::ObjectId;
use serde::{Deserialize, Serialize};

/// The inliers that make a localisation good, with the counts it was calibrated from.
///
/// Stored as it stands, without kind and version: it is older than that rule, and found by its key alone, whose
/// algorithm has a version.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThresholdRecord {
    /// Least inliers of a good localisation.
    pub inliers: u32,
    /// `histogram[n]` = number of wrong pairs with n inliers; empty where there were none to calibrate from.
    pub histogram: Vec<u32>,
}

impl ThresholdRecord {
    /// Reads a threshold from the store.
    ///
    /// # Errors
    /// As [`Objects::read`]; [`CatalogError::WrongRecord`] where the object is none.
    pub fn read(objects: &Objects, id: ObjectId) -> Result<Self, CatalogError> {
        let wrong_record = |error: serde_json::Error| CatalogError::WrongRecord {
            id,
            expected: "threshold".to_owned(),
            found: error.to_string(),
        };
        serde_json::from_slice(&objects.read(id)?).map_err(wrong_record)
    }

    /// Stores the threshold.
    ///
    /// # Errors
    /// As [`Objects::write`].
    pub fn write(&self, objects: &Objects) -> Result<ObjectId, CatalogError> {
        objects.write(&to_json(self)?)
    }
}
