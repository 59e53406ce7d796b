//! Which frames a gallery shows.

use crate::events::{self, FrameRow};
use crate::input::{ReportError, TileCaption};
use furrow_model::outcome::event;
use furrow_model::{ExperienceId, ObjectId, Outcome};
use polars::prelude::DataFrame;

const WRONG_AT_MOST: usize = 12;

/// A frame that a gallery should show, and the pictures to load for it.
#[derive(Debug, Clone, PartialEq)]
pub struct TileChoice {
    /// Ready for [`Tile::caption`](crate::Tile::caption).
    pub caption: TileCaption,
    /// The live left image.
    pub live_image: ObjectId,
    /// The experience that answered.
    pub experience: ExperienceId,
    /// The candidate's stamp in that experience.
    pub node_stamp_ns: Option<i64>,
    /// The candidate's left image.
    pub node_image: Option<ObjectId>,
}

/// Picks a cell's frames for the gallery: accepted but wrong ones first (twelve at most), then `accepted` others that were accepted and
/// `rejected` that were not, each spread evenly along the route.
///
/// # Errors
/// [`ReportError::Events`] or [`ReportError::EventId`] where the table is not one of events.
pub fn choose_tiles(
    outcome: &Outcome,
    events: &DataFrame,
    accepted: usize,
    rejected: usize,
) -> Result<Vec<TileChoice>, ReportError> {
    let rows = events::judged(events).map_err(|source| ReportError::Events { cell: outcome.key, source })?;
    let (yes, no): (Vec<FrameRow>, Vec<FrameRow>) = rows.into_iter().partition(|row| row.decision == event::ACCEPTED);
    let (wrong, yes): (Vec<FrameRow>, Vec<FrameRow>) = yes.into_iter().partition(|row| row.correct == Some(false));
    let mut no = no;
    no.dedup_by_key(|row| row.live_stamp_ns);
    let chosen = spread(wrong, WRONG_AT_MOST).into_iter().chain(spread(yes, accepted)).chain(spread(no, rejected));
    chosen.map(|row| choice(outcome, row)).collect()
}

/// A cell's frame at a stamp, for setting one live frame against every experience; none where it has no verified candidate there.
///
/// # Errors
/// As for [`choose_tiles`].
pub fn choose_still(outcome: &Outcome, events: &DataFrame, stamp_ns: i64) -> Result<Option<TileChoice>, ReportError> {
    let rows = events::judged(events).map_err(|source| ReportError::Events { cell: outcome.key, source })?;
    let here = rows.into_iter().filter(|row| row.live_stamp_ns == stamp_ns);
    let best = here.max_by_key(|row| (row.decision == event::ACCEPTED, row.inliers));
    best.map(|row| choice(outcome, row)).transpose()
}

/// `wanted` of the rows, evenly spaced, from the middle of each equal part.
fn spread(rows: Vec<FrameRow>, wanted: usize) -> Vec<FrameRow> {
    if rows.len() <= wanted {
        return rows;
    }
    let keep: Vec<usize> = (0..wanted).map(|i| (2 * i + 1) * rows.len() / (2 * wanted)).collect();
    rows.into_iter().enumerate().filter(|(i, _)| keep.contains(i)).map(|(_, row)| row).collect()
}

fn choice(outcome: &Outcome, row: FrameRow) -> Result<TileChoice, ReportError> {
    let bad = |source| ReportError::EventId { cell: outcome.key, source };
    let experience: ExperienceId = row.experience.parse().map_err(bad)?;
    let member = outcome.members.iter().find(|member| member.id == experience);
    let label = match member {
        Some(member) if outcome.members.len() > 1 => format!("{} ({})", member.slot, outcome.experience),
        _ => outcome.experience.clone(),
    };
    Ok(TileChoice {
        caption: TileCaption {
            live_stamp_ns: row.live_stamp_ns,
            travelled_m: row.travelled_m,
            experience: label,
            inliers: row.inliers,
            threshold_inliers: outcome.threshold_inliers,
            decision: row.decision,
            correct: row.correct,
            error_m: row.error_m,
        },
        live_image: row.live_image.parse().map_err(bad)?,
        experience,
        node_stamp_ns: row.node_stamp_ns,
        node_image: row.node_image.map(|id| id.parse()).transpose().map_err(bad)?,
    })
}
