//! The quality gate (thesis Eqs 5.4 to 5.8): what a generator does to features, measured before anyone localises with
//! it.

use crate::RunError;
use crate::generation::images::stored_colour;
use crate::generation::painter::Painter;
use crate::generation::relighting::Lights;
use crate::inputs::key::{GATE, key_of};
use crate::inputs::sampling::middles;
use crate::progress::{Counter, Progress, Stage, Subject};
use furrow_catalog::Catalog;
use furrow_catalog::images::grey_of;
use furrow_catalog::index::GateRow;
use furrow_catalog::records::{self, GateRecord, GeneratorRecord, SwitchRecord, record_id};
use furrow_generator::quality::{clipped, doubts, hallucinated, laplacian_energy, mean_step, switch_ladder};
use furrow_generator::{Seed, Workspace};
use furrow_localiser::surf::{Descriptor, SurfParams, describe, surf};
use furrow_model::{
    ColourImage, Domainness, Experience, ExperienceId, GreyImage, Measures, Node, ObjectId, SwitchIndex,
};
use rayon::prelude::*;

/// Images of an experience that are measured, evenly spread.
const SAMPLE: usize = 4;
/// A match is good where its distance is below this share of the second nearest's (thesis F15).
const RATIO: f32 = 0.5;

/// Measures a generator on a sample of an experience's images at some domainnesses, or finds what was measured before.
///
/// # Errors
/// Where an image cannot be read or painted.
pub fn gate(
    catalog: &Catalog,
    parent: &Experience,
    (generator, painter): (ObjectId, &Painter),
    domainnesses: &[Domainness],
    seed: u64,
    progress: Progress<'_>,
) -> Result<Vec<GateRecord>, RunError> {
    let objects = catalog.objects();
    let parent_id = ExperienceId(record_id(parent)?.0);
    let sample = middles(&parent.nodes, SAMPLE);
    let images: Vec<ObjectId> = sample.iter().map(|node| node.left).collect();
    let key = |z: &Domainness| key_of(GATE, &(generator, painter.brush(), parent_id, &images, z, seed));
    let known = domainnesses.iter().map(|z| objects.derived(key(z)?)).collect::<Result<Vec<_>, _>>()?;
    let missing: Vec<Domainness> =
        domainnesses.iter().zip(&known).filter(|(_, known)| known.is_none()).map(|(z, _)| *z).collect();
    if !missing.is_empty() {
        let clipped_target = clipped_in_target(catalog, generator, parent.calibration)?;
        let lights = painter.lights(catalog, parent)?;
        let of = Sample { catalog, calibration: parent.calibration, nodes: &sample, painter, lights, seed, progress };
        let ladder = key_of(GATE, &(generator, painter.brush(), parent_id, &images, "switch index", seed))?;
        let switch = match objects.derived(ladder)? {
            Some(object) => records::read::<SwitchRecord>(objects, object)?.switch,
            None => {
                let switch = of.switch()?;
                objects.remember(ladder, objects.write(&records::encode(&SwitchRecord { switch })?)?)?;
                switch
            }
        };
        for (z, measures) in missing.iter().zip(of.curve(&missing, clipped_target)?) {
            let record = GateRecord {
                generator,
                parent: parent_id,
                images: images.clone(),
                switch,
                doubts: doubts(switch.as_ref(), std::slice::from_ref(&measures)),
                measures,
            };
            objects.remember(key(z)?, objects.write(&records::encode(&record)?)?)?;
        }
    }
    let mut found = Vec::new();
    for z in domainnesses {
        if let Some(object) = objects.derived(key(z)?)? {
            catalog.enter_gate(&GateRow { generator, parent: parent_id, domainness: z.0, object })?;
            found.push(records::read(objects, object)?);
        }
    }
    Ok(found)
}

/// The share of clipped pixels in a sample of the images that a generator was trained to mimic; none of one that was
/// not trained here.
fn clipped_in_target(catalog: &Catalog, generator: ObjectId, calibration: ObjectId) -> Result<Option<f64>, RunError> {
    let objects = catalog.objects();
    let target = records::read::<GeneratorRecord>(objects, generator)?.target;
    let images = target.map(|target| target.images).unwrap_or_default();
    let shares: Vec<f64> = (middles(&images, SAMPLE).into_iter())
        .map(|image| stored_colour(objects, image, calibration).map(|image| clipped(&image)))
        .collect::<Result<_, _>>()?;
    Ok((!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64))
}

/// The images that a generator is measured on.
struct Sample<'a> {
    catalog: &'a Catalog,
    calibration: ObjectId,
    nodes: &'a [Node],
    painter: &'a Painter,
    /// What relights them, of a generator that does.
    lights: Option<Lights>,
    seed: u64,
    progress: Progress<'a>,
}

/// Paints one image at a domainness.
type Paint<'a> = &'a mut dyn FnMut(f64) -> Result<ColourImage, RunError>;

