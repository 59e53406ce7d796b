//! The pictures of a report: live frames beside what they were matched with.

use crate::ending::Failure;
use furrow_catalog::Catalog;
use furrow_model::{Outcome, TraversalId};
use furrow_reports::{CellInput, Tile, TileChoice, choose_still, choose_tiles};
use furrow_runner::export::pictures::picture_pair;
use std::collections::BTreeMap;

/// Tiles of a cell: so many accepted and rejected frames, wrong ones on top.
const ACCEPTED_TILES: usize = 3;
const REJECTED_TILES: usize = 2;
/// A page with many cells shows fewer pictures each, so that it stays small.
const TILES_IN_ALL: usize = 60;
/// And one with very many hardly any: the numbers alone take most of 10 MB.
const TILES_OF_MANY: usize = 10;
const MANY_CELLS: usize = 150;
/// The most cells of a page with large pictures, and the width of pictures on it and on others, in columns: the page
/// shows them 356 wide.
const FEW_CELLS: usize = 8;
const PICTURE_COLUMNS: [usize; 2] = [480, 320];
/// Pictures that set one live frame against every experience.
const STILLS_IN_ALL: usize = 24;

fn picture_columns(cells: usize) -> usize {
    PICTURE_COLUMNS[usize::from(cells > FEW_CELLS)]
}

/// Adds some frames of each cell; with more cells than pictures, of cells evenly spread.
pub fn add_tiles(catalog: &Catalog, cells: &mut [CellInput]) -> Result<(), Failure> {
    let n = cells.len().max(1);
    let all = if n > MANY_CELLS { TILES_OF_MANY } else { TILES_IN_ALL };
    let columns = picture_columns(n);
    for (i, cell) in cells.iter_mut().enumerate() {
        let share = (i + 1) * all / n - i * all / n;
        if share == 0 {
            continue;
        }
        let choices = choose_tiles(&cell.outcome, &cell.events, ACCEPTED_TILES.min(share), REJECTED_TILES.min(share))?;
        // Few cells have room for every wrong frame that is chosen.
        let room = if n <= FEW_CELLS { usize::MAX } else { share.max(ACCEPTED_TILES.min(share) + 1) };
        for choice in choices.into_iter().take(room) {
            cell.tiles.push(make_tile(catalog, &cell.outcome, choice, (false, columns))?);
        }
    }
    Ok(())
}

/// Adds, for each live traversal, the frame that most cells accepted, against every experience.
pub fn add_stills(catalog: &Catalog, cells: &mut [CellInput]) -> Result<(), Failure> {
    let mut accepted: BTreeMap<TraversalId, BTreeMap<i64, usize>> = BTreeMap::new();
    for cell in cells.iter() {
        let all = usize::MAX;
        for choice in choose_tiles(&cell.outcome, &cell.events, all, 0)? {
            *accepted
                .entry(cell.outcome.live_traversal)
                .or_default()
                .entry(choice.caption.live_stamp_ns)
                .or_default() += 1;
        }
    }
    let (mut room, columns) = (STILLS_IN_ALL, picture_columns(cells.len()));
    for (live, stamps) in accepted {
        let of_live = cells.iter().filter(|cell| cell.outcome.live_traversal == live).count();
        // The earliest of the frames that most cells accepted. Without room for all its cells, none is shown.
        let best =
            stamps.iter().max_by_key(|(stamp, count)| (**count, std::cmp::Reverse(**stamp))).map(|(stamp, _)| *stamp);
        let Some(stamp) = best.filter(|_| of_live > 1 && of_live <= room) else { continue };
        room -= of_live;
        for cell in cells.iter_mut().filter(|cell| cell.outcome.live_traversal == live) {
            if let Some(choice) = choose_still(&cell.outcome, &cell.events, stamp)? {
                cell.tiles.push(make_tile(catalog, &cell.outcome, choice, (true, columns))?);
            }
        }
    }
    Ok(())
}

fn make_tile(
    catalog: &Catalog,
    outcome: &Outcome,
    choice: TileChoice,
    (compared, columns): (bool, usize),
) -> Result<Tile, Failure> {
    let matched = choice.node_image.map(|image| (choice.experience, image));
    let pictures = picture_pair(catalog, outcome, choice.caption.live_stamp_ns, matched, columns)?;
    let (live_jpeg, match_jpeg, inlier_lines) = (pictures.live, pictures.matched, pictures.lines);
    Ok(Tile { caption: choice.caption, live_jpeg, match_jpeg, compared, inlier_lines })
}
