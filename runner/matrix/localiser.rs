//! How places are recognised, as a matrix says it. The reader of the matrix file is given the list of recognisers.

use crate::RunError;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, de::DeserializeOwned};
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::Spanned;

/// A place recogniser as a matrix file knows it.
pub struct Method {
    /// As `method = "…"` spells it, and every outcome.
    pub name: &'static str,
    /// Its own keys in the table `localiser`.
    pub keys: &'static [OwnKey],
    /// What is wrong with the values of its own keys, or with their absence where it is the method.
    pub check: fn(&LocaliserSpec) -> Result<(), Fault>,
}

/// A key of one recogniser.
pub struct OwnKey {
    /// Its name.
    pub name: &'static str,
    /// Whether it is an error beside another method; else it is left aside there.
    pub exclusive: bool,
}

/// The table `localiser`.
#[derive(Debug, Clone)]
pub struct LocaliserSpec {
    /// The place recogniser; empty until the default is filled in.
    pub method: Spanned<String>,
    /// Each experience's best so many places are verified.
    pub candidates: u32,
    /// The folder that files are relative to.
    pub folder: PathBuf,
    /// The recognisers' own keys.
    own: BTreeMap<String, OwnValue>,
}

#[derive(Debug, Clone)]
struct OwnValue {
    at: usize,
    value: toml::Value,
}

/// What is wrong in the table `localiser`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The key.
    pub key: String,
    /// Where in the file, if that is known.
    pub at: Option<usize>,
    /// Why.
    pub reason: String,
}

impl From<Fault> for RunError {
    fn from(fault: Fault) -> Self {
        RunError::Recogniser(fault.reason)
    }
}

impl Default for LocaliserSpec {
    fn default() -> Self {
        let method = Spanned::new(0..0, String::new());
        Self { method, candidates: 1, folder: PathBuf::new(), own: BTreeMap::new() }
    }
}

impl LocaliserSpec {
    /// The method's name.
    pub fn method(&self) -> &str {
        self.method.get_ref()
    }

    /// The value of a recogniser's own key, if the file has it.
    ///
    /// # Errors
    /// Where it has another type.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>, Fault> {
        let Some(own) = self.own.get(key) else { return Ok(None) };
        own.value.clone().try_into().map(Some).map_err(|error| self.fault(key, format!("{key}: {}", error.message())))
    }

    /// What is wrong with a key.
    pub fn fault(&self, key: &str, reason: impl Into<String>) -> Fault {
        Fault { key: key.to_owned(), at: self.own.get(key).map(|own| own.at), reason: reason.into() }
    }

    /// What is wrong, given all place recognisers.
    pub(super) fn check(&self, methods: &[&Method]) -> Result<(), Fault> {
        if self.candidates == 0 {
            return Err(self.fault("candidates", "candidates must be at least 1"));
        }
        self.check_method(methods)?;
        let keys: Vec<&str> = methods.iter().flat_map(|method| method.keys).map(|key| key.name).collect();
        if let Some(strange) = self.own.keys().find(|key| !keys.contains(&key.as_str())) {
            let known = quoted(&[&["method", "candidates"], keys.as_slice()].concat());
            return Err(self.fault(strange, format!("unknown field `{strange}`, expected one of {known}")));
        }
        methods.iter().try_for_each(|method| (method.check)(self))
    }

    /// What is wrong with the method's name.
    pub(super) fn check_method(&self, methods: &[&Method]) -> Result<(), Fault> {
        let names: Vec<&str> = methods.iter().map(|method| method.name).collect();
        if names.contains(&self.method()) {
            return Ok(());
        }
        let reason = format!("unknown method `{}`, expected one of {}", self.method(), quoted(&names));
        Err(Fault { key: "method".to_owned(), at: Some(self.method.span().start), reason })
    }

    /// The key that belongs to another recogniser only.
    pub(super) fn check_owners(&self, methods: &[&Method]) -> Result<(), Fault> {
        for owner in methods.iter().filter(|owner| owner.name != self.method()) {
            let strange = owner.keys.iter().find(|key| key.exclusive && self.own.contains_key(key.name));
            if let Some(OwnKey { name, .. }) = strange {
                let reason =
                    format!("{name} belongs to method = \"{}\", not to \"{}\"", owner.name, self.method.get_ref());
                return Err(self.fault(name, reason));
            }
        }
        Ok(())
    }
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

impl<'de> Deserialize<'de> for LocaliserSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Table)
    }
}

/// Reads the table; own keys are kept for their recognisers.
struct Table;

impl<'de> Visitor<'de> for Table {
    type Value = LocaliserSpec;

    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("a table, as in { method = \"…\", candidates = 1 }")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<LocaliserSpec, A::Error> {
        let mut spec = LocaliserSpec::default();
        while let Some(key) = map.next_key::<Spanned<String>>()? {
            match key.get_ref().as_str() {
                "method" => spec.method = map.next_value()?,
                "candidates" => spec.candidates = map.next_value()?,
                _ => {
                    let own = OwnValue { at: key.span().start, value: map.next_value()? };
                    if spec.own.insert(key.into_inner(), own).is_some() {
                        return Err(A::Error::custom("duplicate key"));
                    }
                }
            }
        }
        Ok(spec)
    }
}
