//! Images and inliers of a few live frames at a time.

use super::super::camera::{Camera, Picture};
use super::super::scene::Scene;
use crate::RunError;
use crate::stages::verifying::Verifier;
use foxglove::messages::Point2;
use furrow_catalog::Objects;
use furrow_model::ObjectId;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// What a live frame saw.
pub(super) struct Seen {
    pub live: Picture,
    /// The image of the place that is shown.
    pub matched: Option<Picture>,
    /// Inliers: in the live and in the matched image as stored.
    pub inliers: Vec<(Point2, Point2)>,
}

/// Looks at images. The features of nodes stay for the frames that follow, which mostly see the same ones.
pub(super) struct Eyes<'a, V: Verifier> {
    verifier: &'a V,
    objects: &'a Objects,
    scene: &'a Scene,
    camera: &'a Camera,
    nodes: BTreeMap<(usize, ObjectId), V::Node>,
}

impl<'a, V: Verifier> Eyes<'a, V> {
    pub fn new(verifier: &'a V, objects: &'a Objects, scene: &'a Scene, camera: &'a Camera) -> Self {
        Self { verifier, objects, scene, camera, nodes: BTreeMap::new() }
    }

    /// What these frames saw, in order.
    pub fn look(&mut self, frames: Range<usize>) -> Result<Vec<Seen>, RunError> {
        self.know(frames.clone())?;
        frames.into_par_iter().map(|frame| self.seen(frame)).collect()
    }

    /// The place that is shown beside a frame: member and image.
    fn shown(&self, frame: usize) -> Option<(usize, ObjectId)> {
        let best = self.scene.answers[frame].best()?;
        best.node.map(|(_, image)| (best.member, image))
    }

    /// Prepares the nodes that these frames are shown beside, and forgets all others.
    fn know(&mut self, frames: Range<usize>) -> Result<(), RunError> {
        let mut wanted: Vec<(usize, ObjectId)> = frames.filter_map(|frame| self.shown(frame)).collect();
        wanted.sort_unstable();
        wanted.dedup();
        self.nodes.retain(|node, _| wanted.binary_search(node).is_ok());
        wanted.retain(|node| !self.nodes.contains_key(node));
        let fresh = wanted.into_par_iter().map(|(member, image)| {
            let views = self.scene.members[member].camera.views();
            Ok(((member, image), self.verifier.node(self.objects, views, image)?))
        });
        let fresh = fresh.collect::<Result<Vec<_>, RunError>>()?;
        self.nodes.extend(fresh);
        Ok(())
    }

    fn seen(&self, frame: usize) -> Result<Seen, RunError> {
        let stored = &self.scene.live.frames[frame];
        let live = self.camera.picture(self.objects, stored.left)?;
        let Some(place) = self.shown(frame) else { return Ok(Seen { live, matched: None, inliers: Vec::new() }) };
        let (other, node) = (&self.scene.members[place.0].camera, &self.nodes[&place]);
        let prepared = self.verifier.live(self.objects, self.camera.views(), stored)?;
        let inliers = self.verifier.agree(&prepared, node).correspondences;
        let inliers = inliers
            .iter()
            .filter_map(|inlier| Some((self.camera.point(inlier.live_px)?, other.point(inlier.candidate_px)?)));
        Ok(Seen { live, matched: Some(other.picture(self.objects, place.1)?), inliers: inliers.collect() })
    }
}
