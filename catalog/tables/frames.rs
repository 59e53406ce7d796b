//! The table of a traversal's frames.

use super::columns::{i64s, object_ids};
use super::parquet::{from_parquet, to_parquet};
use crate::CatalogError;
use furrow_model::ObjectId;
use polars::prelude::df;

/// A moment as stored: a stereo pair, or the image of a single camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// The left header stamp; the frame's time.
    pub stamp_ns: i64,
    /// The left image as stored.
    pub left: ObjectId,
    /// The right image; `None` where a single camera recorded.
    pub right: Option<RightImage>,
}

/// The right image of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RightImage {
    /// Its header stamp.
    pub stamp_ns: i64,
    /// As stored.
    pub image: ObjectId,
}

/// The table of a traversal's frames; without the columns of right images where a single camera recorded. Frames of
/// both kinds do not mix.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn frames_to_parquet(frames: &[Frame]) -> Result<Vec<u8>, CatalogError> {
    let stamps: Vec<i64> = frames.iter().map(|f| f.stamp_ns).collect();
    let left: Vec<String> = frames.iter().map(|f| f.left.to_string()).collect();
    let rights: Option<Vec<RightImage>> = frames.iter().map(|f| f.right).collect();
    let table = match rights {
        None => df!("stamp_ns" => stamps, "left" => left),
        Some(rights) => df!(
            "stamp_ns" => stamps,
            "right_stamp_ns" => rights.iter().map(|right| right.stamp_ns).collect::<Vec<_>>(),
            "left" => left,
            "right" => rights.iter().map(|right| right.image.to_string()).collect::<Vec<_>>(),
        ),
    };
    to_parquet("frames", table.map_err(CatalogError::table("frames"))?)
}

/// A traversal's frames.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn frames_from_parquet(bytes: Vec<u8>) -> Result<Vec<Frame>, CatalogError> {
    let table = from_parquet("frames", bytes)?;
    let (stamps, left) = (i64s(&table, "stamp_ns")?, object_ids(&table, "left")?);
    let rights: Vec<Option<RightImage>> = if table.column("right").is_ok() {
        let (stamps, images) = (i64s(&table, "right_stamp_ns")?, object_ids(&table, "right")?);
        stamps.into_iter().zip(images).map(|(stamp_ns, image)| Some(RightImage { stamp_ns, image })).collect()
    } else {
        vec![None; table.height()]
    };
    let frames = stamps.into_iter().zip(left).zip(rights);
    Ok(frames.map(|((stamp_ns, left), right)| Frame { stamp_ns, left, right }).collect())
}
