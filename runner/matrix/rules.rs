//! Include and exclude rules: which cells of the full product a user wants.

use super::Matrix;
use super::entries::OneOrMany;
use crate::suggest;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

/// What a rule can ask about.
const KEYS: [&str; 8] = ["live", "experience", "words", "images", "keyframes", "method", "threshold", "seed"];

/// Cells by what they are. A key asks for one of several values, in which `*` stands for anything; a rule applies where
/// all its keys do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rule {
    wanted: BTreeMap<String, Vec<String>>,
}

/// What rules ask about a cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Facts {
    values: BTreeMap<&'static str, String>,
}

/// A value as it is written.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Word {
    Text(String),
    Whole(i64),
    Number(f64),
}

impl Facts {
    /// Of the cell of a live slot and a label of the experience axis, in a matrix of one setting.
    pub fn of(matrix: &Matrix, live: &str, experience: &str) -> Self {
        let threshold = matrix.verification.threshold.map_or("calibrated".to_owned(), |inliers| inliers.to_string());
        let values = [
            ("live", live.to_owned()),
            ("experience", experience.to_owned()),
            ("words", matrix.codebook.words.to_string()),
            ("images", matrix.codebook.images.to_string()),
            ("keyframes", matrix.keyframes.distance_m.to_string()),
            ("method", matrix.localiser.method().to_owned()),
            ("threshold", threshold),
            ("seed", matrix.seed.to_string()),
        ];
        Self { values: values.into() }
    }
}

impl Rule {
    fn new(wanted: BTreeMap<String, Vec<String>>) -> Result<Self, String> {
        if wanted.is_empty() {
            return Err(format!("a rule without a key says nothing: expected some of {}", KEYS.join(", ")));
        }
        if let Some(strange) = wanted.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let hint = suggest::nearest(strange, KEYS.into_iter());
            return Err(format!("'{strange}' is no key of a rule{hint}"));
        }
        match wanted.iter().find(|(_, values)| values.is_empty()) {
            Some((key, _)) => Err(format!("'{key}' of a rule is empty: name at least one value")),
            None => Ok(Self { wanted }),
        }
    }

    /// Whether a cell is meant.
    pub fn applies(&self, facts: &Facts) -> bool {
        self.wanted.iter().all(|(key, values)| {
            let fact = facts.values.get(key.as_str()).map_or("", String::as_str);
            values.iter().any(|pattern| fits(pattern, fact))
        })
    }
}

/// Whether a cell is wanted: by some include rule, where there are any, and by no exclude rule. Adds the rules that
/// apply to it to `met`, by their places: include rules first.
pub fn wanted(include: &[Rule], exclude: &[Rule], facts: &Facts, met: &mut BTreeSet<usize>) -> bool {
    let before = include.len();
    let included: Vec<usize> = (0..before).filter(|rule| include[*rule].applies(facts)).collect();
    let excluded: Vec<usize> = (0..exclude.len()).filter(|rule| exclude[*rule].applies(facts)).collect();
    met.extend(included.iter().copied().chain(excluded.iter().map(|rule| before + rule)));
    (include.is_empty() || !included.is_empty()) && excluded.is_empty()
}

/// Whether a text is what a pattern says; `*` stands for any text.
fn fits(pattern: &str, text: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == text,
        Some((before, after)) => text.strip_prefix(before).is_some_and(|rest| {
            let starts = rest.char_indices().map(|(i, _)| i).chain([rest.len()]);
            starts.into_iter().any(|i| fits(after, &rest[i..]))
        }),
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = self.wanted.iter().flat_map(|(key, values)| values.iter().map(move |value| format!("{key}={value}")));
        f.write_str(&all.collect::<Vec<_>>().join(","))
    }
}

/// As the command line writes it: `live=08:00,experience=10:00*`; a key may come several times.
impl FromStr for Rule {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let mut wanted: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for part in text.split(',').filter(|part| !part.trim().is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| {
                format!("'{part}' is no filter: expected KEY=VALUE, as in live=08:00 or experience=10:00*")
            })?;
            wanted.entry(key.trim().to_owned()).or_default().push(value.trim().to_owned());
        }
        Self::new(wanted)
    }
}

impl<'de> Deserialize<'de> for Rule {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let table = BTreeMap::<String, OneOrMany<Word>>::deserialize(deserializer)?;
        let word = |word| match word {
            Word::Text(text) => text,
            Word::Whole(number) => number.to_string(),
            Word::Number(number) => number.to_string(),
        };
        let wanted = table.into_iter().map(|(key, words)| (key, words.into_vec().into_iter().map(word).collect()));
        Self::new(wanted.collect()).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_fit_as_people_expect() {
        for (pattern, text, expected) in [
            ("08:00", "08:00", true),
            ("08:00", "08:00 #2", false),
            ("10:00*", "10:00 as 16:00 (otf z 1)", true),
            ("*otf*1)", "10:00 as 16:00 (otf z 1)", true),
            ("*otf*2)", "10:00 as 16:00 (otf z 1)", false),
            ("*", "", true),
            ("a*a", "a", false),
            ("ü*", "üü", true),
        ] {
            assert_eq!(fits(pattern, text), expected, "{pattern} {text}");
        }
    }

    #[test]
    fn filters_of_the_command_line_are_read() {
        let rule: Rule = "live=08:00,live=10:00, words=600".parse().unwrap();
        let expected = BTreeMap::from([
            ("live".to_owned(), vec!["08:00".to_owned(), "10:00".to_owned()]),
            ("words".to_owned(), vec!["600".to_owned()]),
        ]);
        assert_eq!(rule.wanted, expected);
        assert!("experiense=10:00".parse::<Rule>().unwrap_err().contains("did you mean 'experience'?"));
        assert!("10:00".parse::<Rule>().unwrap_err().contains("KEY=VALUE"));
        assert!("".parse::<Rule>().is_err());
    }
}