impl Sample<'_> {
    /// What `of` gives for each image.
    fn each<T: Send>(
        &self,
        stage: Stage,
        of: impl Fn(&ColourImage, Paint<'_>) -> Result<T, RunError> + Sync,
    ) -> Result<Vec<T>, RunError> {
        let counter = Counter::new(self.progress, (stage, Subject::Whole), self.nodes.len());
        let of_node = |workspace: &mut Workspace, node: &Node| {
            let source = stored_colour(self.catalog.objects(), node.left, self.calibration)?;
            let seed = Seed { seed: self.seed, stamp_ns: node.stamp_ns };
            let shade = |lights: &Lights| {
                let light = lights.at(node.stamp_ns)?;
                lights.shading(self.catalog.objects(), node.left, &light, (source.width, source.height))
            };
            let shading = self.lights.as_ref().map(shade).transpose()?;
            let found = of(&source, &mut |z| self.painter.paint(&source, z, seed, shading.as_ref(), workspace));
            counter.tick();
            found
        };
        self.nodes.par_iter().map_init(Workspace::default, of_node).collect()
    }

    /// How evenly the generator moves; none where it does not paint all of 0 to 1.
    fn switch(&self) -> Result<Option<SwitchIndex>, RunError> {
        let each = self.each(Stage::SwitchIndex, |_, paint| Ok(steps(paint).ok()))?;
        let steps: Option<Vec<Vec<f64>>> = each.into_iter().collect();
        let mean = |all: Vec<Vec<f64>>| -> Vec<f64> {
            (0..switch_ladder().len() - 1).map(|k| mean_of(all.iter().map(|steps| steps[k]))).collect()
        };
        Ok(steps.and_then(|all| SwitchIndex::of(&mean(all))))
    }

    /// The mean measures at each domainness; `clipped_target` is the share of clipped pixels in what is mimicked.
    fn curve(&self, domainnesses: &[Domainness], clipped_target: Option<f64>) -> Result<Vec<Measures>, RunError> {
        let each = self.each(Stage::GeneratorMeasures, |source, paint| {
            let painted = domainnesses.iter().map(|z| Ok((z.0, paint(z.0)?))).collect::<Result<Vec<_>, RunError>>()?;
            Ok(measures(source, &painted, clipped_target))
        })?;
        let mean_at = |(i, z): (usize, &Domainness)| {
            let mean = |of: fn(&Measures) -> f64| mean_of(each.iter().map(|curve| of(&curve[i])));
            Measures {
                z: z.0,
                matchable: mean(|m| m.matchable),
                good_matches: mean(|m| m.good_matches),
                descriptor_distance: mean(|m| m.descriptor_distance),
                descriptor_loss: mean(|m| m.descriptor_loss),
                laplacian_ratio: mean(|m| m.laplacian_ratio),
                clipped: mean(|m| m.clipped),
                clipped_source: mean(|m| m.clipped_source),
                clipped_target,
                hallucinated: mean(|m| m.hallucinated),
            }
        };
        Ok(domainnesses.iter().enumerate().map(mean_at).collect())
    }
}

/// The mean; 0 of none.
fn mean_of(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// The steps between neighbours of the switch ladder, in grey levels.
fn steps(paint: Paint<'_>) -> Result<Vec<f64>, RunError> {
    let [first, rest @ ..] = switch_ladder();
    let mut before = paint(first)?;
    let mut steps = Vec::with_capacity(rest.len());
    for z in rest {
        let after = paint(z)?;
        steps.push(mean_step(&before, &after));
        before = after;
    }
    Ok(steps)
}

/// The measures of one source image at several domainnesses.
fn measures(source: &ColourImage, painted: &[(f64, ColourImage)], clipped_target: Option<f64>) -> Vec<Measures> {
    let grey: GreyImage = grey_of(source);
    let params = SurfParams::GOLDEN_UPRIGHT;
    let features = surf(&grey, &params);
    let energy = laplacian_energy(&grey);
    let measure = |(z, painted): &(f64, ColourImage)| {
        let fake = grey_of(painted);
        let found = surf(&fake, &params);
        let (matchable, good) = matches(&features.descriptors, &found.descriptors);
        let moved = describe(&fake, &features.keypoints, params.upright);
        let distance = mean_distance(&features.descriptors, &moved);
        let lost = if matchable > 0 { (matchable - good) as f64 / matchable as f64 } else { 1.0 };
        let places: Vec<(f32, f32)> = found.keypoints.iter().map(|point| (point.x_px, point.y_px)).collect();
        Measures {
            z: *z,
            matchable: matchable as f64,
            good_matches: good as f64,
            descriptor_distance: distance,
            descriptor_loss: lost * distance,
            laplacian_ratio: if energy > 0.0 { laplacian_energy(&fake) / energy } else { 1.0 },
            clipped: clipped(painted),
            clipped_source: clipped(source),
            clipped_target,
            hallucinated: hallucinated(&grey, &places).unwrap_or(0.0),
        }
    };
    painted.iter().map(measure).collect()
}

/// Of the source's descriptors, those with two neighbours, and those whose nearest is nearer than half the second (Eq
/// 5.6).
fn matches(source: &[Descriptor], painted: &[Descriptor]) -> (usize, usize) {
    if painted.len() < 2 {
        return (0, 0);
    }
    let is_good = |descriptor: &&Descriptor| {
        let (mut nearest, mut second) = (f32::INFINITY, f32::INFINITY);
        for other in painted {
            let distance: f32 = descriptor.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
            if distance < nearest {
                (nearest, second) = (distance, nearest);
            } else if distance < second {
                second = distance;
            }
        }
        nearest < RATIO * RATIO * second
    };
    (source.len(), source.iter().filter(is_good).count())
}

/// The mean absolute difference per number of descriptors at the same places (Eq 5.4, by 64 times the keypoints); 0
/// without keypoints.
fn mean_distance(source: &[Descriptor], painted: &[Descriptor]) -> f64 {
    let sum: f64 = source.iter().flatten().zip(painted.iter().flatten()).map(|(a, b)| f64::from((a - b).abs())).sum();
    sum / (64 * source.len()).max(1) as f64
}
