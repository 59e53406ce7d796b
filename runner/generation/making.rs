//! The story of a generated experience: a recorded parent's images are painted, stored losslessly, and become nodes at
//! the parent's stamps on the parent's chain.

use super::images::{lossless, stored_colour, unusable};
use super::painter::Painter;
use super::relighting::{Light, Lights};
use crate::RunError;
use crate::inputs::key::{PAINTED, key_of};
use crate::inputs::making::{Generated, Request};
use crate::progress::{Counter, Progress, Stage, Subject};
use furrow_catalog::records::{self, ViewsRecord, record_id};
use furrow_catalog::{Catalog, Objects};
use furrow_generator::{Seed, Workspace};
use furrow_model::{Experience, ExperienceId, ExperienceKind, Node, ObjectId};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

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
    let parent_id = ExperienceId(record_id(parent)?.0);
    check_parent(parent_id, parent).map_err(|reason| RunError::generator(&request.generator.short(), reason))?;
    let (nodes, painted) = paint_nodes(catalog, request, painter, progress)?;
    let kind = ExperienceKind::Generated {
        parent: parent_id,
        generator: request.generator,
        domainness: request.domainness,
        mimics: request.mimics,
    };
    let experience = Experience { kind, nodes, calibration: resolved(objects, parent.calibration)?, ..parent.clone() };
    let id = catalog.enter_generated(parent, &experience)?;
    objects.remember(request.key()?, ObjectId(id.0))?;
    Ok(Generated { id, experience, painted })
}

/// Refuses a parent that is itself generated: what is painted twice says nothing about its generator.
///
/// # Errors
/// The reason in words, with the parent's id.
pub fn check_parent(id: ExperienceId, parent: &Experience) -> Result<(), String> {
    match parent.kind {
        ExperienceKind::Recorded => Ok(()),
        ExperienceKind::Generated { .. } => Err(format!(
            "experience {} is generated itself: grandchildren are refused, name a recorded one",
            id.short()
        )),
    }
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
    let counter =
        Counter::new(progress, (Stage::Painting, Subject::Mimicked(request.mimics, z)), request.parent.nodes.len());
    let fresh = AtomicU32::new(0);
    let paint = |workspace: &mut Workspace, node: &Node| {
        let seed = Seed { seed: request.seed, stamp_ns: node.stamp_ns };
        let lit = lights.as_ref().map(|lights| Ok::<_, RunError>((lights, lights.at(node.stamp_ns)?))).transpose()?;
        let inputs = (painter.brush(), z, node.left, views.left_bayer, seed.seed, seed.stamp_ns);
        let key = match &lit {
            Some((_, light)) => key_of(PAINTED, &(inputs, light)),
            None => key_of(PAINTED, &inputs),
        }?;
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

/// The calibration of painted images: the parent's, but that painted images have their colours already where the
/// parent's are mosaics.
fn resolved(objects: &Objects, calibration: ObjectId) -> Result<ObjectId, RunError> {
    let record: ViewsRecord = records::read(objects, calibration)?;
    if record.left_bayer.is_none() {
        return Ok(calibration);
    }
    Ok(objects.write(&records::encode(&ViewsRecord { left_bayer: None, ..record })?)?)
}
