//! Stamps in the units that datasets use.

use super::error::ImportError;
use super::profile::Unit;
use super::table::{cut, read_text};
use crate::folder::{date_stamp_ns, numbers_of_names};
use furrow_model::parse_seconds_ns;
use std::path::{Path, PathBuf};

/// A stamp in nanoseconds; `None` where the text is none in this unit.
pub(super) fn parse_stamp(text: &str, unit: Unit) -> Option<i64> {
    let text = text.trim();
    match unit {
        Unit::Digits => None,
        Unit::Date => date_stamp_ns(&text.chars().filter(char::is_ascii_digit).collect::<String>()),
        Unit::S => parse_seconds_ns(text),
        Unit::Ms => parse_seconds_ns(&format!("{}e-3", plain(text)?)),
        Unit::Us => parse_seconds_ns(&format!("{}e-6", plain(text)?)),
        Unit::Ns => parse_seconds_ns(&format!("{}e-9", plain(text)?)),
    }
}

/// A number that has no exponent of its own.
fn plain(text: &str) -> Option<&str> {
    (!text.contains(['e', 'E'])).then_some(text)
}

/// What a profile says of a stamp, for errors.
pub(super) fn described(unit: Unit) -> &'static str {
    match unit {
        Unit::Digits => "a stamp whose unit its digits tell",
        Unit::S => "a stamp in seconds",
        Unit::Ms => "a stamp in milliseconds",
        Unit::Us => "a stamp in microseconds",
        Unit::Ns => "a stamp in nanoseconds",
        Unit::Date => "a date and time, as in 2011-09-26 13:02:25.964389445",
    }
}

/// The stamps of a file of one a line.
pub(super) fn read_lines(path: &Path, unit: Unit) -> Result<Vec<i64>, ImportError> {
    let text = read_text(path)?;
    let mut stamps = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.trim();
        if content.is_empty() || content.starts_with(['#', '%']) {
            continue;
        }
        stamps.push(parse_stamp(content, unit).ok_or_else(|| ImportError::Line {
            path: path.to_owned(),
            line: index + 1,
            expected: described(unit).to_owned(),
            found: format!("'{}'", cut(content)),
        })?);
    }
    Ok(stamps)
}

/// The number of the first row of each file: those of the names where there are several, which have one row each.
pub(super) fn numbers_of_rows(files: &[PathBuf]) -> Result<Vec<u64>, ImportError> {
    if files.len() > 1 { Ok(numbers_of_names(files)?) } else { Ok(vec![0; files.len()]) }
}

/// The stamp of a row among those of a list.
pub(super) fn stamp_in(lines: &[i64], list: &Path, number: u64) -> Result<i64, ImportError> {
    let stamp = usize::try_from(number).ok().and_then(|number| lines.get(number)).copied();
    let beyond = || format!("expected a stamp for row {number}, found {} stamps: is it cut off?", lines.len());
    stamp.ok_or_else(|| ImportError::file(list, beyond()))
}
