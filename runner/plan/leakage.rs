//! The leakage guard: nothing may be trained on what it is judged on. The plan refuses and says which.

use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::Objects;
use furrow_catalog::records::TraversalRecord;
use furrow_model::ObjectId;
use std::collections::BTreeSet;

/// Training frames nearer than this to a judged frame show the same ground.
const NEAR_M: f64 = 5.0;

/// What was trained, and the traversals it was trained on.
pub(crate) struct Trained<'a> {
    /// What a traversal of it is called, as in "the codebook's vocabulary traversal".
    pub what: &'a str,
    /// The traversals.
    pub traversals: &'a [LiveTraversal],
}

/// Why what was trained must not be judged on `judged`; `None` where it may.
pub(crate) fn leak(
    objects: &Objects,
    trained: &Trained<'_>,
    judged: &TraversalRecord,
    images: impl Iterator<Item = ObjectId>,
) -> Result<Option<String>, RunError> {
    let judged_images: BTreeSet<ObjectId> = images.collect();
    for traversal in trained.traversals {
        let of = |what: String| {
            let (slot, route) = (judged.slot, &judged.route);
            format!(
                "{} {} {what} the {slot} traversal on route '{route}': train it elsewhere",
                trained.what,
                traversal.id.short()
            )
        };
        if traversal.record.route == judged.route {
            return Ok(Some(of(format!("was driven on the same route '{}' as", traversal.record.route))));
        }
        let shared = traversal.frames.iter().filter(|frame| judged_images.contains(&frame.left)).count();
        if shared > 0 {
            return Ok(Some(of(format!("shares {shared} images with"))));
        }
        if traversal.record.recording == judged.recording {
            return Ok(Some(of("is cut from the same recording as".to_owned())));
        }
        let truths = (GroundTruth::of(objects, &traversal.record)?, GroundTruth::of(objects, judged)?);
        if let (Some(trained), Some(judged)) = truths
            && trained.frame == judged.frame
        {
            let near = near(&trained.in_frame_of(&judged), &judged);
            if near > 0 {
                return Ok(Some(of(format!("has {near} true positions within {NEAR_M} m of"))));
            }
        }
    }
    Ok(None)
}

/// Positions of `a` within [`NEAR_M`] of some position of `b`, found by a grid of that width.
fn near(a: &GroundTruth, b: &GroundTruth) -> usize {
    let cell = |value: f64| (value / NEAR_M).floor() as i64;
    let mut places: std::collections::BTreeMap<(i64, i64), Vec<(f64, f64)>> = std::collections::BTreeMap::new();
    for pose in b.poses() {
        places.entry((cell(pose.east_m), cell(pose.north_m))).or_default().push((pose.east_m, pose.north_m));
    }
    let is_near = |east: f64, north: f64| {
        let (x, y) = (cell(east), cell(north));
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
        around.filter_map(|key| places.get(&key)).flatten().any(|(e, n)| {
            let (de, dn) = (e - east, n - north);
            de * de + dn * dn <= NEAR_M * NEAR_M
        })
    };
    a.poses().iter().filter(|pose| is_near(pose.east_m, pose.north_m)).count()
}
