//! Everything of a run that its report shows, read from the store.

use super::contrast::missing_text;
use crate::Failure;
use furrow_catalog::records::{self, CodebookRecord, RunContrasts, RunRecord};
use furrow_catalog::{Catalog, Objects, tables};
use furrow_model::{
    CellKey, CodebookId, Experience, ExperienceId, ExperienceKind, ObjectId, Outcome, RunId, TraversalId,
};
use furrow_reports::{
    CellInput, ContrastInput, GateCurve, GatePoint, GeneratorInput, MissingCell, ReportInput, Tile, TileChoice,
    TrackInput, Training, choose_still, choose_tiles,
};
use furrow_runner::gate::GateRecord;
use furrow_runner::pictures::picture_pair;
use furrow_runner::tracks::laid_over_truth;
use furrow_runner::{contrasts, generation};
use std::collections::{BTreeMap, BTreeSet};

/// Tiles of a cell: so many accepted and rejected frames, wrong ones on top.
const ACCEPTED_TILES: usize = 3;
const REJECTED_TILES: usize = 2;
/// A page with many cells shows fewer pictures each, so that it stays small.
const TILES_IN_ALL: usize = 60;
/// And one with very many hardly any: the numbers alone take most of 10 MB.
const TILES_OF_MANY: usize = 10;
const MANY_CELLS: usize = 150;
/// Cells that a page of large pictures has at most, and how wide pictures are on it and on others, in columns: it draws them 356 wide.
const FEW_CELLS: usize = 8;
const PICTURE_COLUMNS: [usize; 2] = [480, 320];
/// Pictures that set one live frame against every experience.
const STILLS_IN_ALL: usize = 24;
/// Contact sheets of generators.
const SHEETS_IN_ALL: usize = 6;
/// Tracks beside their ground truth.
const TRACKS_IN_ALL: usize = 14;
/// Timings of trainings that are looked through.
const TIMINGS: u32 = 10_000;

/// Reads it; `command` makes the page again.
pub fn report_input(catalog: &Catalog, id: RunId, command: String) -> Result<ReportInput, Failure> {
    let record = catalog.run(id)?;
    let drawn = |figure: &str| record.figures.is_empty() || record.figures.iter().any(|name| name == figure);
    let (mut cells, missing) = cells(catalog, &record)?;
    let outcomes: Vec<&Outcome> = cells.iter().map(|cell| &cell.outcome).collect();
    let contrasts = contrast_input(catalog.objects(), &record.contrasts, &outcomes)?;
    if drawn("tiles") {
        add_tiles(catalog, &mut cells)?;
        add_stills(catalog, &mut cells)?;
    }
    Ok(ReportInput {
        run: id,
        command,
        furrow_version: env!("CARGO_PKG_VERSION").to_owned(),
        tracks: tracks(catalog, &cells)?,
        trained: trained(catalog, &cells)?,
        generators: generators(catalog, &record, &parents(catalog, &cells)?, drawn("tiles"))?,
        matrix_name: record.name,
        matrix_source: record.source,
        site: record.site,
        cells,
        missing,
        contrasts,
    })
}

/// The finished cells, without pictures yet, and those that are missing.
fn cells(catalog: &Catalog, record: &RunRecord) -> Result<(Vec<CellInput>, Vec<MissingCell>), Failure> {
    let (mut cells, mut missing) = (Vec::new(), Vec::new());
    let mut names: BTreeMap<CellKey, &str> = BTreeMap::new();
    for cell in &record.cells {
        let label = || format!("live {} against {}", cell.live, cell.experience);
        if let Some(name) = names.get(&cell.key) {
            // On several live passes of one slot this is said once.
            let twin = MissingCell {
                label: label(),
                reason: format!("it has the members of {name} and answers alike: shown under that name"),
            };
            if !missing.contains(&twin) {
                missing.push(twin);
            }
            continue;
        }
        names.insert(cell.key, &cell.experience);
        match catalog.outcome(cell.key)? {
            Some(outcome) => {
                let outcome = outcome.named(&cell.experience);
                let events = tables::from_parquet("events", catalog.objects().read(outcome.events)?)?;
                cells.push(CellInput { outcome, events, tiles: Vec::new() });
            }
            None => {
                missing.push(MissingCell { label: label(), reason: "not finished: run the matrix again".to_owned() })
            }
        }
    }
    missing.extend(record.blocked.iter().map(|blocked| MissingCell {
        label: format!("live {} against {}", blocked.live, blocked.experience),
        reason: blocked.reason.clone(),
    }));
    Ok((cells, missing))
}

/// The run's contrasts, with what must be said beside them.
pub fn contrast_input(
    objects: &Objects,
    asked: &[RunContrasts],
    outcomes: &[&Outcome],
) -> Result<ContrastInput, Failure> {
    let made = contrasts(objects, asked, outcomes)?;
    let warnings = asked.iter().flat_map(|asked| asked.warnings.iter().cloned());
    let mut notes: Vec<String> = Vec::new();
    // Settings warn of the same things.
    for note in warnings.chain(made.missing.iter().map(missing_text)) {
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    Ok(ContrastInput { notes, found: made.found })
}

fn picture_columns(cells: usize) -> usize {
    PICTURE_COLUMNS[usize::from(cells > FEW_CELLS)]
}

/// Some frames of each cell; where there are more cells than pictures, of cells evenly spread.
fn add_tiles(catalog: &Catalog, cells: &mut [CellInput]) -> Result<(), Failure> {
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
            cell.tiles.push(tile(catalog, &cell.outcome, choice, (false, columns))?);
        }
    }
    Ok(())
}

