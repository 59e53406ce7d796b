//! The two ways to verify: three views where the live camera is a pair, two where it is single.

use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::key::{THRESHOLD, TWO_VIEW, VERIFICATION, key_of};
use crate::inputs::traversals::LiveTraversal;
use crate::stages::codebook::{left_view, surf_params};
use furrow_catalog::images::{ImageError, Side};
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::tables::Frame;
use furrow_catalog::{CatalogError, Objects, Views};
use furrow_ingest::odometry::{
    ALGORITHM_VERSION, Correspondence, FrameFeatures, StereoFrame, TwoViewMatch, TwoViewParams, VerifyParams, verify,
    verify_two_view,
};
use furrow_localiser::surf::{Features, MatchParams, SurfParams, mutual_best, surf};
use furrow_model::{GreyImage, ObjectId, StereoRig};

/// A traversal that a threshold is calibrated on: its frames, chain and calibration.
pub(crate) type CalibrationInput = (ObjectId, ObjectId, ObjectId);

/// The name of what was found.
type Key = Result<ObjectId, CatalogError>;

/// What a live frame and a node have in common.
pub(crate) struct Agreement {
    pub matches: u32,
    pub inliers: u32,
    /// The inliers, for drawing.
    pub correspondences: Vec<Correspondence>,
}

/// A way to verify.
pub(crate) trait Verifier: Sync {
    /// A live frame, prepared once for all its candidates.
    type Live: Send + Sync;
    /// A candidate.
    type Node: Send + Sync;
    fn live(&self, objects: &Objects, views: &Views, frame: &Frame) -> Result<Self::Live, RunError>;
    fn node(&self, objects: &Objects, views: &Views, left: ObjectId) -> Result<Self::Node, RunError>;
    fn agree(&self, live: &Self::Live, node: &Self::Node) -> Agreement;
    /// The name of the counts of an experience's candidates.
    fn key(&self, live: &LiveTraversal, contender: &Contender, matches: ObjectId, candidates: u32) -> Key;
    /// The name of a threshold that was calibrated from `inputs`, so many frames and pairs of them, places so many
    /// metres apart.
    fn threshold_key(&self, inputs: &[CalibrationInput], apart_m: f64, pairs: usize, frames: usize) -> Key;
    /// Whether a traversal shows what this way needs.
    fn can_use(&self, rig: &StereoRig) -> bool;
}

/// Live left and right images against a node's left one.
pub(crate) struct ThreeViews {
    rig: StereoRig,
    params: VerifyParams,
}

/// Live images against nodes of a single camera, by the keypoints that words are made of.
pub(crate) struct TwoViews {
    features: FeatureParameters,
    surf: SurfParams,
    matching: MatchParams,
    params: TwoViewParams,
}

/// What is done with the way to verify, whichever it is.
pub(crate) trait Visitor {
    type Output;
    fn visit(self, verifier: &impl Verifier) -> Self::Output;
}

/// Lowe's (2004): nine of ten wrong matches are refused by it.
const RATIO: f32 = 0.8;

/// Chooses the way for live frames of `rig`; `features` say how keypoints are found where there is one camera.
pub(crate) fn visit<W: Visitor>(rig: &StereoRig, features: FeatureParameters, visitor: W) -> W::Output {
    match rig.is_pair() {
        true => visitor.visit(&ThreeViews::of(*rig)),
        false => visitor.visit(&TwoViews::of(rig, features)),
    }
}

impl TwoViews {
    /// For live frames of `rig`.
    fn of(rig: &StereoRig, features: FeatureParameters) -> Self {
        let params = VerifyParams::default();
        // Places are searched as far around as with three views.
        let matching = MatchParams {
            ratio: RATIO,
            columns_px: (params.search_columns * f64::from(rig.width)) as f32,
            rows_px: (params.search_rows * f64::from(rig.height)) as f32,
        };
        Self { features, surf: surf_params(features), matching, params: TwoViewParams::default() }
    }
}

impl ThreeViews {
    /// For live frames of `rig`.
    pub fn of(rig: StereoRig) -> Self {
        Self { rig, params: VerifyParams::default() }
    }

