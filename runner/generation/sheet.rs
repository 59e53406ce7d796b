//! Contact sheets (X6): what a generator makes of some images, row by row of domainness, between the real source and the real target.

use super::painter::Painter;
use super::registry::wrong;
use super::training::stored_colour;
use crate::RunError;
use crate::plan::LivePass;
use crate::sampling::middles;
use furrow_catalog::Catalog;
use furrow_catalog::images::{self, SheetRow};
use furrow_catalog::records::{GeneratorRecord, TrainingDomain};
use furrow_generator::{Seed, Workspace};
use furrow_model::{ColourImage, Experience, ObjectId};
use rayon::prelude::*;

/// Pictures in a row.
const COLUMNS: usize = 4;
const QUALITY: u8 = 88;

/// A place of the route: its stamp, left image and calibration.
type Place = (i64, ObjectId, ObjectId);

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
    let (source, target) = (places_of(catalog, record.source.as_ref())?, places_of(catalog, record.target.as_ref())?);
    let source = match of {
        Some(experience) => {
            experience.nodes.iter().map(|node| (node.stamp_ns, node.left, experience.calibration)).collect()
        }
        None => source,
    };
    if source.is_empty() {
        return Err(wrong(&record.name, "it was trained on no images of this store: name an experience with --of"));
    }
    let painter = Painter::load(catalog, record)?;
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
            painter.paint(picture, *z, Seed { seed: 0, stamp_ns: place.0 }, workspace)
        };
        let painted =
            source.par_iter().zip(&pictures).map_init(Workspace::default, paint).collect::<Result<Vec<_>, _>>()?;
        rows.push(SheetRow { title: format!("{} at z = {z}", record.name), pictures: painted });
    }
    rows.insert(0, SheetRow { title: format!("recorded{}", title(&record.source)), pictures });
    if !target.is_empty() {
        rows.push(SheetRow { title: format!("recorded{}", title(&record.target)), pictures: real(&target)? });
    }
    images::contact_sheet(&rows, QUALITY).map_err(|error| wrong(&record.name, error))
}

/// The places of the passes that a domain was trained on.
fn places_of(catalog: &Catalog, domain: Option<&TrainingDomain>) -> Result<Vec<Place>, RunError> {
    let mut places = Vec::new();
    for id in domain.iter().flat_map(|domain| &domain.traversals) {
        let pass = LivePass::load(catalog, *id)?;
        places.extend(pass.frames.iter().map(|frame| (frame.stamp_ns, frame.left, pass.record.calibration)));
    }
    Ok(places)
}
