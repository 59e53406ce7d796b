//! A `[[pass]]` table: the traversals of all its sites, slots and purposes.

use super::error::CampaignError;
use super::section::{Entry, Layers};
use crate::traversal::BadTraversal;
use crate::traversal::{Date, Site, Traversal, Weather};
use furrow_model::{Purpose, TimeSlot};

/// The keys that a `[[pass]]`, or the top of the file for all of them, may have.
pub(super) const KEYS: [&str; 15] = [
    "site",
    "sites",
    "route",
    "slots",
    "purposes",
    "date",
    "seed",
    "length_m",
    "size",
    "weather",
    "rate_hz",
    "distorted",
    "dropped",
    "clock_skew_ppm",
    "clock_offset_ms",
];

/// What a `[[pass]]` says. Slots keep their places in the text.
pub(super) struct Table {
    sites: Vec<Site>,
    slots: Vec<(TimeSlot, usize)>,
    purposes: Vec<Purpose>,
    /// A traversal with all but site and slot.
    model: Traversal,
}

impl Table {
    /// Reads and checks it.
    pub fn read(layers: &Layers) -> Result<Table, CampaignError> {
        let source = layers.own.source;
        let needed = |key: &str, expected: &str| source.wrong(layers.at, format!("a pass without '{key}'"), expected);
        let sites = sites(layers)?.ok_or_else(|| needed("site", "site = \"old-zoo\", here or at the file's top"))?;
        let slot = |entry: &Entry| {
            entry.text("a time HH:MM between 00:00 and 23:59, as in \"08:00\"", |text| {
                text.parse::<TimeSlot>().ok().map(|slot| (slot, entry.at()))
            })
        };
        let expected = "slots as in [\"08:00\", \"10:00\"]";
        let slots =
            layers.get("slots", |entry| entry.list(expected, slot))?.ok_or_else(|| needed("slots", expected))?;
        let names: Vec<String> = Purpose::ALL.iter().map(Purpose::to_string).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let purpose = |entry: &Entry| entry.name(&names, |text| text.parse::<Purpose>().ok());
        let expected = "purposes as in [\"experience\", \"evaluation\"]";
        let purposes = layers
            .get("purposes", |entry| entry.list(expected, purpose))?
            .ok_or_else(|| needed("purposes", expected))?;
        // A list that was read has a first entry.
        let (Some(&site), Some(&(slot, _))) = (sites.first(), slots.first()) else {
            return Err(needed("slots", expected));
        };
        let model = model(layers, Traversal::new(site, slot))?;
        model
            .check()
            .map_err(|bad| source.wrong(layers.at(key_of(&bad)), "a pass that cannot be driven", bad.to_string()))?;
        Ok(Table { sites, slots, purposes, model })
    }

    /// Its traversals, all numbered 0, with their slots' places in the text.
    pub fn traversals(self) -> Vec<(Traversal, Purpose, usize)> {
        let mut traversals = Vec::new();
        for &site in &self.sites {
            for &(slot, at) in &self.slots {
                let traversal = Traversal { site, slot, ..self.model.clone() };
                traversals.extend(self.purposes.iter().map(|&purpose| (traversal.clone(), purpose, at)));
            }
        }
        traversals
    }
}

/// The sites by whichever of the two keys the table, or else the top, has.
fn sites(layers: &Layers) -> Result<Option<Vec<Site>>, CampaignError> {
    let names = Site::ALL.map(|site| site.to_string());
    let names = names.each_ref().map(String::as_str);
    let site = |entry: &Entry| entry.name(&names, |text| text.parse::<Site>().ok());
    for section in [&layers.own, layers.defaults] {
        let one = section.get("site", site)?;
        let several = section.get("sites", |entry| entry.list("sites as in [\"old-zoo\", \"lindenhof\"]", site))?;
        match (one, several) {
            (Some(_), Some(_)) => {
                let at = section.at("sites").unwrap_or(layers.at);
                return Err(section.source.wrong(at, "both 'site' and 'sites'", "one of them"));
            }
            (Some(one), None) => return Ok(Some(vec![one])),
            (None, Some(several)) => return Ok(Some(several)),
            (None, None) => (),
        }
    }
    Ok(None)
}

/// `base` with what the table or the top says otherwise.
fn model(layers: &Layers, base: Traversal) -> Result<Traversal, CampaignError> {
    let mut traversal = base;
    let set = |key: &str, number: &mut f64| -> Result<(), CampaignError> {
        *number = layers.get(key, |entry| entry.number())?.unwrap_or(*number);
        Ok(())
    };
    set("length_m", &mut traversal.length_m)?;
    set("rate_hz", &mut traversal.camera.rate_hz)?;
    set("dropped", &mut traversal.camera.dropped)?;
    set("clock_skew_ppm", &mut traversal.camera.clock_skew_ppm)?;
    set("clock_offset_ms", &mut traversal.camera.clock_offset_ms)?;
    traversal.camera.distorted = layers.get("distorted", |entry| entry.truth())?.unwrap_or(false);
    let route = |text: &str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        ((1..=64).contains(&text.len()) && text.chars().all(plain)).then(|| text.to_owned())
    };
    let expected = "a route's name of 1 to 64 letters, digits, '-' and '_'";
    traversal.route = layers.get("route", |entry| entry.text(expected, route))?.unwrap_or(traversal.route);
    let day = |text: &str| text.parse::<Date>().ok();
    let expected = "a day \"YYYY-MM-DD\" in quotes, as in \"2026-01-15\"";
    traversal.date = layers.get("date", |entry| entry.text(expected, day))?.unwrap_or(traversal.date);
    let seed = |entry: &Entry| u64::try_from(entry.whole()?).map_err(|_| entry.wrong("a whole number from 0 on"));
    traversal.seed = layers.get("seed", seed)?.unwrap_or(traversal.seed);
    let size = |text: &str| {
        let (width, height) = text.split_once('x')?;
        Some((width.parse().ok()?, height.parse().ok()?))
    };
    let expected = "COLUMNSxROWS, as in \"640x360\"";
    traversal.size = layers.get("size", |entry| entry.text(expected, size))?.unwrap_or(traversal.size);
    let names = Weather::ALL.map(|weather| weather.to_string());
    let names = names.each_ref().map(String::as_str);
    let weather = |entry: &Entry| entry.name(&names, |text| text.parse::<Weather>().ok());
    traversal.weather = layers.get("weather", weather)?.unwrap_or(traversal.weather);
    Ok(traversal)
}

fn key_of(bad: &BadTraversal) -> &'static str {
    match bad {
        BadTraversal::Size(..) => "size",
        BadTraversal::Length(_) => "length_m",
        BadTraversal::Rate(_) => "rate_hz",
        BadTraversal::Dropped(_) => "dropped",
        BadTraversal::Skew(_) => "clock_skew_ppm",
        BadTraversal::Offset { .. } => "clock_offset_ms",
    }
}
