//! How rosbag2 names the files of a recording: `NAME_0.db3`, `NAME_1.db3` …, and `.zstd` behind it where packed.

use std::path::{Path, PathBuf};

/// The suffixes of rosbag2's files.
const SUFFIXES: [&str; 2] = [".db3", ".mcap"];
/// What is added where they are packed as a whole.
const PACKED: [&str; 2] = [".zstd", ".zst"];

/// The parts of a file's name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct PartName {
    /// What stands before the number.
    stem: String,
    /// The part's number; `None` where the recording was not split.
    number: Option<u64>,
    suffix: &'static str,
    is_packed: bool,
}

impl PartName {
    /// The parts of a name; `None` where it is not of rosbag2. Files that begin with a dot are of other programs.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy();
        let packed = PACKED.iter().find_map(|packed| name.strip_suffix(packed));
        let plain = packed.unwrap_or(&name);
        let suffix = SUFFIXES.into_iter().find(|suffix| plain.to_ascii_lowercase().ends_with(suffix))?;
        let stem = plain.get(..plain.len() - suffix.len()).filter(|stem| !stem.is_empty() && !stem.starts_with('.'))?;
        let numbered = stem.rsplit_once('_').and_then(|(before, digits)| {
            let is_plain = digits == "0" || (!digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit()));
            Some((before, digits.parse().ok().filter(|_| is_plain)?))
        });
        let (stem, number) = numbered.map_or((stem, None), |(before, number)| (before, Some(number)));
        Some(Self { stem: stem.to_owned(), number, suffix, is_packed: packed.is_some() })
    }

    /// Whether two files are the same part, one perhaps packed.
    pub(crate) fn same_recording(one: &Path, other: &Path) -> bool {
        one == other || Self::of(one).zip(Self::of(other)).is_some_and(|(one, other)| one.plain() == other.plain())
    }

    /// The files that a part may lie in, the expanded one first.
    pub(crate) fn twins(part: &Path) -> Vec<PathBuf> {
        let text = part.as_os_str().to_string_lossy().into_owned();
        let plain = PACKED.iter().find_map(|packed| text.strip_suffix(packed)).map(PathBuf::from);
        let packed = PACKED.iter().map(|packed| {
            let mut path = part.as_os_str().to_owned();
            path.push(packed);
            PathBuf::from(path)
        });
        match plain {
            Some(plain) => vec![plain, part.to_owned()],
            None => [part.to_owned()].into_iter().chain(packed).collect(),
        }
    }

    fn plain(&self) -> (&str, Option<u64>, &str) {
        (&self.stem, self.number, self.suffix)
    }
}

/// The parts of one recording in the order of their numbers, and what is noted of these. Of a part that lies there
/// packed and expanded, the expanded file is taken.
///
/// # Errors
/// The names, where they are not those of one recording.
pub(crate) fn in_order(files: Vec<PathBuf>) -> Result<(Vec<PathBuf>, Option<String>), Vec<String>> {
    let mut parts: Vec<(PartName, PathBuf)> =
        files.into_iter().filter_map(|path| Some((PartName::of(&path)?, path))).collect();
    parts.sort_by(|(a, _), (b, _)| (a.plain(), a.is_packed).cmp(&(b.plain(), b.is_packed)));
    parts.dedup_by(|(later, _), (first, _)| later.plain() == first.plain());
    let alike = |(name, _): &(PartName, PathBuf)| {
        name.stem == parts[0].0.stem && name.suffix == parts[0].0.suffix && name.number.is_some()
    };
    if parts.len() > 1 && !parts.iter().all(alike) {
        let name = |(_, path): &(PartName, PathBuf)| path.file_name().unwrap_or_default().display().to_string();
        return Err(parts.iter().map(name).collect());
    }
    let numbers: Vec<u64> = parts.iter().filter_map(|(name, _)| name.number).collect();
    let is_gapless = numbers.iter().zip(0..).all(|(number, expected)| *number == expected);
    let note = (parts.len() > 1 && !is_gapless).then(|| {
        let list: Vec<String> = numbers.iter().map(u64::to_string).collect();
        format!("the parts that are there have the numbers {}: others may be missing", list.join(", "))
    });
    Ok((parts.into_iter().map(|(_, path)| path).collect(), note))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ordered(names: &[&str]) -> Result<Vec<String>, Vec<String>> {
        let files = names.iter().map(PathBuf::from).collect();
        in_order(files).map(|(files, _)| files.iter().map(|file| file.display().to_string()).collect())
    }

    #[test]
    fn parts_come_in_the_order_of_their_numbers() {
        let expected = ["run_0.db3", "run_1.db3", "run_2.db3", "run_10.db3"];
        assert_eq!(ordered(&["run_10.db3", "run_2.db3", "run_0.db3", "run_1.db3"]).unwrap(), expected);
        assert_eq!(
            ordered(&["run_0.db3.zstd", "run_0.db3", "run_1.db3.zstd"]).unwrap(),
            ["run_0.db3", "run_1.db3.zstd"]
        );
        assert_eq!(ordered(&["alone.mcap"]).unwrap(), ["alone.mcap"]);
        let noted = |names: &[&str]| in_order(names.iter().map(PathBuf::from).collect()).unwrap().1;
        assert!(noted(&["a_0.db3", "a_2.db3"]).unwrap().contains("0, 2") && noted(&["a_0.db3", "a_1.db3"]).is_none());
    }

    #[test]
    fn files_of_several_recordings_are_not_one() {
        for names in [
            ["monday.mcap", "tuesday.mcap"],
            ["run_0.mcap", "run_0.db3"],
            ["day-1.mcap", "day-2.mcap"],
            ["2026_06_01.mcap", "2026_06_02.mcap"],
            ["run_0.mcap", "run.mcap"],
        ] {
            assert_eq!(ordered(&names).unwrap_err().len(), 2, "{names:?}");
        }
    }

    #[test]
    fn other_files_are_no_parts() {
        for name in ["metadata.yaml", "a.bag", ".db3", "._run_0.db3", "run_0.db3-wal", "a.zstd", "run_0.db3.gz"] {
            assert_eq!(PartName::of(Path::new(name)), None, "{name}");
        }
        assert!(PartName::same_recording(Path::new("d/a_0.db3.zstd"), Path::new("d/a_0.db3")));
    }
}
