//! Live and matched views with their inliers, for pages.

use crate::RunError;
use crate::verifying::{AnyVerifier, Verifier};
use furrow_catalog::images::{Picture, Side, encode_jpeg};
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects, Views};
use furrow_ingest::odometry::Correspondence;
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

/// Columns of a view on a page.
const WIDTH: usize = 480;
const QUALITY: u8 = 82;

/// The views of a live frame and the node that answered it.
///
/// # Errors
/// Where an image or record cannot be read.
pub fn picture_pair(
    catalog: &Catalog,
    outcome: &Outcome,
    live_stamp_ns: i64,
    matched: Option<(ExperienceId, ObjectId)>,
) -> Result<PicturePair, RunError> {
    let objects = catalog.objects();
    let traversal = catalog.traversal(outcome.live_traversal)?;
    let views = Views::load(objects, traversal.calibration)?;
    let frames = tables::frames_from_parquet(objects.read(traversal.frames)?)?;
    let frame = frames.iter().find(|frame| frame.stamp_ns == live_stamp_ns);
    let frame = frame.ok_or_else(|| RunError::Plan(format!("no live frame is stamped {live_stamp_ns} ns")))?;
    let jpeg = |views: &Views, image: ObjectId| -> Result<Vec<u8>, RunError> {
        let colour = views.colour_of(objects, Side::Left, image)?;
        let wrong = |reason: furrow_catalog::images::ImageError| RunError::Image { image, reason: reason.to_string() };
        encode_jpeg(Picture::Colour(&colour), WIDTH, QUALITY).map_err(wrong)
    };
    let live = jpeg(&views, frame.left)?;
    let Some((experience, node)) = matched else { return Ok(PicturePair { live, matched: None, lines: Vec::new() }) };
    let node_views = Views::load(objects, catalog.experience(experience)?.calibration)?;
    let features = FeatureParameters { hessian: outcome.hessian, upright: outcome.upright };
    let correspondences = match AnyVerifier::of(&traversal.rig, features) {
        AnyVerifier::Three(verifier) => agreeing(&verifier, objects, (&views, frame), (&node_views, node)),
        AnyVerifier::Two(verifier) => agreeing(&verifier, objects, (&views, frame), (&node_views, node)),
    }?;
    let fraction =
        |[u, v]: [f64; 2]| [(u / f64::from(traversal.rig.width)) as f32, (v / f64::from(traversal.rig.height)) as f32];
    let lines = correspondences.iter().map(|c| (fraction(c.live_px), fraction(c.candidate_px))).collect();
    Ok(PicturePair { live, matched: Some(jpeg(&node_views, node)?), lines })
}

fn agreeing<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    (views, frame): (&Views, &Frame),
    (node_views, node): (&Views, ObjectId),
) -> Result<Vec<Correspondence>, RunError> {
    let live = verifier.live(objects, views, frame)?;
    Ok(verifier.agree(&live, &verifier.node(objects, node_views, node)?).correspondences)
}
