//! A live frame beside the node it was matched to, as `tile.svg` draws it (thesis Figs 3.6, 3.7, 7.19 to 7.30;
//! experiment X3).

use super::jpeg::Embedded;
use crate::chart::scale::rounded;
use crate::error::ReportError;
use crate::input::{CellInput, Tile, TileCaption};
use crate::wording;
use furrow_model::outcome::event;
use serde::Serialize;

const HEIGHT: f64 = 200.0;
const GAP: f64 = 6.0;

/// What became of the frame; in the order in which a gallery shows them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fate {
    AcceptedWrong,
    Accepted,
    Rejected,
    NotChosen,
}

impl Fate {
    pub fn of(caption: &TileCaption) -> Self {
        match (caption.decision.as_str(), caption.correct) {
            (event::ACCEPTED, Some(false)) => Self::AcceptedWrong,
            (event::ACCEPTED, _) => Self::Accepted,
            (event::REJECTED, _) => Self::Rejected,
            _ => Self::NotChosen,
        }
    }
}

#[derive(Serialize)]
pub(super) struct TileView {
    id: String,
    cell: String,
    width: f64,
    height: f64,
    live: Picture,
    matched: Option<Picture>,
    /// One path: a line from each live point to its partner.
    lines: String,
    line_count: usize,
    verdict: &'static str,
    verdict_text: &'static str,
    experience: String,
    pub travelled: String,
    stamp: String,
    inliers: Option<u32>,
    threshold: u32,
    error: Option<String>,
}

#[derive(Serialize)]
struct Picture {
    x: f64,
    width: f64,
    uri: String,
}

impl TileView {
    /// The tile of a cell; `id` is unique on the page.
    pub fn of(cell: &CellInput, tile: &Tile, id: String) -> Result<Self, ReportError> {
        let caption = &tile.caption;
        let picture = |jpeg: &[u8], which: &'static str, x: f64| {
            let (cell, live_stamp_ns, bytes) = (cell.outcome.key, caption.live_stamp_ns, jpeg.len());
            let embedded = Embedded::of(jpeg).ok_or(ReportError::Picture { cell, live_stamp_ns, which, bytes })?;
            let width = rounded(HEIGHT * f64::from(embedded.width) / f64::from(embedded.height));
            Ok::<_, ReportError>(Picture { x, width, uri: embedded.uri })
        };
        let live = picture(&tile.live_jpeg, "live", 0.0)?;
        let matched = tile.match_jpeg.as_deref().map(|jpeg| picture(jpeg, "matched", live.width + GAP)).transpose()?;
        let pairs = if matched.is_some() { tile.inlier_lines.as_slice() } else { &[] };
        let lines = matched.iter().flat_map(|matched| pairs.iter().map(|pair| line(pair, &live, matched))).collect();
        let (verdict, verdict_text) = verdict(caption);
        Ok(Self {
            width: rounded(matched.as_ref().map_or(2.0 * live.width + GAP, |matched| matched.x + matched.width)),
            height: HEIGHT,
            line_count: pairs.len(),
            lines,
            live,
            matched,
            id,
            cell: cell.outcome.key.short(),
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
}

/// The class of a tile's badge, and its words.
fn verdict(caption: &TileCaption) -> (&'static str, &'static str) {
    match (Fate::of(caption), caption.correct) {
        (Fate::AcceptedWrong, _) => ("wrong", "accepted, but the wrong place"),
        (Fate::Accepted, Some(true)) => ("right", "accepted, the right place"),
        (Fate::Accepted, _) => ("accepted", "accepted"),
        (Fate::Rejected, Some(true)) => ("rejected", "rejected, though the right place"),
        (Fate::Rejected, Some(false)) => ("rejected", "rejected, the wrong place"),
        (Fate::Rejected, None) => ("rejected", "rejected"),
        (Fate::NotChosen, _) if caption.decision == event::NEW_PLACE => ("rejected", "answered as a new place"),
        (Fate::NotChosen, _) => ("rejected", "not chosen"),
    }
}

fn line((live_point, partner): &([f32; 2], [f32; 2]), live: &Picture, matched: &Picture) -> String {
    let point = |[x, y]: [f32; 2], picture: &Picture| {
        let x = picture.x + f64::from(x.clamp(0.0, 1.0)) * picture.width;
        format!("{} {}", rounded(x), rounded(f64::from(y.clamp(0.0, 1.0)) * HEIGHT))
    };
    format!("M{}L{}", point(*live_point, live), point(*partner, matched))
}
