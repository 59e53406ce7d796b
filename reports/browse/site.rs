//! A site: its slots, and maps of its traversals; and the pages of a slot.

use super::cards::{Card, card};
use super::coverage::Coverage;
use super::error::BrowseError;
use super::map::{Canvas, Line, Map, dash};
use super::places::{self, site_key, site_of, tones};
use super::reply::Reply;
use super::slots::{SlotView, slots_of};
use super::store::Store;
use super::track::{Ground, Track};
use crate::chart::palette::Tones;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::index::{PlaceRow, TraversalRow};
use furrow_catalog::records::TraversalRecord;
use furrow_model::TimeSlot;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Traversals with an image, of each slot.
const OF_SLOT: usize = 12;
/// Tracks on a map.
const TRACKS: usize = 42;
/// Traversals on a slot's page.
const ON_PAGE: u32 = 48;

#[derive(Serialize)]
struct View {
    name: String,
    key: String,
    coverage: Coverage,
    slots: Vec<SlotView>,
    maps: Vec<Map>,
    legend: Vec<(String, String)>,
    left_out: usize,
    troubles: Vec<String>,
}

pub(super) fn page(store: &Store, key: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let places = catalog.places()?;
    let site = site_of(&places, &key)?;
    let own: Vec<&PlaceRow> = places.iter().filter(|place| place.site == site).collect();
    let tones = tones(&places);
    let slots: BTreeSet<TimeSlot> = own.iter().map(|place| place.slot).collect();
    let rows = chosen(&catalog, &site, &slots)?;
    let all = places::traversals(own.iter().copied());
    let (maps, troubles) = maps(store, &catalog, &rows, &tones);
    store.render(
        "site.html",
        View {
            name: wording::shown(&site),
            key,
            coverage: Coverage::of(&own),
            slots: slots_of(store, &catalog, &site, &own, OF_SLOT)?,
            maps,
            legend: slots.iter().map(|slot| (tones.of(*slot).class, slot.to_string())).collect(),
            left_out: (all as usize).saturating_sub(rows.len()),
            troubles,
        },
    )
}

/// The traversals that are drawn: as many of each slot.
fn chosen(catalog: &Catalog, site: &str, slots: &BTreeSet<TimeSlot>) -> Result<Vec<TraversalRow>, BrowseError> {
    let share = (TRACKS / slots.len().max(1)).max(1) as u32;
    let mut rows = Vec::new();
    for slot in slots.iter().take(TRACKS) {
        rows.extend(catalog.traversals_at(site, *slot, (0, share))?);
    }
    Ok(rows)
}

/// Tracks that share a map, by route: routes may lie far apart. Those without a ground truth have one of their own.
type Sheets<'a> = BTreeMap<(bool, &'a str), Vec<(&'a TraversalRow, Track)>>;

/// A map of each route, and one by odometry for its traversals without ground truth; what could not be drawn, and why.
fn maps(store: &Store, catalog: &Catalog, rows: &[TraversalRow], tones: &Tones) -> (Vec<Map>, Vec<String>) {
    let mut sheets = Sheets::new();
    let mut troubles = Vec::new();
    let mut frame_of: Option<TraversalRecord> = None;
    for row in rows {
        let track = (catalog.traversal(row.id).map_err(BrowseError::from))
            .and_then(|record| Ok((Track::of(store, &record, frame_of.as_ref())?, record)));
        match track {
            Err(error) => troubles.push(wording::shown(&error.to_string())),
            Ok((track, record)) => {
                if matches!(track.ground, Ground::Truth { relative: true, .. }) && frame_of.is_none() {
                    frame_of = Some(record);
                }
                sheets.entry((!track.is_true(), &row.route)).or_default().push((row, track));
            }
        }
    }
    (sheets.iter().map(|((odometry, route), tracks)| map(*odometry, route, tracks, tones)).collect(), troubles)
}

fn map(odometry: bool, route: &str, tracks: &[(&TraversalRow, Track)], tones: &Tones) -> Map {
    let canvas = Canvas::around(tracks.iter().flat_map(|(_, track)| track.points.iter().flatten()));
    let lines = tracks.iter().map(|(row, track)| line(&canvas, row, track, tones)).collect();
    let sources: BTreeSet<&str> = tracks.iter().filter_map(|(_, track)| source(track)).collect();
    let sources: Vec<&str> = sources.into_iter().collect();
    let route = wording::shown(route);
    let (label, caption) = match odometry {
        false => (format!("Route {route}"), format!("North is up. Positions: {}.", sources.join("; "))),
        true => (
            format!("Route {route}, by odometry"),
            "These traversals have no ground truth. Each track starts at the origin with its first view pointing up; \
             only that aligns them, and north is not known."
                .to_owned(),
        ),
    };
    canvas.map(label, caption, !odometry, lines)
}

fn source(track: &Track) -> Option<&str> {
    match &track.ground {
        Ground::Truth { source, .. } => Some(source),
        Ground::Odometry => None,
    }
}

fn line(canvas: &Canvas, row: &TraversalRow, track: &Track, tones: &Tones) -> Line {
    Line {
        d: canvas.path(&track.points),
        tone: tones.of(row.slot).class,
        dash: dash(row.purpose),
        start: track.points.iter().flatten().next().map(|point| canvas.at(*point)),
        traversal: Some(row.id.to_string()),
        title: format!("{} {}, route {}, {}", row.slot, row.purpose, wording::shown(&row.route), row.id.short()),
    }
}

#[derive(Serialize)]
struct SlotPage {
    site: String,
    key: String,
    slot: String,
    cards: Vec<Card>,
    number: u32,
    pages: u32,
    traversals: String,
}

/// All traversals of a slot, page by page; pages count from 1.
pub(super) fn slot(store: &Store, (key, slot, number): (String, String, String)) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let places = catalog.places()?;
    let site = site_of(&places, &key)?;
    let slot: TimeSlot = slot.parse().map_err(|_| BrowseError::not_here("slot", &slot))?;
    let all = places::traversals(places.iter().filter(|place| place.site == site && place.slot == slot));
    let pages = all.div_ceil(ON_PAGE);
    let inside = |number: &u32| (1..=pages).contains(number);
    let number =
        number.parse().ok().filter(inside).ok_or_else(|| BrowseError::not_here("page of this slot", &number))?;
    let rows = catalog.traversals_at(&site, slot, ((number - 1) * ON_PAGE, ON_PAGE))?;
    let cards = rows.iter().map(|row| card(store, &catalog, row)).collect();
    let view = SlotPage {
        site: wording::shown(&site),
        key: site_key(&site),
        slot: slot.to_string(),
        cards,
        number,
        pages,
        traversals: wording::counted(all as usize, "traversal", "traversals"),
    };
    store.render("slot.html", view)
}