    /// A rectified live pair.
    pub fn pair(&self, left: &GreyImage, right: &GreyImage) -> StereoFrame {
        let features = |image| FrameFeatures::extract(image, &self.params.matcher);
        let (left, right) = rayon::join(|| features(left), || features(right));
        StereoFrame::new(left, right, &self.rig, &self.params.stereo)
    }
}

impl Verifier for ThreeViews {
    type Live = StereoFrame;
    type Node = FrameFeatures;

    fn live(&self, objects: &Objects, views: &Views, frame: &Frame) -> Result<StereoFrame, RunError> {
        let single = || RunError::Image { image: frame.left, reason: ImageError::SingleCamera.to_string() };
        let right = frame.right.ok_or_else(single)?;
        let left = left_view(objects, views, frame.left)?;
        Ok(self.pair(&left, &views.grey_of(objects, Side::Right, right.image)?))
    }

    fn node(&self, objects: &Objects, views: &Views, left: ObjectId) -> Result<FrameFeatures, RunError> {
        Ok(FrameFeatures::extract(&left_view(objects, views, left)?, &self.params.matcher))
    }

    fn agree(&self, live: &StereoFrame, node: &FrameFeatures) -> Agreement {
        let found = verify(live, node, &self.rig, &self.params);
        let (matches, inliers) = (found.matches as u32, found.inliers as u32);
        Agreement { matches, inliers, correspondences: found.correspondences }
    }

    fn key(&self, live: &LiveTraversal, contender: &Contender, matches: ObjectId, candidates: u32) -> Key {
        let (frames, calibration) = (live.record.frames, live.record.calibration);
        let inputs = (ALGORITHM_VERSION, frames, calibration, contender.id, matches, candidates, &self.params);
        key_of(VERIFICATION, &inputs)
    }

    fn threshold_key(&self, inputs: &[CalibrationInput], apart_m: f64, pairs: usize, frames: usize) -> Key {
        key_of(THRESHOLD, &(ALGORITHM_VERSION, inputs, apart_m, pairs, frames, &self.params))
    }

    fn can_use(&self, rig: &StereoRig) -> bool {
        rig.is_pair()
    }
}

impl Verifier for TwoViews {
    type Live = Features;
    type Node = Features;

    fn live(&self, objects: &Objects, views: &Views, frame: &Frame) -> Result<Features, RunError> {
        self.node(objects, views, frame.left)
    }

    fn node(&self, objects: &Objects, views: &Views, left: ObjectId) -> Result<Features, RunError> {
        Ok(surf(&left_view(objects, views, left)?, &self.surf))
    }

    fn agree(&self, live: &Features, node: &Features) -> Agreement {
        let place = |features: &Features, i: usize| {
            let keypoint = &features.keypoints[i];
            [f64::from(keypoint.x_px), f64::from(keypoint.y_px)]
        };
        let matches: Vec<TwoViewMatch> = (mutual_best(live, node, &self.matching).iter())
            .map(|m| TwoViewMatch {
                at: Correspondence { live_px: place(live, m.a), candidate_px: place(node, m.b) },
                distance: m.distance,
            })
            .collect();
        let found = verify_two_view(&matches, &self.params);
        let (matches, inliers) = (found.matches as u32, found.inliers as u32);
        Agreement { matches, inliers, correspondences: found.correspondences }
    }

    fn key(&self, live: &LiveTraversal, contender: &Contender, matches: ObjectId, candidates: u32) -> Key {
        let (frames, calibration) = (live.record.frames, live.record.calibration);
        let params = (self.features, self.matching, &self.params);
        key_of(TWO_VIEW, &(ALGORITHM_VERSION, frames, calibration, contender.id, matches, candidates, params))
    }

    fn threshold_key(&self, inputs: &[CalibrationInput], apart_m: f64, pairs: usize, frames: usize) -> Key {
        let params = (self.features, self.matching, &self.params);
        key_of(THRESHOLD, &(TWO_VIEW, ALGORITHM_VERSION, inputs, apart_m, pairs, frames, params))
    }

    fn can_use(&self, _: &StereoRig) -> bool {
        true
    }
}
