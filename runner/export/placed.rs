//! Images of experiences and traversals, with where each was taken.

use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use crate::inputs::zone::first_fix_deg;
use furrow_catalog::images::header::Format;
use furrow_catalog::images::{ImageError, Picture, decode_colour, encode_jpeg, inspect};
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Catalog, Views, tables};
use furrow_ingest::import::utm_of;
use furrow_ingest::import::vpr::PlaceName;
use furrow_model::{ExperienceId, ExperienceKind, ObjectId, TraversalId};
use std::collections::BTreeMap;

/// The quality at which images are encoded that are not stored as JPEG.
const QUALITY: u8 = 95;

/// Whose images are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlacesOf {
    /// The nodes of an experience.
    Experience(ExperienceId),
    /// Every frame of a traversal.
    Traversal(TraversalId),
}

/// Images with what tells where they were taken.
pub(super) struct Places {
    /// By stamp, nanoseconds.
    pub(super) images: Vec<(i64, ObjectId)>,
    views: Views,
    truth: Option<GroundTruth>,
    /// Without true positions: metres east and north of the start, which looks north, and the heading.
    chain: BTreeMap<i64, ([f64; 2], f64)>,
    /// Latitude and longitude from which the chain is laid out.
    origin_deg: Option<[f64; 2]>,
    /// What the positions come from.
    pub(super) source: String,
}

impl Places {
    /// Reads what the store holds of them.
    pub(super) fn load(catalog: &Catalog, of: PlacesOf) -> Result<Self, RunError> {
        let objects = catalog.objects();
        let (images, chain, calibration, record) = match of {
            PlacesOf::Experience(id) => {
                let experience = catalog.experience(id)?;
                let images = experience.nodes.iter().map(|node| (node.stamp_ns, node.left)).collect();
                (images, experience.chain, experience.calibration, driven(catalog, id)?)
            }
            PlacesOf::Traversal(id) => {
                let record = catalog.traversal(id)?;
                let frames = tables::frames_from_parquet(objects.read(record.frames)?)?;
                let images: Vec<_> = frames.iter().map(|frame| (frame.stamp_ns, frame.left)).collect();
                (images, record.chain, record.calibration, Some(record))
            }
        };
        let truth = record.as_ref().map(|record| GroundTruth::of(objects, record)).transpose()?.flatten();
        let origin_deg = record.as_ref().map(|record| first_fix_deg(catalog, record)).transpose()?.flatten();
        let trajectory = tables::chain_from_parquet(objects.read(chain)?)?;
        let laid_out = trajectory.poses().into_iter().map(|pose| {
            let [x, _, z] = pose.start_from_here.translation_m;
            (pose.stamp_ns, ([x, z], pose.start_from_here.yaw_rad().to_degrees()))
        });
        let source = match (&truth, origin_deg) {
            (Some(truth), _) => truth.source.clone(),
            (None, Some(_)) => "the chain, from the first satellite fix to the north".to_owned(),
            (None, None) => "the chain, from 0, 0 to the north".to_owned(),
        };
        Ok(Self {
            images,
            views: Views::load(objects, calibration)?,
            truth,
            chain: laid_out.collect(),
            origin_deg,
            source,
        })
    }

    /// The name of the image of a moment, but for its number; `None` where nothing tells where it was taken.
    pub(super) fn name(&self, stamp_ns: i64) -> Option<PlaceName> {
        let stamped = PlaceName { stamp_ns: Some(stamp_ns), ..PlaceName::default() };
        let Some(truth) = &self.truth else {
            let ([east, north], heading_deg) = *self.chain.get(&stamp_ns)?;
            let name = PlaceName { utm_m: [east, north], heading_deg: Some(heading_deg), ..stamped };
            let Some(origin) = self.origin_deg.and_then(|[latitude, longitude]| utm_of(latitude, longitude)) else {
                return Some(name);
            };
            let utm_m = [origin.east_m + east, origin.north_m + north];
            return Some(PlaceName { utm_m, zone: Some((origin.zone, origin.letter)), ..name });
        };
        let pose = truth.at(stamp_ns)?;
        let heading_deg = Some(90.0 - pose.heading_rad.to_degrees());
        let on_grid = truth.geodetic_deg(pose).and_then(|[latitude, longitude]| {
            let utm = utm_of(latitude, longitude)?;
            let (utm_m, zone) = ([utm.east_m, utm.north_m], Some((utm.zone, utm.letter)));
            Some(PlaceName { utm_m, zone, geodetic_deg: Some([latitude, longitude]), heading_deg, ..stamped.clone() })
        });
        Some(on_grid.unwrap_or(PlaceName { utm_m: [pose.east_m, pose.north_m], heading_deg, ..stamped }))
    }

    /// The stored file where it is a JPEG, else one of the same pixels; and whether it was encoded anew.
    pub(super) fn jpeg(&self, catalog: &Catalog, image: ObjectId) -> Result<(Vec<u8>, bool), RunError> {
        let wrong = |error: ImageError| RunError::Image { image, reason: error.to_string() };
        let bytes = catalog.objects().read(image)?;
        let bayer = self.views.record().left_bayer;
        if bayer.is_none() && matches!(inspect(&bytes).map_err(wrong)?.format, Format::Jpeg) {
            return Ok((bytes, false));
        }
        let colour = decode_colour(&bytes, bayer).map_err(wrong)?;
        Ok((encode_jpeg(Picture::Colour(&colour), usize::MAX, QUALITY).map_err(wrong)?, true))
    }
}

/// The traversal that an experience was recorded on, or its parent, where the store has it.
fn driven(catalog: &Catalog, id: ExperienceId) -> Result<Option<TraversalRecord>, RunError> {
    let recorded = match catalog.experience(id)?.kind {
        ExperienceKind::Recorded => id,
        ExperienceKind::Generated { parent, .. } => parent,
    };
    let row = catalog.traversals_of(recorded)?.into_iter().next_back();
    Ok(row.map(|row| catalog.traversal(row.id)).transpose()?)
}
