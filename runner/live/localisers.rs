//! Experiences made ready to be asked, frame by frame.

use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::recogniser::{Context, FrameByFrame, PlaceIndex};
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::ReadyCodebook;
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan};
use crate::progress::Progress;
use crate::stages::codebook::surf_params;
use crate::stages::conduct::Conduct;
use crate::stages::executor::Executor;
use crate::stages::graph::Step;
use crate::stages::shared::Shared;
use crate::stages::verifying::{ThreeViews, Verifier};
use furrow_catalog::images::{ImageError, Side};
use furrow_catalog::tables::Frame;
use furrow_catalog::{Catalog, Objects, Views};
use furrow_ingest::odometry::{FrameFeatures, StereoFrame};
use furrow_localiser::Presence;
use furrow_localiser::hub::{Candidate, PairAnswer};
use furrow_localiser::surf::{SurfParams, surf};
use furrow_model::{ExperienceId, Node, TimeSlot};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Nodes whose features an experience keeps at hand: a robot's next frames show the same place or its neighbours.
const KEPT_NODES: usize = 12;

/// A live pair, with all that every experience needs of it.
pub struct Seen {
    presence: Presence,
    pair: StereoFrame,
}

/// An experience and its index.
struct Localiser {
    label: String,
    slot: TimeSlot,
    id: ExperienceId,
    nodes: Vec<Node>,
    views: Views,
    places: Box<dyn PlaceIndex>,
    features: Mutex<VecDeque<(u32, Arc<FrameFeatures>)>>,
}

/// The experiences of a plan, ready to be asked about frames of one of its live traversals.
pub struct Localisers {
    objects: Objects,
    codebook: ReadyCodebook,
    surf: SurfParams,
    verifier: ThreeViews,
    views: Views,
    candidates: u32,
    threshold: u32,
    localisers: Vec<Localiser>,
}

impl Localisers {
    /// Makes the experiences of `plan` ready for its live traversal number `live`: codebook, threshold and words are
    /// found in the store, or computed and kept there.
    ///
    /// # Errors
    /// [`RunError`]: a plan without codebook, a recogniser other than FAB-MAP 2.0, an experience of another rig, or a
    /// store that cannot be read.
    pub fn prepare(catalog: &Catalog, plan: &Plan, live: LiveIx, progress: Progress<'_>) -> Result<Self, RunError> {
        let refused = |reason: &str| Err(RunError::Live(reason.to_owned()));
        let (Some(spec), Some(traversal)) = (&plan.codebook, plan.lives.get(live.0)) else {
            return refused(
                "live localisation needs a live traversal and a vocabulary traversal: `furrow plan` says what is missing",
            );
        };
        let recogniser = plan.recogniser.frame_by_frame().map_err(|reason| RunError::Live(reason.to_owned()))?;
        if !traversal.record.rig.is_pair() {
            return refused(
                "live localisation needs a stereo pair: of a single camera only whole traversals are verified",
            );
        }
        // Those that the plan lets this traversal be judged on, by themselves.
        let alone = |cell: &CellIx| plan.cell(*cell).live == live && plan.cell(*cell).members.len() == 1;
        let cells: Vec<CellIx> = CellIx::all(plan.cells.len()).filter(alone).collect();
        let numbers: Vec<ContenderIx> = cells.iter().map(|cell| plan.cell(*cell).members[0]).collect();
        let mut executor = Executor::new((catalog, plan, cells), Conduct::default(), progress)?;
        executor.walk(|step| matches!(step, Step::Codebook | Step::ContenderWords(_) | Step::Threshold(_)))?;
        let mut shared = executor.into_shared();
        if shared.codebook.is_none() {
            // Without such cells nothing needed it.
            shared.prepare_codebook()?;
        }
        let objects = catalog.objects();
        let threshold = shared.threshold(live)?;
        let localiser =
            |number: &ContenderIx| Localiser::new(&shared, shared.contender(*number), traversal, recogniser);
        let localisers = numbers.iter().map(localiser).collect::<Result<_, _>>()?;
        Ok(Self {
            surf: surf_params(spec.features),
            verifier: ThreeViews::of(traversal.record.rig),
            views: Views::load(objects, traversal.record.calibration)?,
            candidates: plan.matrix.localiser.candidates,
            objects: objects.clone(),
            codebook: shared.codebook.ok_or_else(|| RunError::Codebook("there is none".to_owned()))?,
            threshold,
            localisers,
        })
    }

