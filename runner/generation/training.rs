//! Training of optimal-transport flow: the left images of two slots on one route become a generator.

use super::images::{stored_colour, unusable};
use super::registry::weights_of;
use super::relighting::Relight;
use crate::RunError;
use crate::inputs::key::{TRAINED, key_of};
use crate::inputs::sampling::spread;
use crate::inputs::traversals::LiveTraversal;
use crate::progress::{Counter, Progress, Stage, Subject};
use furrow_catalog::records::{GeneratorRecord, TrainingDomain};
use furrow_catalog::{Catalog, Objects};
use furrow_generator::kinds::OTF;
use furrow_generator::{ALGORITHM, Generator, Moments, Otf, Strengths, Workspace};
use furrow_model::{ObjectId, TimeSlot};
use rayon::prelude::*;
use serde_json::json;
use std::collections::BTreeSet;

/// What to train.
#[derive(Debug, Clone)]
pub struct TrainingRequest {
    /// The site.
    pub site: String,
    /// The route whose traversals to train on: not one to be judged on.
    pub route: String,
    /// The slot to move images from.
    pub from: TimeSlot,
    /// The slot to move them towards.
    pub to: TimeSlot,
    /// What it will be called.
    pub name: String,
    /// At most so many images of each slot, evenly spread.
    pub images: usize,
    /// Optional stages.
    pub strengths: Strengths,
    /// Where the site lies, degrees north and east, for relighting; the traversals' satellite fixes tell where left
    /// out.
    pub place: Option<[f64; 2]>,
}

/// A left image and the calibration record of its camera.
type Pictured = (ObjectId, ObjectId);

/// Trains a generator, or finds the one that these images gave.
///
/// # Errors
/// [`RunError::Generator`] where there are no such traversals or nothing can be learned from them.
pub fn train(
    catalog: &Catalog,
    request: &TrainingRequest,
    progress: Progress<'_>,
) -> Result<(ObjectId, GeneratorRecord), RunError> {
    let (source, source_images) = domain(catalog, request, request.from)?;
    let (target, target_images) = domain(catalog, request, request.to)?;
    let objects = catalog.objects();
    let key = key_of(TRAINED, &(ALGORITHM, &source_images, &target_images, request.strengths))?;
    let weights = match objects.derived(key)? {
        Some(weights) => weights,
        None => {
            let source = moments(objects, &source_images, request.from, progress)?;
            let target = moments(objects, &target_images, request.to, progress)?;
            let otf = Otf::train(&source, &target, request.strengths)
                .map_err(|error| RunError::generator(&request.name, error))?;
            let weights = objects.write(&weights_of(&Generator::Otf(Box::new(otf)))?)?;
            objects.remember(key, weights)?;
            weights
        }
    };
    let mut parameters = json!({ "site": request.site, "route": request.route, "strengths": request.strengths });
    if request.strengths.relight > 0.0 {
        parameters["relight"] = json!(Relight::of(catalog, &request.name, &target.traversals, request.place)?);
    }
    let record = GeneratorRecord {
        name: request.name.clone(),
        kind: OTF.to_owned(),
        algorithm: ALGORITHM.to_owned(),
        source: Some(source),
        target: Some(target),
        parameters,
        weights,
    };
    let id = catalog.enter_generator(&record)?;
    Ok((id, record))
}

/// The images of one slot, as the record names them, and with their calibrations.
fn domain(
    catalog: &Catalog,
    request: &TrainingRequest,
    slot: TimeSlot,
) -> Result<(TrainingDomain, Vec<Pictured>), RunError> {
    let rows = catalog.traversals()?;
    let here = rows.iter().filter(|row| row.site == request.site && row.route == request.route);
    let slots: BTreeSet<TimeSlot> = here.clone().map(|row| row.slot).collect();
    let chosen: Vec<_> = here.filter(|row| row.slot == slot).map(|row| row.id).collect();
    if chosen.is_empty() {
        let listed = slots.iter().map(TimeSlot::to_string).collect::<Vec<_>>().join(", ");
        let there = if slots.is_empty() { "it has no traversal at all".to_owned() } else { format!("it has {listed}") };
        return Err(RunError::generator(
            &request.name,
            format!(
                "no traversal at {slot} on route '{}' of site '{}': {there}; ingest one there, or name another route with --route",
                request.route, request.site
            ),
        ));
    }
    let mut all: Vec<Pictured> = Vec::new();
    for id in &chosen {
        let traversal = LiveTraversal::load(catalog, *id)?;
        all.extend(traversal.images().map(|image| (image, traversal.record.calibration)));
    }
    let images = spread(&all, request.images.max(1));
    let record = TrainingDomain { slot, traversals: chosen, images: images.iter().map(|image| image.0).collect() };
    Ok((record, images))
}

/// The sums over some images, each computed on its own and merged in their order.
fn moments(
    objects: &Objects,
    images: &[Pictured],
    slot: TimeSlot,
    progress: Progress<'_>,
) -> Result<Moments, RunError> {
    let counter = Counter::new(progress, (Stage::Colours, Subject::Slot(slot)), images.len());
    let each = images.par_iter().map_init(Workspace::default, |workspace, (image, calibration)| {
        let picture = stored_colour(objects, *image, *calibration)?;
        let moments = Moments::of(&picture, workspace).map_err(|error| unusable(*image, error));
        counter.tick();
        moments
    });
    let each: Vec<Moments> = each.collect::<Result<_, _>>()?;
    let mut all = Moments::default();
    each.iter().for_each(|moments| all.merge(moments));
    Ok(all)
}
