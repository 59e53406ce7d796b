//! What an ingest did, as `furrow ingest --json` prints it.

use crate::traversal::beside::{self, notes_of};
use crate::traversal::error::IngestError;
use crate::traversal::request::IngestRequest;
use crate::traversal::truth::GivenTruth;
use furrow_catalog::Catalog;
use furrow_catalog::records::{self, Cameras, DuplicatesRecord, UnreadableImage, UnreadableRecord, ViewsRecord};
use furrow_model::{ExperienceId, Purpose, RecordingId, TimeSlot, TraversalId, shown};
use serde::Serialize;
use std::fmt;

/// What an ingest did.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IngestSummary {
    /// The recording.
    pub recording: RecordingId,
    /// The name of the recording's file or folder when it first came.
    pub recording_name: String,
    /// The traversal.
    pub traversal: TraversalId,
    /// The experience; `None` for other purposes.
    pub experience: Option<ExperienceId>,
    /// `stereo` or `single`.
    pub camera: &'static str,
    /// Whether a single camera's calibration was assumed, not measured.
    pub calibration_assumed: bool,
    /// What the chain's steps come from: an odometry and its version, or what was given.
    pub motion: String,
    /// Stereo pairs, or a single camera's images, in the recording.
    pub pairs: u32,
    /// Frames without a partner; `side` is the one that is there.
    pub unpaired: Vec<UnpairedFrame>,
    /// Images that are left out because their side has an image with their stamp already.
    pub duplicates: u64,
    /// Images that could not be read; each cost its frame, and its partner is among the unpaired.
    pub unreadable: Vec<UnreadableImage>,
    /// Frames that are missing by the gaps between stamps.
    pub dropped: u32,
    /// The chain.
    pub trajectory: TrajectorySummary,
    /// Keyframes on the chain.
    pub keyframes: u32,
    /// What was unusual about the recording, a sentence each.
    pub notes: Vec<String>,
    /// Where, when and what for.
    pub label: Label,
    /// Whether these frames had been ingested before: nothing was added.
    pub known: bool,
    /// How a known traversal differs from what was asked, a sentence each with what to do.
    pub differs: Vec<String>,
}

/// What a traversal is known as.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Label {
    /// The site.
    pub site: String,
    /// The route.
    pub route: String,
    /// The time slot.
    pub slot: TimeSlot,
    /// The purpose.
    pub purpose: Purpose,
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "site {}, route {}, {}, {}", shown(&self.site), shown(&self.route), self.slot, self.purpose)
    }
}

/// A frame without a partner.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct UnpairedFrame {
    /// Its header stamp.
    pub stamp_ns: i64,
    /// The side that is there.
    pub side: String,
}

/// The chain in numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrajectorySummary {
    /// Frames on it.
    pub frames: u32,
    /// Its length in metres.
    pub length_m: f64,
    /// Steps where odometry failed.
    pub failed_steps: u32,
}

impl IngestSummary {
    /// Of a traversal in the catalogue.
    pub(crate) fn of(catalog: &Catalog, id: TraversalId, known: bool) -> Result<Self, IngestError> {
        let record = catalog.traversal(id)?;
        let counts = record.counts;
        let views: ViewsRecord = records::read(catalog.objects(), record.calibration)?;
        let unpaired =
            record.unpaired.iter().map(|frame| UnpairedFrame { stamp_ns: frame.stamp_ns, side: frame.side.clone() });
        let recording_name = catalog.recording(record.recording)?.map_or_else(String::new, |row| row.name);
        Ok(Self {
            recording: record.recording,
            recording_name,
            traversal: id,
            experience: record.experience,
            camera: if record.rig.is_pair() { "stereo" } else { "single" },
            calibration_assumed: matches!(views.calibration, Cameras::Single(single) if single.is_assumed),
            motion: record.odometry,
            pairs: counts.pairs,
            unpaired: unpaired.collect(),
            duplicates: beside::read::<DuplicatesRecord>(catalog, id)?.images,
            unreadable: beside::read::<UnreadableRecord>(catalog, id)?.images,
            dropped: counts.dropped,
            trajectory: TrajectorySummary {
                frames: counts.frames,
                length_m: counts.length_m,
                failed_steps: counts.failed_steps,
            },
            keyframes: counts.keyframes,
            notes: notes_of(catalog, id)?,
            label: Label { site: record.site, route: record.route, slot: record.slot, purpose: record.purpose },
            known,
            differs: Vec::new(),
        })
    }

    /// Of a traversal that the catalogue had before: with what was asked otherwise.
    pub(crate) fn known(
        catalog: &Catalog,
        id: TraversalId,
        request: &IngestRequest,
        truth: Option<&GivenTruth>,
    ) -> Result<Self, IngestError> {
        let mut summary = Self::of(catalog, id, true)?;
        let asked = Label {
            site: request.site.clone(),
            route: request.route.clone(),
            slot: request.slot,
            purpose: request.purpose,
        };
        if asked != summary.label {
            summary.differs.push(format!(
                "its label is {}, not {asked}: the same frames are not entered twice, and a store keeps the label that \
                 they first had; ingest them into another store, or other frames of the recording with --frames",
                summary.label
            ));
        }
        if let Some(truth) = truth
            && catalog.traversal(id)?.ground_truth != Some(truth.digest())
        {
            summary.differs.push(format!(
                "the true poses of {0} are not attached to it: `furrow attach-truth {1} '{0}'` does that",
                truth.path().display(),
                id.short()
            ));
        }
        Ok(summary)
    }
}