    /// The experiences, by number: id, label and slot.
    pub fn experiences(&self) -> impl Iterator<Item = (ExperienceId, &str, TimeSlot)> {
        self.localisers.iter().map(|localiser| (localiser.id, localiser.label.as_str(), localiser.slot))
    }

    /// Inliers that a localisation must reach.
    pub fn threshold(&self) -> u32 {
        self.threshold
    }

    /// Sees a stored pair: its words, and its features with their depth.
    ///
    /// # Errors
    /// Where an image cannot be read.
    pub fn look_at(&self, frame: &Frame) -> Result<Seen, RunError> {
        let grey = |side, image| self.views.grey_of(&self.objects, side, image);
        let Some(right) = frame.right else {
            return Err(RunError::Image { image: frame.left, reason: ImageError::SingleCamera.to_string() });
        };
        let (left, right) = rayon::join(|| grey(Side::Left, frame.left), || grey(Side::Right, right.image));
        let (left, right) = (left?, right?);
        let presence = || self.codebook.codebook.vocabulary.presence(&surf(&left, &self.surf).descriptors);
        let (presence, pair) = rayon::join(presence, || self.verifier.pair(&left, &right));
        Ok(Seen { presence: presence.map_err(|error| RunError::Codebook(error.to_string()))?, pair })
    }

    /// What experience number `number` answers.
    ///
    /// # Errors
    /// Where a node's image cannot be read.
    pub fn answer(&self, number: usize, seen: &Seen) -> Result<PairAnswer, RunError> {
        let Some(localiser) = self.localisers.get(number) else { return Ok(PairAnswer::NewPlace) };
        let ranked = localiser.places.rank(&seen.presence, self.candidates as usize)?;
        if ranked.is_empty() {
            return Ok(PairAnswer::NewPlace);
        }
        let mut best: Option<Candidate> = None;
        for (node, log_likelihood) in ranked {
            let features = localiser.features_of(&self.objects, node as u32, &self.verifier)?;
            let inliers = self.verifier.agree(&seen.pair, &features).inliers;
            if best.is_none_or(|best| inliers > best.inliers) {
                let node_stamp_ns = localiser.nodes[node].stamp_ns;
                best = Some(Candidate { node_stamp_ns, log_likelihood, inliers });
            }
        }
        Ok(PairAnswer::of(best, self.threshold))
    }
}

impl Localiser {
    fn new(
        shared: &Shared<'_>,
        contender: &Contender,
        traversal: &LiveTraversal,
        recogniser: &dyn FrameByFrame,
    ) -> Result<Self, RunError> {
        let record = &contender.record;
        if record.rig != traversal.record.rig {
            return Err(RunError::Live(format!(
                "experience {} ({}) was recorded with another rig than the live traversal: verification needs the same",
                contender.id.short(),
                contender.label
            )));
        }
        Ok(Self {
            label: contender.label.clone(),
            slot: contender.slot,
            id: contender.id,
            nodes: record.nodes.clone(),
            views: Views::load(shared.catalog.objects(), record.calibration)?,
            places: recogniser.index(&shared.contender_words(contender)?, shared.codebook()?)?,
            features: Mutex::default(),
        })
    }

    /// The features of a node, from those at hand or from its image.
    fn features_of(&self, objects: &Objects, node: u32, verifier: &ThreeViews) -> Result<Arc<FrameFeatures>, RunError> {
        let at_hand = || self.features.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, features)) = at_hand().iter().find(|(kept, _)| *kept == node) {
            return Ok(Arc::clone(features));
        }
        let features = Arc::new(verifier.node(objects, &self.views, self.nodes[node as usize].left)?);
        let mut kept = at_hand();
        kept.push_back((node, Arc::clone(&features)));
        if kept.len() > KEPT_NODES {
            kept.pop_front();
        }
        Ok(features)
    }
}
