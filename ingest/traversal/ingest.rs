//! The story of an ingest.

use crate::traversal::beside;
use crate::traversal::doubt::check_odometry;
use crate::traversal::error::IngestError;
use crate::traversal::experience::experience_of;
use crate::traversal::identity::Identity;
use crate::traversal::known::{known_by_bytes, known_by_frames, other_purposes};
use crate::traversal::notes::Notes;
use crate::traversal::parts::Parts;
use crate::traversal::progress::IngestProgress;
use crate::traversal::request::IngestRequest;
use crate::traversal::rig::checked;
use crate::traversal::source::open_source;
use crate::traversal::stamp_checks::check_offset;
use crate::traversal::stored_request::keep_request;
use crate::traversal::stream::FrameStream;
use crate::traversal::summary::IngestSummary;
use crate::traversal::truth::GivenTruth;
use furrow_catalog::Catalog;
use furrow_catalog::records::{DuplicatesRecord, TraversalCounts, TraversalRecord, encode, record_id};
use furrow_catalog::tables::{chain_to_parquet, frames_to_parquet};
use furrow_catalog::views::Views;
use furrow_model::{ExperienceId, KeyframePolicy, Purpose, TraversalId};

/// Ingests a recording. The same request on the same bytes is answered from the catalogue.
///
/// Reads on the calling thread and computes on rayon's global pool. Do not call it from that pool's own threads: a
/// reader that waits there for the stages would keep them from running.
///
/// # Errors
/// [`IngestError`] names the file and what is wrong with it. The store then is as it was.
pub fn ingest(
    catalog: &Catalog,
    request: &IngestRequest,
    progress: &mut dyn FnMut(IngestProgress),
) -> Result<IngestSummary, IngestError> {
    let request = &request.naming_folders();
    let parts = Parts::open(request)?;
    let request = &parts.in_order(request);
    let truth = GivenTruth::of_request(request)?;
    let identity = Identity::of(request, truth.as_ref().map(GivenTruth::digest), progress)?;
    let known = match catalog.traversal_of_request(identity.request)? {
        None => known_by_bytes(catalog, request, identity.recording.id)?,
        known => known,
    };
    if let Some(known) = known {
        return IngestSummary::known(catalog, known, request, truth.as_ref());
    }
    if !request.insist_on_parts {
        parts.check()?;
    }
    let staging = catalog.begin_ingest()?;
    let given = request.motion.read_given()?;
    let notes = Notes::default();
    let source = open_source(request, &notes)?;
    if given.is_none() && source.right_name().is_none() {
        return Err(IngestError::NoOdometry { path: source.path().to_owned() });
    }
    let views = Views::new(checked(source.calibrate(request, &notes)?, &notes)?)?;
    if let Some(truth) = &truth {
        truth.check_source(&*source)?;
    }

    let stream = FrameStream::run(&*source, request, given.as_ref(), &views, &staging, &notes, progress)?;
    if let Some(offset) = stream.offset.filter(|_| source.has_one_recorder()) {
        check_offset(request, source.path(), offset, &notes)?;
    }
    check_odometry(request, &*source, &stream, &notes)?;
    if let Some(truth) = &truth {
        let stamps_ns: Vec<i64> = stream.frames.iter().map(|frame| frame.stamp_ns).collect();
        let said = [truth.check_frames(&stamps_ns)?, truth.check_way(&stamps_ns, stream.chain.length_m())];
        said.into_iter().flatten().for_each(|note| notes.add(note));
    }
    let calibration = staging.write(&encode(views.record())?)?;
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
        ground_truth: truth.as_ref().map(|truth| staging.write(truth.bytes())).transpose()?,
    };
    if let Some(known) = known_by_frames(catalog, request, &traversal)? {
        return IngestSummary::known(catalog, known, request, truth.as_ref());
    }
    other_purposes(catalog, request, &traversal)?.into_iter().for_each(|note| notes.add(note));
    let experience = (request.purpose == Purpose::Experience)
        .then(|| experience_of(&traversal, &stream.frames, &stream.chain, keyframes));
    traversal.experience = experience.as_ref().map(record_id).transpose()?.map(|id| ExperienceId(id.0));

    identity.keep_recording(catalog, &staging)?;
    let id = TraversalId(record_id(&traversal)?.0);
    keep_request(catalog, request, id)?;
    beside::keep(catalog, id, &notes.into_record())?;
    beside::keep(catalog, id, &DuplicatesRecord { images: stream.duplicates })?;
    beside::keep(catalog, id, &stream.unreadable)?;
    let id =
        catalog.enter_traversal(&staging, &identity.recording, experience.as_ref(), &traversal, identity.request)?;
    IngestSummary::of(catalog, id, false)
}
