//! When a folder's frames were taken.

use super::error::FolderError;
use super::layout::NOMINAL_INTERVAL_NS;
use super::numbered::Numbered;
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
    /// The clock of a folder with these images.
    pub(super) fn of<'a>(
        folder: &Path,
        names: &[String],
        sides: impl IntoIterator<Item = &'a Numbered> + Clone,
    ) -> Result<Self, FolderError> {
        let mut kinds = sides.clone().into_iter().map(|side| side.are_stamps);
        let are_stamps = kinds.next().unwrap_or(false);
        if kinds.any(|other| other != are_stamps) {
            let fault =
                "one side's images are named by frame numbers, the other's by stamps: expected names of one kind";
            return Err(FolderError::Times { path: folder.to_owned(), fault: fault.to_owned() });
        }
        if are_stamps {
            return Ok(Self::Names);
        }
        if !names.iter().any(|name| name == "times.txt") {
            return Ok(Self::Nominal);
        }
        let path = folder.join("times.txt");
        let text = fs::read_to_string(&path).map_err(FolderError::unreadable(&path))?;
        let stamps = read_times(&text).map_err(|fault| FolderError::Times { path: path.clone(), fault })?;
        let mut numbers = sides.into_iter().flat_map(|side| side.images.keys());
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

/// Strictly increasing seconds, one per line, in nanoseconds. Comments, a line of letters at the top and the mark at
/// the start that Windows writes are passed over.
fn read_times(text: &str) -> Result<Vec<i64>, String> {
    let mut stamps: Vec<i64> = Vec::new();
    let mut has_header = false;
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() || line.starts_with(['#', '%']) {
            continue;
        }
        if stamps.is_empty() && !has_header && is_header(line) {
            has_header = true;
            continue;
        }
        let stamp = parse_seconds_ns(line).filter(|stamp| *stamp >= 0).ok_or_else(|| {
            let is_long = line.len() > 10 && line.bytes().all(|byte| byte.is_ascii_digit());
            let advice = if is_long { "; a number so large counts smaller units: divide it" } else { "" };
            format!("line {number}: expected a time in seconds, found '{line}'{advice}")
        })?;
        match stamps.last() {
            Some(&last) if last == stamp => {
                return Err(format!(
                    "line {number}: expected a time after the one before it, found the same, '{line}': two frames \
                     have one time; write the second one's own, or take its image and line out"
                ));
            }
            Some(&last) if last > stamp => {
                return Err(format!(
                    "line {number}: expected a time after the one before it, found '{line}': line i is the time of \
                     frame i; where the clock was set back, make a folder of each stretch"
                ));
            }
            _ => stamps.push(stamp),
        }
    }
    Ok(stamps)
}

/// Whether a line names its column, as in `timestamp [s]`: letters, and no number.
fn is_header(line: &str) -> bool {
    let has_letter = line.chars().any(char::is_alphabetic);
    has_letter && !line.chars().any(char::is_numeric) && line.parse::<f64>().is_err()
}

#[cfg(test)]
mod tests {
    use super::read_times;

    #[test]
    fn times_must_increase() {
        assert_eq!(read_times("0.0\n0.1\n\n0.2\n").unwrap().len(), 3);
        let twice = read_times("0.0\n0.1\n0.1\n").unwrap_err();
        assert!(twice.contains("line 3") && twice.contains("the same") && !twice.contains("sort"), "{twice}");
        assert!(read_times("0.0\n0.2\n0.1\n").unwrap_err().contains("set back"));
        assert!(read_times("1700000000000000000\n").unwrap_err().contains("smaller units"));
        assert!(read_times("0.0\nsoon\n").unwrap_err().contains("'soon'"));
        assert!(read_times("-1.0\n").unwrap_err().contains("line 1"));
        for none in ["nan\n0.1\n", "O.0\n0.1\n", "time\nframe\n0.1\n", "0.0,\n"] {
            assert!(read_times(none).is_err(), "{none}");
        }
    }

    #[test]
    fn what_other_programs_write_around_times_is_passed_over() {
        let plain = read_times("0.0\n0.1036\n").unwrap();
        assert_eq!(plain, [0, 103_600_000]);
        for text in [
            "\u{feff}0.0\n0.1036\n",
            "0.0\r\n0.1036\r\n",
            "# seconds\n0.0\n# a pause\n0.1036\n",
            "\u{feff}timestamp [s]\r\n0.0\r\n\r\n0.1036",
            " 0.000000e+00 \n1.036e-01\n",
        ] {
            assert_eq!(read_times(text).unwrap(), plain, "{text:?}");
        }
    }
}
