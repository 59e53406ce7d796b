//! Live frames beside the nodes they were matched to: by cell, and one frame against every experience.

use super::tile::{Fate, TileView};
use crate::error::ReportError;
use crate::input::{CellInput, Tile};
use crate::wording;
use furrow_model::TraversalId;
use serde::Serialize;

/// One cell's tiles.
#[derive(Serialize)]
pub(super) struct Album {
    cell: String,
    live: String,
    experience: String,
    tiles: Vec<TileView>,
    open: bool,
    wrong: usize,
}

/// One live frame against every experience.
#[derive(Serialize)]
pub(super) struct Still {
    #[serde(skip)]
    live_traversal: TraversalId,
    live: String,
    travelled: String,
    tiles: Vec<TileView>,
}

/// The frames that are set against every experience, in the order of the cells.
pub(super) fn stills(cells: &[&CellInput]) -> Result<Vec<Still>, ReportError> {
    let mut stills: Vec<Still> = Vec::new();
    for cell in cells {
        for (i, tile) in cell.tiles.iter().filter(|tile| tile.compared).enumerate() {
            let view = TileView::of(cell, tile, format!("still-{}-{i}", cell.outcome.key.short()))?;
            let (live_traversal, travelled) = (cell.outcome.live_traversal, view.travelled.clone());
            let same = |still: &&mut Still| still.live_traversal == live_traversal && still.travelled == travelled;
            match stills.iter_mut().find(same) {
                Some(still) => still.tiles.push(view),
                None => {
                    let live = cell.outcome.live.to_string();
                    stills.push(Still { live_traversal, live, travelled, tiles: vec![view] });
                }
            }
        }
    }
    Ok(stills)
}

/// The albums of all cells that have tiles: wrong ones first in each, and open where there is something wrong to see.
pub(super) fn albums(cells: &[&CellInput]) -> Result<Vec<Album>, ReportError> {
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
    tiles.sort_by_key(|tile| Fate::of(&tile.caption));
    let wrong = tiles.iter().filter(|tile| Fate::of(&tile.caption) == Fate::AcceptedWrong).count();
    let view = |(i, tile): (usize, &&Tile)| TileView::of(cell, tile, format!("tile-{key}-{i}"));
    let tiles = tiles.iter().enumerate().map(view).collect::<Result<Vec<_>, _>>()?;
    let (live, experience) = (cell.outcome.live.to_string(), wording::shown(&cell.outcome.experience));
    Ok(Album { cell: key, live, experience, tiles, open: wrong > 0, wrong })
}
