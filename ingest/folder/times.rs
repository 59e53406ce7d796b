//! When a folder's frames were taken.

use super::{FolderError, NOMINAL_INTERVAL_NS, STAMP_DIGITS};
use std::fs;
use std::path::Path;

/// How an image's number becomes a stamp.
pub(super) enum Clock {
    /// Images are named by their stamps.
    Names,
    /// Line i of `times.txt` is frame i.
    Times(Vec<i64>),
    /// No times: [`NOMINAL_INTERVAL_NS`] apart.
    Nominal,
}

impl Clock {
    /// Finds out for a folder whose images have these numbers.
    pub(super) fn of<'a>(
        folder: &Path,
        names: &[String],
        mut numbers: impl Iterator<Item = &'a u64> + Clone,
    ) -> Result<Self, FolderError> {
        if numbers.clone().all(|number| number.to_string().len() >= STAMP_DIGITS) {
            return Ok(Self::Names);
        }
        if let Some(long) = numbers.clone().find(|number| number.to_string().len() >= STAMP_DIGITS) {
            let fault =
                format!("some images are named by frame numbers, but {long} is a stamp: expected one or the other");
            return Err(FolderError::Times { path: folder.to_owned(), fault });
        }
        if !names.iter().any(|name| name == "times.txt") {
            return Ok(Self::Nominal);
        }
        let path = folder.join("times.txt");
        let text =
            fs::read_to_string(&path).map_err(|source| FolderError::Unreadable { path: path.clone(), source })?;
        let stamps = read_times(&text).map_err(|fault| FolderError::Times { path: path.clone(), fault })?;
        if let Some(beyond) = numbers.find(|&&number| number >= stamps.len() as u64) {
            let fault = format!("expected a time for frame {beyond}, found {} lines", stamps.len());
            return Err(FolderError::Times { path, fault });
        }
        Ok(Self::Times(stamps))
    }

    /// The stamp of image `number`, one of those that [`Clock::of`] saw.
    pub(super) fn stamp_ns(&self, number: u64) -> i64 {
        let number = number as i64;
        match self {
            Self::Names => number,
            Self::Times(stamps) => stamps[number as usize],
            Self::Nominal => number * NOMINAL_INTERVAL_NS,
        }
    }

    /// Whether stamps come from the recording.
    pub(super) fn is_recorded(&self) -> bool {
        !matches!(self, Self::Nominal)
    }
}

/// Strictly increasing seconds, one per line, in nanoseconds.
fn read_times(text: &str) -> Result<Vec<i64>, String> {
    let mut stamps: Vec<i64> = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let number = index + 1;
        let stamp = seconds_to_ns(line.trim())
            .ok_or_else(|| format!("line {number} should be a time in seconds, found '{line}'"))?;
        if stamps.last().is_some_and(|&last| last >= stamp) {
            return Err(format!("line {number} ('{line}') is not later than the one before it"));
        }
        stamps.push(stamp);
    }
    Ok(stamps)
}

/// Seconds in decimal or scientific notation; plain decimals keep every digit down to the nanosecond.
fn seconds_to_ns(text: &str) -> Option<i64> {
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    if !whole.is_empty() && digits(whole) && digits(fraction) && fraction.len() <= 9 {
        let nanoseconds: i64 = format!("{fraction:0<9}").parse().ok()?;
        return whole.parse::<i64>().ok()?.checked_mul(1_000_000_000)?.checked_add(nanoseconds);
    }
    let nanoseconds = (text.parse::<f64>().ok()? * 1e9).round();
    (0.0..9e18).contains(&nanoseconds).then_some(nanoseconds as i64)
}

#[cfg(test)]
mod tests {
    use super::{read_times, seconds_to_ns};

    #[test]
    fn seconds_keep_their_nanoseconds() {
        for (text, stamp_ns) in [
            ("0", 0),
            ("0.1", 100_000_000),
            ("1768457151.184334112", 1_768_457_151_184_334_112),
            ("1.036224000e-01", 103_622_400),
            ("0.0000000004", 0),
        ] {
            assert_eq!(seconds_to_ns(text), Some(stamp_ns), "{text}");
        }
        for text in ["", "-1", "nan", "inf", "1e30", "now", "99999999999999999999"] {
            assert_eq!(seconds_to_ns(text), None, "{text}");
        }
    }

    #[test]
    fn times_must_increase() {
        assert_eq!(read_times("0.0\n0.1\n\n0.2\n").unwrap().len(), 3);
        assert!(read_times("0.0\n0.1\n0.1\n").unwrap_err().contains("line 3"));
        assert!(read_times("0.0\nsoon\n").unwrap_err().contains("'soon'"));
    }
}
