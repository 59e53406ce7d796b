//! Rectified views as JPEG, kept in memory.

use super::error::BrowseError;
use super::reply::Reply;
use super::store::{Store, ViewKey};
use furrow_catalog::images::{Picture, Side, encode_jpeg};
use furrow_model::ObjectId;

/// Columns of a thumbnail, and of an image that fills half a page.
const THUMB: usize = 320;
const FULL: usize = 960;
const QUALITY: u8 = 84;

fn view(
    store: &Store,
    (image, calibration): (ObjectId, ObjectId),
    side: Side,
    width: usize,
) -> Result<Reply, BrowseError> {
    let make = || -> Result<Vec<u8>, BrowseError> {
        let colour = store.views(calibration)?.colour_of(store.objects(), side, image)?;
        encode_jpeg(Picture::Colour(&colour), width, QUALITY).map_err(|source| BrowseError::Picture { image, source })
    };
    let key = ViewKey { image, calibration, right: side == Side::Right, width };
    Ok(Reply::jpeg(&store.pictures.get_or_make(key, make)?))
}

/// The left image in the middle of a traversal.
pub(super) fn thumb(store: &Store, id: String) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let middle = frames.get(frames.len() / 2).ok_or_else(|| BrowseError::not_here("frame of traversal", &id))?;
    view(store, (middle.left, record.calibration), Side::Left, THUMB)
}

/// A frame's image: `left.jpg` or `right.jpg`.
pub(super) fn frame(store: &Store, (id, number, side): (String, String, String)) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let unknown = || BrowseError::not_here("image", &format!("{side} of frame {number}"));
    let frame = number.parse::<usize>().ok().and_then(|number| frames.get(number)).ok_or_else(unknown)?;
    let (image, side) = match side.as_str() {
        "left.jpg" => (frame.left, Side::Left),
        "right.jpg" => (frame.right.ok_or_else(unknown)?.image, Side::Right),
        _ => return Err(unknown()),
    };
    view(store, (image, record.calibration), side, FULL)
}

/// A node's left image.
pub(super) fn node(store: &Store, (id, number): (String, String)) -> Result<Reply, BrowseError> {
    let (_, experience) = store.experience(&id)?;
    let node = number.parse::<usize>().ok().and_then(|number| experience.nodes.get(number));
    let node = node.ok_or_else(|| BrowseError::not_here("node", &number))?;
    view(store, (node.left, experience.calibration), Side::Left, FULL)
}
