//! The track of a traversal: by its ground truth where it has one, else in the frame of its odometry.

use super::error::BrowseError;
use super::store::Store;
use crate::wording;
use furrow_catalog::records::TraversalRecord;
use furrow_model::trajectory::ChainPose;

/// The frame that positions stand in.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Ground {
    /// East and north; where that is known from, and whether positions are relative to the traversal's first fix.
    Truth { source: String, relative: bool },
    /// To the right and ahead of the first view.
    Odometry,
}

/// Positions of a traversal's frames, metres.
pub(super) struct Track {
    pub ground: Ground,
    pub points: Vec<Option<[f64; 2]>>,
}

impl Track {
    /// The track of a traversal; relative positions in the frame of another one where one is given.
    pub fn of(
        store: &Store,
        record: &TraversalRecord,
        frame_of: Option<&TraversalRecord>,
    ) -> Result<Self, BrowseError> {
        let frames = store.frames(record)?;
        let stamps: Vec<i64> = frames.iter().map(|frame| frame.stamp_ns).collect();
        let truth = store.insight.true_track(store.objects(), record, frame_of, &stamps)?;
        // Two positions make a track.
        if let Some(truth) = truth.filter(|truth| truth.positions.iter().flatten().count() > 1) {
            let ground = Ground::Truth { source: wording::shown(&truth.source), relative: truth.relative };
            return Ok(Self { ground, points: truth.positions });
        }
        let poses = store.chain(record.chain)?.poses();
        let above = |pose: &ChainPose| {
            let [right, _, ahead] = pose.start_from_here.translation_m;
            Some([right, ahead])
        };
        Ok(Self { ground: Ground::Odometry, points: poses.iter().map(above).collect() })
    }

    /// The caption of a map of it.
    pub fn caption(&self) -> String {
        match &self.ground {
            Ground::Truth { source, .. } => format!("North is up. Positions: {source}."),
            Ground::Odometry => {
                "No ground truth: positions are those of odometry. The track starts at the origin with \
                its first view pointing up; north is not known."
                    .to_owned()
            }
        }
    }

    pub fn is_true(&self) -> bool {
        matches!(self.ground, Ground::Truth { .. })
    }
}