/// Of each live pass the frame that most cells accepted, against every experience.
fn add_stills(catalog: &Catalog, cells: &mut [CellInput]) -> Result<(), Failure> {
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
    for (pass, stamps) in accepted {
        let of_pass = cells.iter().filter(|cell| cell.outcome.live_traversal == pass).count();
        // The earliest of those that most cells knew; a page without room for all of them shows none of that pass.
        let best =
            stamps.iter().max_by_key(|(stamp, count)| (**count, std::cmp::Reverse(**stamp))).map(|(stamp, _)| *stamp);
        let Some(stamp) = best.filter(|_| of_pass > 1 && of_pass <= room) else { continue };
        room -= of_pass;
        for cell in cells.iter_mut().filter(|cell| cell.outcome.live_traversal == pass) {
            if let Some(choice) = choose_still(&cell.outcome, &cell.events, stamp)? {
                cell.tiles.push(tile(catalog, &cell.outcome, choice, (true, columns))?);
            }
        }
    }
    Ok(())
}

fn tile(
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

/// Of each live pass that has a ground truth, what odometry made of it.
fn tracks(catalog: &Catalog, cells: &[CellInput]) -> Result<Vec<TrackInput>, Failure> {
    let mut passes: Vec<TraversalId> = Vec::new();
    for cell in cells {
        if !passes.contains(&cell.outcome.live_traversal) {
            passes.push(cell.outcome.live_traversal);
        }
    }
    let mut tracks = Vec::new();
    for pass in passes.into_iter().take(TRACKS_IN_ALL) {
        let record = catalog.traversal(pass)?;
        if let Some(track) = laid_over_truth(catalog.objects(), &record)? {
            tracks.push(TrackInput {
                name: format!("Live {}, pass {}", record.slot, pass.short()),
                source: track.source,
                truth_m: track.truth_m,
                odometry_m: track.chain_m,
                rms_m: track.rms_m,
                length_m: track.length_m,
            });
        }
    }
    Ok(tracks)
}

/// The codebooks of the cells, with what their training took where this store saw it.
fn trained(catalog: &Catalog, cells: &[CellInput]) -> Result<Vec<Training>, Failure> {
    let timings = catalog.timings("codebook", TIMINGS)?;
    let codebooks: BTreeSet<_> = cells.iter().filter_map(|cell| cell.outcome.codebook).collect();
    let of = |id: &CodebookId| {
        let record: CodebookRecord = records::read(catalog.objects(), ObjectId(id.0))?;
        let mut own =
            timings.iter().filter(|timing| timing.subject == id.to_string()).map(|timing| timing.seconds).peekable();
        Ok(Training {
            codebook: id.short(),
            trainer: record.trainer,
            images: u32::try_from(record.images.len()).unwrap_or(u32::MAX),
            words: record.words,
            seconds: own.peek().is_some().then(|| own.sum()),
        })
    };
    codebooks.iter().map(of).collect()
}

/// What the generated experiences of the run's cells were made from.
fn parents(catalog: &Catalog, cells: &[CellInput]) -> Result<BTreeSet<ExperienceId>, Failure> {
    let members: BTreeSet<ExperienceId> =
        cells.iter().flat_map(|cell| &cell.outcome.members).map(|member| member.id).collect();
    let mut parents = BTreeSet::new();
    for member in members {
        let record: Experience = records::read(catalog.objects(), ObjectId(member.0))?;
        if let ExperienceKind::Generated { parent, .. } = record.kind {
            parents.insert(parent);
        }
    }
    Ok(parents)
}

/// The generators that the run names: what the gate measured on its own parents, and a contact sheet of the trained ones.
fn generators(
    catalog: &Catalog,
    record: &RunRecord,
    parents: &BTreeSet<ExperienceId>,
    pictures: bool,
) -> Result<Vec<GeneratorInput>, Failure> {
    let mut found = Vec::new();
    let mut sheets = 0;
    for id in &record.generators {
        let generator = catalog.generator(*id)?;
        let mut curves: BTreeMap<_, Vec<GateRecord>> = BTreeMap::new();
        for row in catalog.gates(*id)?.into_iter().filter(|row| parents.contains(&row.parent)) {
            curves.entry(row.parent).or_default().push(records::read(catalog.objects(), row.object)?);
        }
        let zs: BTreeSet<u64> = curves.values().flatten().map(|gate| gate.measures.z.to_bits()).collect();
        let zs: Vec<f64> = zs.into_iter().map(f64::from_bits).collect();
        let mut sheet = None;
        if let Some(parent) =
            curves.keys().next().filter(|_| pictures && generator.source.is_some() && sheets < SHEETS_IN_ALL)
        {
            let jpeg = generation::contact_sheet(catalog, &generator, Some(&catalog.experience(*parent)?), &zs)?;
            let levels: Vec<String> = zs.iter().map(|z| format!("z = {z}")).collect();
            sheet = Some((
                jpeg,
                format!("recorded, {}, and the hour it mimics as recorded on the training route", levels.join(", ")),
            ));
            sheets += 1;
        }
        let curve = |(parent, gates): (ExperienceId, Vec<GateRecord>)| {
            Ok(GateCurve {
                parent: format!("{}, experience {}", catalog.experience(parent)?.slot, parent.short()),
                points: gates
                    .iter()
                    .map(|gate| &gate.measures)
                    .map(|m| GatePoint { z: m.z, good_matches: m.good_matches, matchable: m.matchable })
                    .collect(),
            })
        };
        let curves = curves.into_iter().map(curve).collect::<Result<_, Failure>>()?;
        found.push(GeneratorInput { name: generator.name, curves, sheet });
    }
    Ok(found)
}
