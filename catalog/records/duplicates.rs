//! How many images of a recording have the stamp of another.

use super::record::Record;
use serde::{Deserialize, Serialize};

/// Images whose stamp their side had already; the first of each was kept. Beside a traversal and no part of its id.
/// None is stored where there is no such image.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DuplicatesRecord {
    /// Of both sides together.
    pub images: u64,
}

impl Record for DuplicatesRecord {
    const KIND: &'static str = "duplicate-images";
    const VERSION: u32 = 1;
}
