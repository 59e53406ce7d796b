//! Which images of a recording could not be read.

use super::record::Record;
use serde::{Deserialize, Serialize};

/// Images that could not be read, in order of their stamps; each cost its frame. Kept beside a traversal and no part of
/// its id. None is stored where all could be read.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnreadableRecord {
    /// The images.
    pub images: Vec<UnreadableImage>,
}

/// An image that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnreadableImage {
    /// Its header stamp; when it was received, where its message has no header that can be read. Nanoseconds.
    pub stamp_ns: i64,
    /// `left` or `right`; a single camera's are left ones.
    pub side: String,
    /// What is wrong with it.
    pub fault: String,
}

impl Record for UnreadableRecord {
    const KIND: &'static str = "unreadable-images";
    const VERSION: u32 = 1;
}
