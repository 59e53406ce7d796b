//! Live and matched views with their inliers, for pages.

use crate::RunError;
use crate::stages::codebook::{left_view, surf_params};
use crate::stages::verifying::{Agreement, Verifier, Visitor, visit};
use furrow_catalog::images::{Picture, Side, encode_jpeg};
use furrow_catalog::records::{FeatureParameters, TraversalRecord};
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects, Views};
use furrow_ingest::odometry::Correspondence;
use furrow_localiser::surf::detect;
use furrow_model::{ExperienceId, ObjectId, Outcome};

/// Two views side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct PicturePair {
    /// The live left view, JPEG.
    pub live: Vec<u8>,
    /// The matched node's view, JPEG.
    pub matched: Option<Vec<u8>>,
    /// Inliers: live and matched point, as fractions of width and height.
    pub lines: Vec<([f32; 2], [f32; 2])>,
}

const QUALITY: u8 = 82;

/// The views of a live frame and the node that answered it, `columns` wide.
///
/// # Errors
/// Where an image or record cannot be read.
pub fn picture_pair(
    catalog: &Catalog,
    outcome: &Outcome,
    live_stamp_ns: i64,
    matched: Option<(ExperienceId, ObjectId)>,
    columns: usize,
) -> Result<PicturePair, RunError> {
    let objects = catalog.objects();
    let traversal = catalog.traversal(outcome.live_traversal)?;
    let views = Views::load(objects, traversal.calibration)?;
    let frames = tables::frames_from_parquet(objects.read(traversal.frames)?)?;
    let frame = frames.iter().find(|frame| frame.stamp_ns == live_stamp_ns);
    let frame = frame.ok_or_else(|| RunError::Image {
        image: outcome.events,
        reason: format!("no live frame is stamped {live_stamp_ns} ns"),
    })?;
    let jpeg = |views: &Views, image: ObjectId| -> Result<Vec<u8>, RunError> {
        let colour = views.colour_of(objects, Side::Left, image)?;
        let wrong = |reason: furrow_catalog::images::ImageError| RunError::Image { image, reason: reason.to_string() };
        encode_jpeg(Picture::Colour(&colour), columns, QUALITY).map_err(wrong)
    };
    let live = jpeg(&views, frame.left)?;
    let Some((experience, node)) = matched else { return Ok(PicturePair { live, matched: None, lines: Vec::new() }) };
    let node_views = Views::load(objects, catalog.experience(experience)?.calibration)?;
    let features = FeatureParameters { hessian: outcome.hessian, upright: outcome.upright };
    let lines = agreement_of(objects, &traversal, features, (&views, frame), (&node_views, node))?.lines;
    Ok(PicturePair { live, matched: Some(jpeg(&node_views, node)?), lines })
}

/// What a frame and a place have in common, for drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Common {
    /// Matches that entered the motion fit.
    pub matches: u32,
    /// Inliers: the frame's and the place's point, as fractions of width and height.
    pub lines: Vec<([f32; 2], [f32; 2])>,
}

/// SURF as it is found where no outcome says otherwise.
const FEATURES: FeatureParameters = FeatureParameters { hessian: 400.0, upright: false };

/// What verification finds that a frame of a traversal and a place's left image, taken with the cameras of
/// `calibration`, have in common.
///
/// # Errors
/// Where an image or record cannot be read.
pub fn common(
    objects: &Objects,
    traversal: &TraversalRecord,
    frame: &Frame,
    (node, calibration): (ObjectId, ObjectId),
) -> Result<Common, RunError> {
    let (views, node_views) = (Views::load(objects, traversal.calibration)?, Views::load(objects, calibration)?);
    agreement_of(objects, traversal, FEATURES, (&views, frame), (&node_views, node))
}

/// The keypoints of a frame's left view: x, y and radius, as fractions of its width, height and width.
///
/// # Errors
/// Where the image cannot be read.
pub fn keypoints(objects: &Objects, traversal: &TraversalRecord, frame: &Frame) -> Result<Vec<[f32; 3]>, RunError> {
    let view = left_view(objects, &Views::load(objects, traversal.calibration)?, frame.left)?;
    let (width, height) = (view.width as f32, view.height as f32);
    let found = detect(&view, &surf_params(FEATURES));
    Ok(found.iter().map(|point| [point.x_px / width, point.y_px / height, point.size_px / 2.0 / width]).collect())
}

fn agreement_of(
    objects: &Objects,
    traversal: &TraversalRecord,
    features: FeatureParameters,
    live: (&Views, &Frame),
    node: (&Views, ObjectId),
) -> Result<Common, RunError> {
    let found = visit(&traversal.rig, features, Pair { objects, live, node })?;
    let fraction =
        |[u, v]: [f64; 2]| [(u / f64::from(traversal.rig.width)) as f32, (v / f64::from(traversal.rig.height)) as f32];
    let line = |c: &Correspondence| (fraction(c.live_px), fraction(c.candidate_px));
    Ok(Common { matches: found.matches, lines: found.correspondences.iter().map(line).collect() })
}

/// A live frame and a node, each with its cameras.
struct Pair<'a> {
    objects: &'a Objects,
    live: (&'a Views, &'a Frame),
    node: (&'a Views, ObjectId),
}

impl Visitor for Pair<'_> {
    type Output = Result<Agreement, RunError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        let Self { objects, live: (views, frame), node: (node_views, node) } = self;
        let live = verifier.live(objects, views, frame)?;
        Ok(verifier.agree(&live, &verifier.node(objects, node_views, node)?))
    }
}
