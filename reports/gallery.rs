//! Live frames beside the places they were matched to (thesis Figs 3.6, 3.7, 7.19 to 7.30; X3).

use crate::input::{CellInput, GeneratorInput, ReportError, Tile, TileCaption};
use crate::scale::rounded;
use crate::{jpeg, wording};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use furrow_model::TraversalId;
use furrow_model::outcome::event;
use serde::Serialize;

const HEIGHT: f64 = 200.0;
const GAP: f64 = 6.0;

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
    cell: String,
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

/// A generator's contact sheet.
#[derive(Serialize)]
pub(crate) struct Sheet {
    name: String,
    rows: String,
    width: u32,
    height: u32,
    uri: String,
}

/// The contact sheets there are.
pub(crate) fn sheets(generators: &[GeneratorInput]) -> Result<Vec<Sheet>, ReportError> {
    let sheet = |(generator, (jpeg, rows)): (&GeneratorInput, &(Vec<u8>, String))| {
        let name = wording::shown(&generator.name);
        let no_picture = || ReportError::Sheet { generator: name.clone(), bytes: jpeg.len() };
        let (width, height) = jpeg::size(jpeg).ok_or_else(no_picture)?;
        let uri = format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg));
        Ok(Sheet { name, rows: wording::shown(rows), width, height, uri })
    };
    generators
        .iter()
        .filter_map(|generator| generator.sheet.as_ref().map(|sheet| (generator, sheet)))
        .map(sheet)
        .collect()
}

/// One live frame against every experience: an album per live pass, in the order of the cells.
pub(crate) fn stills(cells: &[&CellInput]) -> Result<Vec<Album>, ReportError> {
    let mut albums: Vec<(TraversalId, Album)> = Vec::new();
    for cell in cells {
        for (i, tile) in cell.tiles.iter().filter(|tile| tile.compared).enumerate() {
            let key = cell.outcome.key.short();
            let view = tile_view(cell, tile, format!("still-{key}-{i}"))?;
            let (pass, live) = (cell.outcome.live_traversal, cell.outcome.live.to_string());
            match albums.iter_mut().find(|(of, album)| *of == pass && album.experience == view.travelled) {
                Some((_, album)) => album.tiles.push(view),
                None => {
                    let experience = view.travelled.clone();
                    albums.push((pass, Album { cell: key, live, experience, tiles: vec![view], open: true, wrong: 0 }));
                }
            }
        }
    }
    Ok(albums.into_iter().map(|(_, album)| album).collect())
}

/// The albums of all cells that have tiles: wrong ones first in each, and open where there is something wrong to see.
pub(crate) fn albums(cells: &[&CellInput]) -> Result<Vec<Album>, ReportError> {
    let with_tiles = cells.iter().filter(|cell| cell.tiles.iter().any(|tile| !tile.compared));
    let mut albums = with_tiles.map(|cell| album(cell)).collect::<Result<Vec<_>, _>>()?;
    if let Some(first) = albums.first_mut() {
        first.open = true;
    }
    Ok(albums)
}

fn album(cell: &CellInput) -> Result<Album, ReportError> {
    let key = cell.outcome.key.short();
    let mut tiles: Vec<&Tile> = cell.tiles.iter().filter(|tile| !tile.compared).collect();
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

fn drawn(line: &([f32; 2], [f32; 2]), live: &PictureView, matched: &PictureView) -> String {
    let point = |[x, y]: [f32; 2], picture: &PictureView| {
        let x = picture.x + f64::from(x.clamp(0.0, 1.0)) * picture.width;
        format!("{} {}", rounded(x), rounded(f64::from(y.clamp(0.0, 1.0)) * HEIGHT))
    };
    format!("M{}L{}", point(line.0, live), point(line.1, matched))
}
