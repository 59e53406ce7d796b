//! Entries of the axes `live` and `experience`: which traversals, and what is generated from them.

use furrow_model::{Domainness, TimeSlot};
use serde::de::IntoDeserializer;
use serde::{Deserialize, Deserializer};
use std::fmt;
use toml::Spanned;

/// Recorded traversals: those of a slot or of all slots, and of these the one of a number or those of a date.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TraversalEntry {
    /// The slot; none is every slot that was recorded.
    pub slot: Option<TimeSlot>,
    /// Its number among those of its slot, counted from 1 in the order recorded.
    pub number: Option<u32>,
    /// The day it was driven, `YYYY-MM-DD` in the site's time.
    pub date: Option<String>,
}

/// An entry of the experience axis.
#[derive(Debug, Clone, PartialEq)]
pub enum ExperienceEntry {
    /// Recorded.
    Recorded(TraversalEntry),
    /// Generated from a parent.
    Generated(GeneratedEntry),
}

/// Experiences generated from a recorded parent.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneratedEntry {
    /// The parent's slot.
    pub parent: TimeSlot,
    /// The generator's name.
    pub generator: String,
    /// How far to move the images, one experience each.
    pub domainness: Vec<Domainness>,
}

impl GeneratedEntry {
    pub(super) fn check(&self) -> Result<(), String> {
        let [least, most] = furrow_generator::DOMAINNESS;
        if self.domainness.is_empty() {
            return Err("domainness is empty: name at least one, as in domainness = [0.33, 0.66, 1.0]".to_owned());
        }
        match self.domainness.iter().find(|z| !(least..=most).contains(&z.0)) {
            Some(z) => Err(format!(
                "domainness {}: expected numbers from {least} to {most}; 0 is the parent, 1 the target",
                z.0
            )),
            None => Ok(()),
        }
    }
}

/// `"recorded:*"`: every recorded slot.
const ALL: &str = "recorded:*";

/// A traversal entry as a table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TraversalTable {
    slot: Option<String>,
    #[serde(alias = "pass")]
    number: Option<u32>,
    date: Option<String>,
}

/// A generated entry as it is written: one generator or several.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GeneratedTable {
    parent: TimeSlot,
    generator: OneOrMany<String>,
    domainness: Vec<Domainness>,
}

/// One value, or a list of them.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum OneOrMany<T> {
    One(T),
    Many(Vec<T>),
}

impl<T> OneOrMany<T> {
    pub fn into_vec(self) -> Vec<T> {
        match self {
            Self::One(value) => vec![value],
            Self::Many(values) => values,
        }
    }
}

impl TraversalEntry {
    /// All traversals of a slot.
    pub fn at(slot: TimeSlot) -> Self {
        Self { slot: Some(slot), ..Self::default() }
    }

    /// Whether it asks for more than a slot.
    pub fn narrows(&self) -> bool {
        self.number.is_some() || self.date.is_some()
    }

    fn read(value: toml::Value) -> Result<Self, String> {
        let slot = |text: &str| match text {
            ALL => Ok(None),
            slot => slot.parse().map(Some).map_err(|error| format!("{error}, or \"{ALL}\"")),
        };
        match value {
            toml::Value::String(text) => Ok(Self { slot: slot(&text)?, ..Self::default() }),
            toml::Value::Table(table) => {
                let table: TraversalTable = table.try_into().map_err(reason_of)?;
                let slot = table.slot.as_deref().map_or(Ok(None), slot)?;
                let entry = Self { slot, number: table.number, date: table.date };
                entry.check().map(|()| entry)
            }
            other => Err(format!(
                "expected a slot as in \"10:00\", \"{ALL}\" or a table {{ slot, number, date }}, found {}",
                other.type_str()
            )),
        }
    }

    fn check(&self) -> Result<(), String> {
        if self.number == Some(0) {
            return Err(
                "traversals of a slot are counted from 1, in the order recorded: number = 1 is the first".to_owned()
            );
        }
        match &self.date {
            Some(date) if chrono::NaiveDate::parse_from_str(date, "%Y-%m-%d").is_err() || date.len() != 10 => {
                Err(format!("'{date}' is no date: expected YYYY-MM-DD, as in 2026-01-15"))
            }
            _ => Ok(()),
        }
    }
}

/// As labels write it: `08:00`, `08:00 pass 2`, `08:00 on 2026-01-15`. Outcomes hold labels: they stay as they are.
impl fmt::Display for TraversalEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.slot {
            Some(slot) => write!(f, "{slot}")?,
            None => f.write_str(ALL)?,
        }
        self.number.map_or(Ok(()), |number| write!(f, " pass {number}"))?;
        self.date.as_ref().map_or(Ok(()), |date| write!(f, " on {date}"))
    }
}

impl<'de> Deserialize<'de> for TraversalEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::read(toml::Value::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

/// An entry of the experience axis as written; several generators make several entries.
struct Entries(Vec<ExperienceEntry>);

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let wrong = serde::de::Error::custom::<String>;
        match toml::Value::deserialize(deserializer)? {
            toml::Value::Table(table)
                if ["parent", "generator", "domainness"].iter().any(|k| table.contains_key(*k)) =>
            {
                let table =
                    GeneratedTable::deserialize(table.into_deserializer()).map_err(|error| wrong(reason_of(error)))?;
                let entry = |generator| {
                    let domainness = table.domainness.clone();
                    ExperienceEntry::Generated(GeneratedEntry { parent: table.parent, generator, domainness })
                };
                Ok(Self(table.generator.clone().into_vec().into_iter().map(entry).collect()))
            }
            value => {
                TraversalEntry::read(value).map(|entry| Self(vec![ExperienceEntry::Recorded(entry)])).map_err(wrong)
            }
        }
    }
}

/// Reads the experience axis.
pub(super) fn experiences<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<Spanned<ExperienceEntry>>, D::Error> {
    let entries = Vec::<Spanned<Entries>>::deserialize(deserializer)?;
    let spread = |entries: Spanned<Entries>| {
        let span = entries.span();
        entries.into_inner().0.into_iter().map(move |entry| Spanned::new(span.clone(), entry))
    };
    Ok(entries.into_iter().flat_map(spread).collect())
}

fn reason_of(error: toml::de::Error) -> String {
    error.message().to_owned()
}
