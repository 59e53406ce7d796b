//! Descriptors of images that another program computed.

use super::{Matches, kept, of_ranked, remembered};
use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::descriptors::DescriptorFile;
use crate::inputs::key::{EXTERNAL, key_of};
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::Objects;
use furrow_localiser::external::{ImageDescriptors, Metric, rank};
use furrow_model::ObjectId;

/// The descriptors of a live pass, and the file they and those of the nodes come from.
pub(crate) struct LiveDescriptors<'a> {
    file: &'a DescriptorFile,
    live: ImageDescriptors,
}

impl<'a> LiveDescriptors<'a> {
    /// Of all frames of a pass.
    pub fn of(file: &'a DescriptorFile, pass: &LiveTraversal) -> Result<Self, RunError> {
        let images: Vec<ObjectId> = pass.images().collect();
        let live = file.of_images(&images, &format!("the live pass at {}", pass.record.slot))?;
        Ok(Self { file, live })
    }
}

/// Finds or computes an experience's answers to a live pass.
pub(crate) fn external_matches(
    objects: &Objects,
    (pass, live): (&LiveTraversal, &LiveDescriptors<'_>),
    contender: &Contender,
    metric: Metric,
    verified: u32,
) -> Result<Matches, RunError> {
    let kept = kept(verified);
    let key = key_of(EXTERNAL, &(live.file.digest, metric, pass.record.frames, contender.id, kept));
    remembered(objects, key, || {
        let images: Vec<ObjectId> = contender.images().collect();
        let places = live.file.of_images(&images, &format!("the experience {}", contender.label))?;
        rank(&live.live, &places, metric, kept).map(of_ranked).map_err(|error| live.file.wrong(&error.to_string()))
    })
}
