//! A number of a page, as people and as programs read it.

use crate::wording;
use serde::Serialize;

/// A number as shown, and as it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Datum {
    /// What it is; `good`, `max_lost_m` …
    pub name: &'static str,
    /// All its digits; empty where it does not exist.
    value: String,
    /// As people read it.
    pub text: String,
}

/// A number and how it is written.
#[derive(Debug, Clone, Copy)]
pub(super) enum Number {
    Count(u32),
    /// With one decimal.
    Tenths(f64),
    /// With two decimals.
    Hundredths(f64),
    /// A share between 0 and 1, in percent.
    Share(f64),
}

impl Datum {
    pub fn new(name: &'static str, number: Option<Number>) -> Self {
        let Some(number) = number else { return Self { name, value: String::new(), text: "–".to_owned() } };
        let (value, text) = match number {
            Number::Count(value) => (value.to_string(), wording::count(value)),
            Number::Tenths(value) => (value.to_string(), wording::tenths(value)),
            Number::Hundredths(value) => (value.to_string(), format!("{value:.2}")),
            Number::Share(value) => (value.to_string(), wording::percent(value)),
        };
        Self { name, value, text }
    }

    pub fn count(name: &'static str, value: u32) -> Self {
        Self::new(name, Some(Number::Count(value)))
    }
}
