//! When a folder's frames were taken.

use super::error::FolderError;
use super::layout::{NOMINAL_INTERVAL_NS, STAMP_DIGITS};
use furrow_model::parse_seconds_ns;
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
    /// The clock of a folder whose images have these numbers.
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
                format!("some images are named by frame numbers, but {long} is a stamp: expected names of one kind");
            return Err(FolderError::Times { path: folder.to_owned(), fault });
        }
        if !names.iter().any(|name| name == "times.txt") {
            return Ok(Self::Nominal);
        }
        let path = folder.join("times.txt");
        let text = fs::read_to_string(&path).map_err(FolderError::unreadable(&path))?;
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
        let stamp = parse_seconds_ns(line.trim())
            .filter(|stamp| *stamp >= 0)
            .ok_or_else(|| format!("line {number}: expected a time in seconds, found '{line}'"))?;
        if stamps.last().is_some_and(|&last| last >= stamp) {
            return Err(format!("line {number}: expected a time after the one before it, found '{line}'"));
        }
        stamps.push(stamp);
    }
    Ok(stamps)
}

#[cfg(test)]
mod tests {
    use super::read_times;

    #[test]
    fn times_must_increase() {
        assert_eq!(read_times("0.0\n0.1\n\n0.2\n").unwrap().len(), 3);
        assert!(read_times("0.0\n0.1\n0.1\n").unwrap_err().contains("line 3"));
        assert!(read_times("0.0\nsoon\n").unwrap_err().contains("'soon'"));
        assert!(read_times("-1.0\n").unwrap_err().contains("line 1"));
    }
}
