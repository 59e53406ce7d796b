//! Which frames a gallery shows.

use crate::error::ReportError;
use crate::figures::events::{EventRow, Events};
use crate::input::TileCaption;
use furrow_model::{ExperienceId, ObjectId, Outcome};
use polars::prelude::DataFrame;

const WRONG_AT_MOST: usize = 12;

/// A frame that a gallery should show, and the images to load for it.
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

/// Picks a cell's frames for the gallery: accepted but wrong ones first (twelve at most), then `accepted` others that
/// were accepted and `rejected` that were not, each spread evenly along the route.
///
/// # Errors
/// [`ReportError::Events`] or [`ReportError::EventId`] where the table is not one of events.
pub fn choose_tiles(
    outcome: &Outcome,
    events: &DataFrame,
    accepted: usize,
    rejected: usize,
) -> Result<Vec<TileChoice>, ReportError> {
    let events = read(outcome, events)?;
    let (yes, mut no): (Vec<EventRow<'_>>, Vec<EventRow<'_>>) = events.judged().partition(EventRow::is_accepted);
    let (wrong, right): (Vec<EventRow<'_>>, Vec<EventRow<'_>>) =
        yes.into_iter().partition(|row| row.correct == Some(false));
    no.dedup_by_key(|row| row.live_stamp_ns);
    let chosen = spread(wrong, WRONG_AT_MOST).into_iter().chain(spread(right, accepted)).chain(spread(no, rejected));
    chosen.map(|row| choice(outcome, row)).collect()
}

/// A cell's frame at a stamp, to compare one live frame against every experience; none where it has no verified
/// candidate there.
///
/// # Errors
/// As for [`choose_tiles`].
pub fn choose_still(outcome: &Outcome, events: &DataFrame, stamp_ns: i64) -> Result<Option<TileChoice>, ReportError> {
    let events = read(outcome, events)?;
    let here = events.judged().filter(|row| row.live_stamp_ns == stamp_ns);
    here.max_by_key(EventRow::rank).map(|row| choice(outcome, row)).transpose()
}

fn read(outcome: &Outcome, events: &DataFrame) -> Result<Events, ReportError> {
    Events::read(events).map_err(|source| ReportError::Events { cell: outcome.key, source })
}

/// `wanted` of the rows, evenly spaced, from the middle of each equal part.
fn spread(rows: Vec<EventRow<'_>>, wanted: usize) -> Vec<EventRow<'_>> {
    if rows.len() <= wanted {
        return rows;
    }
    (0..wanted).map(|i| rows[(2 * i + 1) * rows.len() / (2 * wanted)]).collect()
}

fn choice(outcome: &Outcome, row: EventRow<'_>) -> Result<TileChoice, ReportError> {
    let bad_id = |source| ReportError::EventId { cell: outcome.key, source };
    let experience: ExperienceId = row.experience.parse().map_err(bad_id)?;
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
            decision: row.decision.to_owned(),
            correct: row.correct,
            error_m: row.error_m,
        },
        live_image: row.live_image.parse().map_err(bad_id)?,
        experience,
        node_stamp_ns: row.node_stamp_ns,
        node_image: row.node_image.map(str::parse).transpose().map_err(bad_id)?,
    })
}
