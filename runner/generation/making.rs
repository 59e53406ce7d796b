//! The story of a generated experience: a recorded parent's images are painted, stored losslessly, and become nodes at the parent's stamps on
//! the parent's chain.

use super::painter::Painter;
use super::registry::wrong;
use super::relighting::{Light, Lights};
use super::training::{stored_colour, unusable};
use crate::RunError;
use crate::key::{GENERATED, PAINTED, key_of};
use crate::progress::{Counter, Progress};
use furrow_catalog::images::{RawImage, store_raw};
use furrow_catalog::records::{self, record_id};
use furrow_catalog::{Catalog, Objects, ViewsRecord};
use furrow_generator::{Seed, Workspace};
use furrow_model::{ColourImage, Domainness, Experience, ExperienceId, ExperienceKind, Node, ObjectId, TimeSlot};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// What to generate.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The recorded experience.
    pub parent: &'a Experience,
    /// The generator's record.
    pub generator: ObjectId,
    /// How far to move the images.
    pub domainness: Domainness,
    /// The slot that the result stands for.
    pub mimics: TimeSlot,
    /// Seeds what is drawn at random.
    pub seed: u64,
    /// Of a command, the digest of its own files, so that a changed program gives another experience.
    pub files: Option<ObjectId>,
}

/// What was generated.
#[derive(Debug, Clone, PartialEq)]
pub struct Generated {
    /// The experience's id.
    pub id: ExperienceId,
    /// The experience.
    pub experience: Experience,
    /// Images that had to be painted; the others were found.
    pub painted: u32,
}

impl Request<'_> {
    /// The key under which the experience is remembered.
    pub(crate) fn key(&self) -> ObjectId {
        let inputs = (record_id(self.parent), self.generator, self.domainness, self.mimics, self.seed);
        match self.files {
            Some(files) => key_of(GENERATED, &(inputs, files)),
            None => key_of(GENERATED, &inputs),
        }
    }

    /// The experience, if it was ever made.
    ///
    /// # Errors
    /// Where the store cannot be read.
    pub fn known(&self, objects: &Objects) -> Result<Option<Generated>, RunError> {
        let Some(id) = objects.derived(self.key())? else { return Ok(None) };
        let experience = records::read(objects, id)?;
        Ok(Some(Generated { id: ExperienceId(id.0), experience, painted: 0 }))
    }
}

/// Finds or makes a generated experience. `painter` is the one of the request's generator.
///
/// # Errors
/// [`RunError::Generator`] where the parent is itself generated or an image cannot be painted.
pub fn generate(
    catalog: &Catalog,
    request: &Request<'_>,
    painter: &Painter,
    progress: Progress<'_>,
) -> Result<Generated, RunError> {
    let objects = catalog.objects();
    if let Some(generated) = request.known(objects)? {
        // The row may be missing where the process was killed between the two.
        catalog.enter_generated(request.parent, &generated.experience)?;
        return Ok(generated);
    }
    let parent = request.parent;
    let parent_id = ExperienceId(record_id(parent).0);
    if parent.kind != ExperienceKind::Recorded {
        let reason = format!(
            "experience {} is generated itself: grandchildren are refused, name a recorded one",
            parent_id.short()
        );
        return Err(wrong(&request.generator.short(), reason));
    }
    let (nodes, painted) = paint_nodes(catalog, request, painter, progress)?;
    let kind = ExperienceKind::Generated {
        parent: parent_id,
        generator: request.generator,
        domainness: request.domainness,
        mimics: request.mimics,
    };
    let experience = Experience { kind, nodes, calibration: resolved(objects, parent.calibration)?, ..parent.clone() };
    let id = catalog.enter_generated(parent, &experience)?;
    objects.remember(request.key(), ObjectId(id.0))?;
    Ok(Generated { id, experience, painted })
}

/// The nodes with their new images, and how many of those had to be painted.
fn paint_nodes(
    catalog: &Catalog,
    request: &Request<'_>,
    painter: &Painter,
    progress: Progress<'_>,
) -> Result<(Vec<Node>, u32), RunError> {
    let objects = catalog.objects();
    let (z, calibration) = (request.domainness.0, request.parent.calibration);
    let lights = painter.lights(catalog, request.parent)?;
    let views: ViewsRecord = records::read(objects, calibration)?;
    let stage = format!("painting {} at z = {z}", request.mimics);
    let counter = Counter::new(progress, &stage, request.parent.nodes.len());
    let fresh = AtomicU32::new(0);
    let paint = |workspace: &mut Workspace, node: &Node| {
        let seed = Seed { seed: request.seed, stamp_ns: node.stamp_ns };
        let lit = lights.as_ref().map(|lights| Ok::<_, RunError>((lights, lights.at(node.stamp_ns)?))).transpose()?;
        let inputs = (painter.brush(), z, node.left, views.left_bayer, seed.seed, seed.stamp_ns);
        let key = match &lit {
            Some((_, light)) => key_of(PAINTED, &(inputs, light)),
            None => key_of(PAINTED, &inputs),
        };
        let left = match objects.derived(key)? {
            Some(image) => image,
            None => {
                let image = stored_colour(objects, node.left, calibration)?;
                let shade = |(lights, light): &(&Lights, Light)| {
                    lights.shading(objects, node.left, light, (image.width, image.height))
                };
                let shading = lit.as_ref().map(shade).transpose()?;
                let painted = painter.paint(&image, z, seed, shading.as_ref(), workspace)?;
                let stored = objects.write(&lossless(&painted).map_err(|error| unusable(node.left, error))?)?;
                objects.remember(key, stored)?;
                fresh.fetch_add(1, Ordering::Relaxed);
                stored
            }
        };
        counter.tick();
        Ok(Node { stamp_ns: node.stamp_ns, left })
    };
    let nodes = request.parent.nodes.par_iter().map_init(Workspace::default, paint).collect::<Result<_, RunError>>()?;
    Ok((nodes, fresh.into_inner()))
}

/// An image as it is stored.
pub(crate) fn lossless(image: &ColourImage) -> Result<Vec<u8>, furrow_catalog::images::ImageError> {
    let (width, height) = (image.width, image.height);
    let raw = RawImage { width, height, step: 3 * width, encoding: "rgb8", big_endian: false, data: &image.rgb };
    Ok(store_raw(&raw)?.bytes)
}

/// The calibration of painted images: the parent's, but that painted images have their colours already where the parent's are mosaics.
fn resolved(objects: &Objects, calibration: ObjectId) -> Result<ObjectId, RunError> {
    let record: ViewsRecord = records::read(objects, calibration)?;
    if record.left_bayer.is_none() {
        return Ok(calibration);
    }
    Ok(objects.write(&records::encode(&ViewsRecord { left_bayer: None, ..record }))?)
}
