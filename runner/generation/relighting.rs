//! What relighting needs of a traversal beside its left images: the right ones, where the sun stood, and which way the
//! camera looked.
//!
//! The sun follows from place and stamp, both from the recording. The way the camera looked is the chain's turned to
//! the compass: the chain is laid on the traversal's satellite fixes, or on its true poses where it has no fixes. The
//! camera is taken to look level.

use super::compass::{compass, seen_by_camera};
use super::sun::sun;
use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use crate::generation::images::unusable;
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::images::Side;
use furrow_catalog::records::{GeneratorRecord, TraversalRecord};
use furrow_catalog::tables::{chain_from_parquet, frames_from_parquet};
use furrow_catalog::{Catalog, Objects, Views};
use furrow_generator::{Shading, Suns};
use furrow_model::{Experience, ObjectId, TraversalId};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A fix tells place and compass where its standard deviation is at most this.
const FIX_STD_M: f64 = 5.0;

/// What training adds to the record of a generator that relights.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relight {
    /// Where the site lies, degrees north.
    pub latitude_deg: f64,
    /// Degrees east.
    pub longitude_deg: f64,
    /// To the target's sun: east, north, up.
    pub target_sun: [f64; 3],
}

impl Relight {
    /// From the target's traversals; `place` in degrees north and east, where the traversals' fixes do not tell it.
    ///
    /// # Errors
    /// [`RunError::Generator`] where nothing tells the place.
    pub(crate) fn of(
        catalog: &Catalog,
        name: &str,
        target: &[TraversalId],
        place: Option<[f64; 2]>,
    ) -> Result<Self, RunError> {
        let traversals = target.iter().map(|id| LiveTraversal::load(catalog, *id)).collect::<Result<Vec<_>, _>>()?;
        let fixed = |traversal: &LiveTraversal| {
            Ok::<_, RunError>(
                GroundTruth::by_fixes(catalog.objects(), &traversal.record, FIX_STD_M)?.and_then(|track| track.place()),
            )
        };
        let found = match place {
            Some(place) => Some(place),
            None => traversals.iter().map(fixed).find_map(Result::transpose).transpose()?,
        };
        let [latitude_deg, longitude_deg] = found.ok_or_else(|| {
            RunError::generator(
                name,
                format!("relighting needs the sun's place, and the target's traversals have no satellite fix within {FIX_STD_M} m: say where the site lies with --place LATITUDE,LONGITUDE"),
            )
        })?;
        let mut sum = [0.0; 3];
        for frame in traversals.iter().filter_map(|traversal| traversal.frames.get(traversal.frames.len() / 2)) {
            let sun = sun(latitude_deg, longitude_deg, frame.stamp_ns);
            sum.iter_mut().zip(sun).for_each(|(sum, part)| *sum += part);
        }
        let length = sum.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-12);
        Ok(Self { latitude_deg, longitude_deg, target_sun: sum.map(|v| v / length) })
    }
}

/// What relights one image, beside the image: part of the name under which it is remembered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Light {
    right: ObjectId,
    calibration: ObjectId,
    source_sun: [f64; 3],
    target_sun: [f64; 3],
}

/// What relights the images of one traversal.
pub(crate) struct Lights {
    name: String,
    relight: Relight,
    views: Views,
    calibration: ObjectId,
    rights: BTreeMap<i64, ObjectId>,
    /// Where the camera looked at each stamp, radians counter-clockwise from east.
    headings: BTreeMap<i64, f64>,
}

impl Lights {
    /// For the images of an experience.
    ///
    /// # Errors
    /// [`RunError::Generator`] where its recording has no right images, or nothing that tells the compass.
    pub fn of(
        catalog: &Catalog,
        record: &GeneratorRecord,
        relight: Relight,
        of: &Experience,
    ) -> Result<Self, RunError> {
        let rows = catalog.traversals()?;
        let here = rows.iter().filter(|row| row.site == of.site && row.route == of.route && row.slot == of.slot);
        for row in here {
            let traversal = catalog.traversal(row.id)?;
            if traversal.chain == of.chain {
                return Self::of_traversal(catalog, record, relight, &traversal);
            }
        }
        Err(RunError::generator(
            &record.name,
            "the traversal that the experience was made from is not in this store: relighting needs its right images",
        ))
    }

    /// For the images of a traversal.
    ///
    /// # Errors
    /// As [`Lights::of`].
    pub fn of_traversal(
        catalog: &Catalog,
        record: &GeneratorRecord,
        relight: Relight,
        traversal: &TraversalRecord,
    ) -> Result<Self, RunError> {
        let objects = catalog.objects();
        let chain = chain_from_parquet(objects.read(traversal.chain)?)?.poses();
        let track = match GroundTruth::by_fixes(objects, traversal, FIX_STD_M)? {
            Some(track) => Some(track),
            None => GroundTruth::of(objects, traversal)?,
        };
        let start_rad = track.and_then(|track| compass(&chain, &track)).ok_or_else(|| {
            RunError::generator(
                &record.name,
                format!("relighting needs to know which way the camera looked, and the {} traversal on route '{}' has no satellite fixes (within {FIX_STD_M} m, over some metres): train a generator without --relight for it", traversal.slot, traversal.route),
            )
        })?;
        let frames = frames_from_parquet(objects.read(traversal.frames)?)?;
        Ok(Self {
            name: record.name.clone(),
            relight,
            views: Views::load(objects, traversal.calibration)?,
            calibration: traversal.calibration,
            rights: frames.iter().filter_map(|frame| Some((frame.stamp_ns, frame.right?.image))).collect(),
            headings: chain.iter().map(|pose| (pose.stamp_ns, start_rad - pose.start_from_here.yaw_rad())).collect(),
        })
    }

    /// What relights the image of a stamp.
    ///
    /// # Errors
    /// [`RunError::Generator`] where it has no right image.
    pub fn at(&self, stamp_ns: i64) -> Result<Light, RunError> {
        let (Some(right), Some(heading_rad)) = (self.rights.get(&stamp_ns), self.headings.get(&stamp_ns)) else {
            return Err(RunError::generator(
                &self.name,
                "relighting needs right images, and a single camera took these: train a generator without --relight for them",
            ));
        };
        let source = sun(self.relight.latitude_deg, self.relight.longitude_deg, stamp_ns);
        Ok(Light {
            right: *right,
            calibration: self.calibration,
            source_sun: seen_by_camera(source, *heading_rad),
            target_sun: seen_by_camera(self.relight.target_sun, *heading_rad),
        })
    }

    /// The shading of a stored left image of `size`.
    ///
    /// # Errors
    /// Where an image cannot be read, or is not the rig's.
    pub fn shading(
        &self,
        objects: &Objects,
        left: ObjectId,
        light: &Light,
        size: (usize, usize),
    ) -> Result<Shading, RunError> {
        let views = &self.views;
        let pair = [views.grey_of(objects, Side::Left, left)?, views.grey_of(objects, Side::Right, light.right)?];
        let suns = Suns { source: light.source_sun, target: light.target_sun };
        let stored = |at| views.source_of(Side::Left, at);
        Shading::of([&pair[0], &pair[1]], &views.rig(), suns, size, stored).map_err(|error| unusable(left, error))
    }
}
