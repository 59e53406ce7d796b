//! Contact sheets (X6): what a generator makes of some images, row by row of domainness, between the real source and
//! the real target.

use super::painter::Painter;
use super::relighting::Lights;
use crate::RunError;
use crate::generation::images::stored_colour;
use crate::inputs::sampling::middles;
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::Catalog;
use furrow_catalog::images::{self, SheetRow};
use furrow_catalog::records::{GeneratorRecord, TrainingDomain};
use furrow_catalog::tables::Frame;
use furrow_generator::{Seed, Workspace};
use furrow_model::{ColourImage, Experience, Node, ObjectId};
use rayon::prelude::*;
use std::sync::Arc;

/// Pictures in a row.
const COLUMNS: usize = 4;
const QUALITY: u8 = 80;

/// A place of the route: its stamp, left image and calibration, and what relights it.
type Place = (i64, ObjectId, ObjectId, Option<Arc<Lights>>);

/// The sheet of a generator as JPEG, on some of the images it was trained on, or on those of an experience.
///
/// # Errors
/// [`RunError::Generator`] where there are no images to show it on.
pub fn contact_sheet(
    catalog: &Catalog,
    record: &GeneratorRecord,
    of: Option<&Experience>,
    domainnesses: &[f64],
) -> Result<Vec<u8>, RunError> {
    let painter = Painter::load(catalog, record)?;
    let target = places_of(catalog, record.target.as_ref(), None)?;
    let source = match of {
        Some(experience) => {
            let lights = painter.lights(catalog, experience)?.map(Arc::new);
            let place = |node: &Node| (node.stamp_ns, node.left, experience.calibration, lights.clone());
            experience.nodes.iter().map(place).collect()
        }
        None => places_of(catalog, record.source.as_ref(), Some(&painter))?,
    };
    if source.is_empty() {
        return Err(RunError::generator(
            &record.name,
            "it was trained on no images of this store: name an experience with --of",
        ));
    }
    let (source, target) = (middles(&source, COLUMNS), middles(&target, COLUMNS));
    let real = |places: &[Place]| {
        places.iter().map(|place| stored_colour(catalog.objects(), place.1, place.2)).collect::<Result<Vec<_>, _>>()
    };
    let title =
        |domain: &Option<TrainingDomain>| domain.as_ref().map_or(String::new(), |domain| format!(" {}", domain.slot));
    let pictures = real(&source)?;
    let mut rows = Vec::new();
    for z in domainnesses {
        let paint = |workspace: &mut Workspace, (place, picture): (&Place, &ColourImage)| {
            let shade = |lights: &Arc<Lights>| {
                let light = lights.at(place.0)?;
                lights.shading(catalog.objects(), place.1, &light, (picture.width, picture.height))
            };
            let shading = place.3.as_ref().map(shade).transpose()?;
            painter.paint(picture, *z, Seed { seed: 0, stamp_ns: place.0 }, shading.as_ref(), workspace)
        };
        let painted =
            source.par_iter().zip(&pictures).map_init(Workspace::default, paint).collect::<Result<Vec<_>, _>>()?;
        rows.push(SheetRow { title: format!("{} at z = {z}", record.name), pictures: painted });
    }
    rows.insert(0, SheetRow { title: format!("recorded{}", title(&record.source)), pictures });
    if !target.is_empty() {
        rows.push(SheetRow { title: format!("recorded{}", title(&record.target)), pictures: real(&target)? });
    }
    images::contact_sheet(&rows, QUALITY).map_err(|error| RunError::generator(&record.name, error))
}

/// The places of the traversals that a domain was trained on, lit for `painter`.
fn places_of(
    catalog: &Catalog,
    domain: Option<&TrainingDomain>,
    painter: Option<&Painter>,
) -> Result<Vec<Place>, RunError> {
    let mut places = Vec::new();
    for id in domain.iter().flat_map(|domain| &domain.traversals) {
        let traversal = LiveTraversal::load(catalog, *id)?;
        let lights =
            painter.map(|painter| painter.lights_of_traversal(catalog, &traversal.record)).transpose()?.flatten();
        let lights = lights.map(Arc::new);
        let place = |frame: &Frame| (frame.stamp_ns, frame.left, traversal.record.calibration, lights.clone());
        places.extend(traversal.frames.iter().map(place));
    }
    Ok(places)
}
