//! The first images of a recording that can be read: they tell size and mosaic, and whether more is to be looked at.

use super::image_message::image_of;
use crate::recording::{RawMessage, Recording};
use crate::topics::StereoTopics;
use crate::traversal::error::IngestError;
use crate::traversal::picture::Picture;
use furrow_catalog::images::{Depth, SeenPixels, Side};
use std::ops::ControlFlow;
use std::path::Path;

/// The first image of each side that can be read. What comes before it costs its frame later.
pub(super) fn first_images(
    path: &Path,
    recording: &Recording,
    stereo: &StereoTopics,
) -> Result<[Picture; 2], IngestError> {
    let topics = [stereo.left_image.as_str(), stereo.right_image.as_str()];
    let mut found: [Option<Picture>; 2] = [None, None];
    let mut images = [0_u64; 2];
    let mut faults: [Option<IngestError>; 2] = [None, None];
    let read = recording.read(&topics, &mut |_| {}, &mut |message| {
        let place = usize::from(message.topic.name == topics[1]);
        images[place] += 1;
        if found[place].is_none() {
            match checked(path, message, stereo.compressed, Side::BOTH[place]) {
                Ok(picture) => found[place] = Some(picture),
                Err(fault) => {
                    faults[place].get_or_insert(fault);
                }
            }
        }
        if found.iter().all(Option::is_some) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let found = match found {
        [Some(left), Some(right)] => return Ok([left, right]),
        found => found,
    };
    let _ = read?;
    let lacking = found.iter().zip(faults).find_map(|(found, fault)| fault.filter(|_| found.is_none()));
    if let Some(fault) = lacking {
        return Err(fault);
    }
    let [left, right] = images;
    Err(match Side::BOTH.into_iter().find(|side| images[*side as usize] == 0 && left + right > 0) {
        Some(side) => IngestError::EmptyTopic {
            path: path.to_owned(),
            side,
            topic: topics[side as usize].to_owned(),
            other: topics[1 - side as usize].to_owned(),
            images: left + right,
        },
        None => IngestError::NoPairs { path: path.to_owned(), left, right },
    })
}

/// A message's picture, if it can be read.
fn checked(path: &Path, message: RawMessage<'_>, compressed: bool, side: Side) -> Result<Picture, IngestError> {
    let (stamp_ns, picture) = image_of(message, compressed).map_err(|source| IngestError::Message {
        path: path.to_owned(),
        topic: message.topic.name.clone(),
        receive_ns: message.receive_ns,
        source: Box::new(source),
    })?;
    let unreadable = |source| IngestError::Image { path: path.to_owned(), side, stamp_ns, source: Box::new(source) };
    picture.check().map_err(unreadable)?;
    Ok(picture)
}

/// How many bits the recording's 16-bit pixels use, its `firsts` being read already. Every image is looked at, until
/// one needs all of them.
pub(super) fn depth_of(
    recording: &Recording,
    stereo: &StereoTopics,
    firsts: &[Picture; 2],
) -> Result<Depth, IngestError> {
    if !firsts.iter().any(Picture::is_deep) {
        return Ok(Depth::FULL);
    }
    let mut seen = SeenPixels::default();
    let topics = [stereo.left_image.as_str(), stereo.right_image.as_str()];
    let _ = recording.read(&topics, &mut |_| {}, &mut |message| {
        if let Ok((_, picture)) = image_of(message, stereo.compressed) {
            picture.show(&mut seen);
        }
        if seen.is_decided() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(seen.depth())
}

/// What is noted of a depth that is not the full one.
pub(super) fn depth_note(depth: Depth) -> Option<String> {
    (depth != Depth::FULL).then(|| {
        format!(
            "16-bit pixels use {} bits in this recording: they are scaled by that range, up to {}",
            depth.bits(),
            (1_u32 << depth.bits()) - 1
        )
    })
}
