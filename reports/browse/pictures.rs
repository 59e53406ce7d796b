//! Rectified views as JPEG, kept in memory.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::store::Store;
use furrow_catalog::images::{Picture, Side, encode_jpeg};
use furrow_model::ObjectId;
use std::sync::Arc;

/// Columns of a thumbnail and of a picture that fills half a page.
const THUMB: usize = 320;
const FULL: usize = 960;
const QUALITY: u8 = 84;

/// A view: stored image, calibration, whether it is the right camera's, and its width.
pub(crate) type Wanted = (ObjectId, ObjectId, bool, usize);

fn view(
    store: &Store,
    (image, calibration): (ObjectId, ObjectId),
    side: Side,
    width: usize,
) -> Result<Answer, BrowseError> {
    let make = || -> Result<Vec<u8>, BrowseError> {
        let colour = store.views(calibration)?.colour_of(store.objects(), side, image)?;
        encode_jpeg(Picture::Colour(&colour), width, QUALITY).map_err(|source| BrowseError::Picture { image, source })
    };
    let jpeg: Arc<Vec<u8>> = store.pictures.or_made((image, calibration, side == Side::Right, width), make)?;
    Ok(Answer::jpeg(&jpeg))
}

/// The left image in the middle of a pass.
pub(crate) fn thumb(store: &Store, id: String) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let middle = frames.get(frames.len() / 2).ok_or_else(|| BrowseError::not_here("frame of outing", &id))?;
    view(store, (middle.left, record.calibration), Side::Left, THUMB)
}

/// A frame's image: `left.jpg` or `right.jpg`.
pub(crate) fn frame(store: &Store, (id, number, side): (String, String, String)) -> Result<Answer, BrowseError> {
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

/// A place's left image.
pub(crate) fn node(store: &Store, (id, number): (String, String)) -> Result<Answer, BrowseError> {
    let (_, experience) = store.experience(&id)?;
    let node = number.parse::<usize>().ok().and_then(|number| experience.nodes.get(number));
    let node = node.ok_or_else(|| BrowseError::not_here("place", &number))?;
    view(store, (node.left, experience.calibration), Side::Left, FULL)
}
