//! Values of a TOML table by their keys, each with its place in the text.

use super::error::{CampaignError, Source};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table whose keys are known ones.
pub(super) struct Section<'a, 't> {
    pub source: &'a Source<'a>,
    table: &'a DeTable<'t>,
}

/// A value where it stands.
pub(super) struct Entry<'a, 't> {
    source: &'a Source<'a>,
    value: &'a Spanned<DeValue<'t>>,
}

/// A `[[pass]]` table over the defaults.
pub(super) struct Layers<'a, 't> {
    pub own: Section<'a, 't>,
    pub defaults: &'a Section<'a, 't>,
    /// Where the `[[pass]]` table begins.
    pub at: usize,
}

impl<'a, 't> Section<'a, 't> {
    /// The table, where all its keys are `known`.
    pub fn new(source: &'a Source<'a>, table: &'a DeTable<'t>, known: &[&str]) -> Result<Self, CampaignError> {
        let strange = table.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        match strange.min_by_key(|key| key.span().start) {
            None => Ok(Section { source, table }),
            Some(key) => Err(source.wrong(
                key.span().start,
                format!("the key '{}'", key.get_ref()),
                nearest(key.get_ref(), known),
            )),
        }
    }

    /// The value of `key` as `read` understands it.
    pub fn get<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Entry) -> Result<T, CampaignError>,
    ) -> Result<Option<T>, CampaignError> {
        self.table.get(key).map(|value| read(&Entry { source: self.source, value })).transpose()
    }

    /// Where the value of `key` stands.
    pub fn at(&self, key: &str) -> Option<usize> {
        self.table.get(key).map(|value| value.span().start)
    }
}

impl Layers<'_, '_> {
    /// The table's own value of `key`, or the default.
    pub fn get<T>(
        &self,
        key: &str,
        read: impl Fn(&Entry) -> Result<T, CampaignError>,
    ) -> Result<Option<T>, CampaignError> {
        Ok(self.own.get(key, &read)?.or(self.defaults.get(key, &read)?))
    }

    /// Where the value of `key` stands, or else the `[[pass]]` table.
    pub fn at(&self, key: &str) -> usize {
        self.own.at(key).or(self.defaults.at(key)).unwrap_or(self.at)
    }
}

impl Entry<'_, '_> {
    /// Where it stands.
    pub fn at(&self) -> usize {
        self.value.span().start
    }

    /// The error that it is not what is `expected`.
    pub fn wrong(&self, expected: impl Into<String>) -> CampaignError {
        self.source.wrong(self.at(), quoted(self.value.get_ref()), expected)
    }

    /// A text that `read` understands.
    pub fn text<T>(&self, expected: &str, read: impl FnOnce(&str) -> Option<T>) -> Result<T, CampaignError> {
        self.value.get_ref().as_str().and_then(read).ok_or_else(|| self.wrong(expected))
    }

    /// One of `names`, as `read` understands it.
    pub fn name<T>(&self, names: &[&str], read: impl FnOnce(&str) -> Option<T>) -> Result<T, CampaignError> {
        let text = self.value.get_ref().as_str();
        text.and_then(read).ok_or_else(|| self.wrong(nearest(text.unwrap_or_default(), names)))
    }

    /// A number, integer or not.
    pub fn number(&self) -> Result<f64, CampaignError> {
        let number = match self.value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => self.whole().ok().map(|whole| whole as f64),
        };
        number.ok_or_else(|| self.wrong("a number"))
    }

    /// An integer.
    pub fn whole(&self) -> Result<i64, CampaignError> {
        let integer = self.value.get_ref().as_integer();
        let whole = integer.and_then(|integer| i64::from_str_radix(integer.as_str(), integer.radix()).ok());
        whole.ok_or_else(|| self.wrong("a whole number"))
    }

    /// `true` or `false`.
    pub fn truth(&self) -> Result<bool, CampaignError> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    /// A list of at least one thing.
    pub fn list<T>(
        &self,
        expected: &str,
        read: impl Fn(&Entry) -> Result<T, CampaignError>,
    ) -> Result<Vec<T>, CampaignError> {
        match self.value.get_ref() {
            DeValue::Array(values) if values.is_empty() => Err(self.source.wrong(self.at(), "an empty list", expected)),
            DeValue::Array(values) => values.iter().map(|value| read(&Entry { source: self.source, value })).collect(),
            _ => Err(self.wrong(expected)),
        }
    }
}

/// A value for an error.
pub(super) fn quoted(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => format!("'{text}'"),
        DeValue::Integer(integer) => integer.to_string(),
        DeValue::Float(float) => float.to_string(),
        DeValue::Boolean(truth) => truth.to_string(),
        other => format!("a value of the kind '{}'", other.type_str()),
    }
}

/// The names, the one first that comes nearest to `wanted` where one comes near.
fn nearest(wanted: &str, names: &[&str]) -> String {
    let likeness = |name: &str| strsim::jaro_winkler(wanted, name);
    let best = names.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    match best {
        Some(best) if likeness(best) > 0.75 => format!("'{best}' perhaps, or another of {}", names.join(", ")),
        _ => format!("one of {}", names.join(", ")),
    }
}
