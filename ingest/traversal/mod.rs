//! One outing into the store: recording → stereo pairs, or a single camera's images → rectified views → odometry, or given motion → recorded
//! experience, as one transaction.

mod again;
mod error;
mod experience;
mod identity;
mod motion;
mod request;
mod sensors;
mod source;
mod stream;
mod summary;

pub use error::IngestError;
pub use experience::experience_of;
pub use motion::MotionSource;
pub use request::{FrameSelection, IngestRequest};
pub use summary::{IngestSummary, TrajectorySummary, UnpairedFrame};

use crate::traversal::identity::Identity;
use crate::traversal::source::Source;
use crate::traversal::stream::FrameStream;
use furrow_catalog::Catalog;
use furrow_catalog::records::{TraversalCounts, TraversalRecord, encode, record_id};
use furrow_catalog::tables::{chain_to_parquet, frames_to_parquet};
use furrow_catalog::views::Views;
use furrow_model::{ExperienceId, KeyframePolicy, Purpose, TraversalId};

/// How far an ingest has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IngestProgress {
    /// What is being done.
    pub stage: &'static str,
    /// Bytes behind.
    pub bytes: u64,
    /// Bytes in all.
    pub bytes_total: u64,
    /// Stereo pairs through odometry.
    pub frames: u64,
}

/// Ingests a recording. The same request on the same bytes is answered from the catalogue.
///
/// Reads on the calling thread and computes on rayon's global pool. Not to be called from that pool's own threads: a reader that waits
/// there for the stages would keep them from running.
///
/// # Errors
/// [`IngestError`] naming the file and what is wrong with it; the store then is as it was.
pub fn ingest(
    catalog: &Catalog,
    request: &IngestRequest,
    progress: &mut dyn FnMut(IngestProgress),
) -> Result<IngestSummary, IngestError> {
    let identity = Identity::of(request, progress)?;
    if let Some(known) = catalog.traversal_of_request(identity.request)? {
        return IngestSummary::of(catalog, known, true);
    }
    let staging = catalog.begin()?;
    let given = request.motion.given()?;
    let source = Source::open(request)?;
    if given.is_none() && source.right_name().is_none() {
        return Err(IngestError::NoOdometry { path: source.path.clone() });
    }
    let views = Views::new(source.views(request)?)?;

    let stream = FrameStream::run(&source, request.selection, given.as_ref(), &views, &staging, progress)?;
    let calibration = staging.write(&encode(views.record()))?;
    let frames = staging.write(&frames_to_parquet(&stream.frames)?)?;
    let chain = staging.write(&chain_to_parquet(&stream.chain)?)?;
    let keyframes = KeyframePolicy::THESIS;

    let mut traversal = TraversalRecord {
        recording: identity.recording.id,
        site: request.site.clone(),
        route: request.route.clone(),
        slot: request.slot,
        purpose: request.purpose,
        selection: request.selection.to_string(),
        left_source: source.left_name(),
        right_source: source.right_name(),
        rig: views.rig(),
        calibration,
        frames,
        chain,
        odometry: request.motion.version(),
        keyframes,
        experience: None,
        counts: TraversalCounts {
            pairs: stream.pairs,
            frames: stream.frames.len() as u32,
            dropped: stream.dropped,
            out_of_order: stream.out_of_order,
            length_m: stream.chain.length_m(),
            failed_steps: stream.chain.failed_steps() as u32,
            keyframes: keyframes.keyframes(&stream.chain).len() as u32,
        },
        unpaired: stream.unpaired,
        sensors: stream.sensors,
        ground_truth: request.ground_truth_bytes()?.map(|bytes| staging.write(&bytes)).transpose()?,
    };
    let experience = (request.purpose == Purpose::Experience)
        .then(|| experience_of(&traversal, &stream.frames, &stream.chain, keyframes));
    traversal.experience = experience.as_ref().map(|experience| ExperienceId(record_id(experience).0));

    identity.keep_recording(catalog, &staging)?;
    again::remember(catalog, request, TraversalId(record_id(&traversal).0))?;
    let id = catalog.enter_outing(&staging, &identity.recording, experience.as_ref(), &traversal, identity.request)?;
    IngestSummary::of(catalog, id, false)
}

/// The odometry and its version, part of every request's identity: a better one makes new versions.
pub(crate) fn odometry_version() -> String {
    format!("{ODOMETRY}{}.{CHAIN}", furrow_odometry::ALGORITHM_VERSION)
}

/// What a chain's table holds: since 1, every step's covariance.
const CHAIN: u32 = 1;

const ODOMETRY: &str = "stereo-odometry/";

/// What the distances along a traversal's chain come from, in words.
pub fn distance_source(traversal: &TraversalRecord) -> String {
    let motion = &traversal.odometry;
    if motion.starts_with(ODOMETRY) {
        "odometry chain of the live pass".to_owned()
    } else {
        format!("{motion} of the live pass")
    }
}
