//! Live frames beside the places they were matched to (thesis Figs 3.6, 3.7, 7.19 to 7.30; X3).

use crate::events::{self, FrameRow};
use crate::input::{CellInput, ReportError, Tile, TileCaption};
use crate::scale::rounded;
use crate::{jpeg, wording};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use furrow_model::outcome::event;
use furrow_model::{ExperienceId, ObjectId, Outcome};
use polars::prelude::DataFrame;
use serde::Serialize;

const WRONG_AT_MOST: usize = 12;
const HEIGHT: f64 = 200.0;
const GAP: f64 = 6.0;

/// A frame that a gallery should show, and the pictures to load for it.
#[derive(Debug, Clone, PartialEq)]
pub struct TileChoice {
    /// Ready for [`Tile::caption`].
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

/// One cell's tiles.
#[derive(Serialize)]
pub(crate) struct Album {
    cell: String,
    live: String,
    experience: String,
    tiles: Vec<TileView>,
    open: bool,
    wrong: usize,
}

#[derive(Serialize)]
struct TileView {
    id: String,
    width: f64,
    height: f64,
    live: PictureView,
    matched: Option<PictureView>,
    /// One path: a line from each live point to its partner.
    lines: String,
    line_count: usize,
    verdict: &'static str,
    verdict_text: &'static str,
    experience: String,
    travelled: String,
    stamp: String,
    inliers: Option<u32>,
    threshold: u32,
    error: Option<String>,
}

#[derive(Serialize)]
struct PictureView {
    x: f64,
    width: f64,
    uri: String,
}

/// The albums of all cells that have tiles: wrong ones first in each, and open where there is something wrong to see.
pub(crate) fn albums(cells: &[&CellInput]) -> Result<Vec<Album>, ReportError> {
    let with_tiles = cells.iter().filter(|cell| !cell.tiles.is_empty());
    let mut albums = with_tiles.map(|cell| album(cell)).collect::<Result<Vec<_>, _>>()?;
    if let Some(first) = albums.first_mut() {
        first.open = true;
    }
    Ok(albums)
}

fn album(cell: &CellInput) -> Result<Album, ReportError> {
    let key = cell.outcome.key.short();
    let mut tiles: Vec<&Tile> = cell.tiles.iter().collect();
    tiles.sort_by_key(|tile| order(&tile.caption));
    let view = |(i, tile): (usize, &&Tile)| tile_view(cell, tile, format!("tile-{key}-{i}"));
    let wrong = tiles.iter().filter(|tile| order(&tile.caption) == 0).count();
    let tiles = tiles.iter().enumerate().map(view).collect::<Result<Vec<_>, _>>()?;
    let (live, experience) = (cell.outcome.live.to_string(), wording::shown(&cell.outcome.experience));
    Ok(Album { cell: key, live, experience, tiles, open: wrong > 0, wrong })
}

fn order(caption: &TileCaption) -> u8 {
    match (caption.decision.as_str(), caption.correct) {
        (event::ACCEPTED, Some(false)) => 0,
        (event::ACCEPTED, _) => 1,
        (event::REJECTED, _) => 2,
        _ => 3,
    }
}

fn tile_view(cell: &CellInput, tile: &Tile, id: String) -> Result<TileView, ReportError> {
    let caption = &tile.caption;
    let picture = |jpeg: &[u8], which: &'static str, x: f64| {
        let no_picture = || ReportError::Picture {
            cell: cell.outcome.key,
            live_stamp_ns: caption.live_stamp_ns,
            which,
            bytes: jpeg.len(),
        };
        let (width, height) = jpeg::size(jpeg).ok_or_else(no_picture)?;
        let width = rounded(HEIGHT * f64::from(width) / f64::from(height));
        Ok::<_, ReportError>(PictureView { x, width, uri: format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)) })
    };
    let live = picture(&tile.live_jpeg, "live", 0.0)?;
    let matched = tile.match_jpeg.as_deref().map(|jpeg| picture(jpeg, "matched", live.width + GAP)).transpose()?;
    let lines: String =
        matched.iter().flat_map(|matched| tile.inlier_lines.iter().map(|line| drawn(line, &live, matched))).collect();
    let (verdict, verdict_text) = match (order(caption), caption.correct) {
        (0, _) => ("wrong", "accepted, but the wrong place"),
        (1, Some(true)) => ("right", "accepted, the right place"),
        (1, _) => ("accepted", "accepted"),
        (2, Some(true)) => ("rejected", "rejected, though the right place"),
        (2, Some(false)) => ("rejected", "rejected, the wrong place"),
        (2, None) => ("rejected", "rejected"),
        _ if caption.decision == event::NEW_PLACE => ("rejected", "taken for a new place"),
        _ => ("rejected", "not chosen"),
    };
    Ok(TileView {
        width: rounded(matched.as_ref().map_or(2.0 * live.width + GAP, |matched| matched.x + matched.width)),
        height: HEIGHT,
        line_count: if matched.is_some() { tile.inlier_lines.len() } else { 0 },
        lines,
        live,
        matched,
        id,
        verdict,
        verdict_text,
        experience: wording::shown(&caption.experience),
        travelled: wording::tenths(caption.travelled_m),
        stamp: caption.live_stamp_ns.to_string(),
        inliers: caption.inliers,
        threshold: caption.threshold_inliers,
        error: caption.error_m.map(wording::tenths),
    })
}

fn drawn(line: &([f32; 2], [f32; 2]), live: &PictureView, matched: &PictureView) -> String {
    let point = |[x, y]: [f32; 2], picture: &PictureView| {
        let x = picture.x + f64::from(x.clamp(0.0, 1.0)) * picture.width;
        format!("{} {}", rounded(x), rounded(f64::from(y.clamp(0.0, 1.0)) * HEIGHT))
    };
    format!("M{}L{}", point(line.0, live), point(line.1, matched))
}
