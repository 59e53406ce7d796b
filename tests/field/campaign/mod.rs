//! Many traversals at once: a TOML file that names them, and which of them are still to be recorded.
//!
//! Every key of a `[[pass]]` may also stand at the top, as the default of all of them: `site` or `sites`, `route`,
//! `slots`, `purposes`, `date`, `seed`, `length_m`, `size`, `weather`, `rate_hz`, `distorted`, `dropped`,
//! `clock_skew_ppm`, `clock_offset_ms`. `folder` and `container` stand at the top alone. A table stands for all its
//! sites, slots and purposes.

mod error;
mod section;
mod table;

pub use error::CampaignError;

use crate::traversal::{Date, Traversal};
use error::Source;
use furrow_model::Purpose;
use section::{Layers, Section, quoted};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use table::{KEYS, Table};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Traversals to be recorded into one folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Where the recordings go: a path below the folder of the campaign's file.
    pub folder: PathBuf,
    /// The traversals, in the order of the file.
    pub traversals: Vec<Planned>,
}

/// One traversal of a campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// What is simulated.
    pub traversal: Traversal,
    /// The recording's file name, unlike all others of the campaign.
    pub file: String,
    /// What the recording is for.
    pub purpose: Purpose,
}

impl Planned {
    /// Whether `folder` holds this traversal's recording, and beside it the description of just this traversal.
    pub fn is_recorded(&self, folder: &Path) -> bool {
        let recording = folder.join(&self.file);
        let about = std::fs::read(recording.with_extension("pass.json"));
        let about = about.ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
        recording.is_file() && about.is_some_and(|about| self.traversal.is_described_by(&about))
    }
}

impl Campaign {
    /// Reads a campaign. `path` is named in errors alone.
    ///
    /// Several traversals of one site, route, date and slot get the numbers 0, 1, ... in the order of the file, so that
    /// no two are alike.
    ///
    /// # Errors
    /// What is wrong first: the line and column, what was found there and what is expected.
    pub fn read(text: &str, path: &Path) -> Result<Campaign, CampaignError> {
        let source = Source { path, text };
        let document = DeTable::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            source.wrong(at, format!("no TOML ({})", error.message().trim_end()), "a TOML file")
        })?;
        let top_keys: Vec<&str> = ["folder", "container", "pass"].into_iter().chain(KEYS).collect();
        let top = Section::new(&source, document.get_ref(), &top_keys)?;
        let containers = ["mcap", "bag"];
        let container = top.get("container", |entry| {
            entry.name(&containers, |text| containers.contains(&text).then(|| text.to_owned()))
        })?;
        let container = container.unwrap_or_else(|| "mcap".to_owned());
        let folder = top.get("folder", |entry| {
            entry.text("a path below the campaign's own folder, without '..'", |text| {
                let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
                (!text.is_empty() && Path::new(text).components().all(inside)).then(|| PathBuf::from(text))
            })
        })?;
        let mut planned = Vec::new();
        for (table, at) in tables(&source, document.get_ref())? {
            let own = Section::new(&source, table, &KEYS)?;
            planned.extend(Table::read(&Layers { own, defaults: &top, at })?.traversals());
        }
        let traversals = named(&source, planned, &container)?;
        Ok(Campaign { folder: folder.unwrap_or_else(|| PathBuf::from(".")), traversals })
    }

    /// Those traversals of which `folder` holds no recording, or one of another traversal: what is left to do.
    pub fn missing(&self, folder: &Path) -> Vec<&Planned> {
        self.traversals.iter().filter(|planned| !planned.is_recorded(folder)).collect()
    }
}

/// The `[[pass]]` tables with their places in the text.
fn tables<'a, 't>(source: &Source, top: &'a DeTable<'t>) -> Result<Vec<(&'a DeTable<'t>, usize)>, CampaignError> {
    let expected = "at least one [[pass]]";
    let Some(traversals) = top.get("pass") else { return Err(source.wrong(0, "no [[pass]]", expected)) };
    let table = |entry: &'a Spanned<DeValue<'t>>| match entry.get_ref() {
        DeValue::Table(table) => Ok((table, entry.span().start)),
        other => Err(source.wrong(entry.span().start, quoted(other), expected)),
    };
    match traversals.get_ref() {
        DeValue::Array(tables) if !tables.is_empty() => tables.iter().map(table).collect(),
        other => Err(source.wrong(traversals.span().start, quoted(other), expected)),
    }
}

/// Numbers the traversals within their slots and names their files.
fn named(
    source: &Source,
    planned: Vec<(Traversal, Purpose, usize)>,
    container: &str,
) -> Result<Vec<Planned>, CampaignError> {
    let dates: BTreeSet<Date> = planned.iter().map(|(traversal, ..)| traversal.date).collect();
    let mut numbers = BTreeMap::new();
    let mut places = BTreeMap::new();
    let mut named = Vec::new();
    for (mut traversal, purpose, at) in planned {
        let number: &mut u32 =
            numbers.entry((traversal.site, traversal.route.clone(), traversal.date, traversal.slot)).or_default();
        traversal.number = *number;
        *number += 1;
        let date = if dates.len() > 1 { format!("-{}", traversal.date) } else { String::new() };
        let slot = traversal.slot.to_string().replace(':', "");
        let file = format!("{}-{}-{slot}-{purpose}{date}.{container}", traversal.site, traversal.route);
        if let Some(first) = places.insert(file.clone(), at) {
            let (line, column) = source.place(first);
            let found = format!("a second pass named {file}, after that of {line}:{column}");
            return Err(source.wrong(at, found, "one pass for every site, route, slot, purpose and date"));
        }
        named.push(Planned { traversal, file, purpose });
    }
    Ok(named)
}
