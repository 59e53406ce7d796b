//! The images of one camera, with their stamps.

use super::error::ImportError;
use super::paths::{file_of, files_of, missing};
use super::profile::{SidePart, StampsPart, Unit};
use super::stamps::{described, parse_stamp, read_lines};
use super::table::Table;
use super::vpr::stamps_of_places;
use crate::folder::{numbers_of_names, stamps_of_names};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The images of one camera.
#[derive(Debug, Default)]
pub(super) struct SideImages {
    /// By stamp, nanoseconds.
    pub(super) images: BTreeMap<u64, PathBuf>,
    /// The stamp of each image's number: that of its name where stamps stand in lines, else its place, from 0.
    pub(super) numbers: BTreeMap<u64, i64>,
    /// Lists that were read, beside the images.
    pub(super) lists: Vec<PathBuf>,
    /// What was unusual, a sentence each.
    pub(super) notes: Vec<String>,
}

/// Finds the images of a side and their stamps.
pub(super) fn side_images(root: &Path, side: &SidePart) -> Result<SideImages, ImportError> {
    let files = files_of(root, &side.files);
    if files.is_empty() {
        return Err(missing(root, &side.files, "name the folder that holds them, or write a profile of your own"));
    }
    let mut found = SideImages::default();
    let stamped = match &side.stamps {
        StampsPart::Names { unit: Unit::Digits } => stamps_of_names(&files)?.into_iter().zip(files).collect(),
        StampsPart::Names { unit } => by_name(files, *unit)?,
        StampsPart::List { files: lists, unit, stamp, name } => {
            let list = list_of(root, lists)?;
            found.lists.push(list.clone());
            by_list(&list, files, *unit, [stamp, name], &mut found.notes)?
        }
        StampsPart::Lines { files: lists, unit } => {
            let list = list_of(root, lists)?;
            found.lists.push(list.clone());
            return by_line(&list, files, *unit, found);
        }
        StampsPart::Rate { hertz } => {
            let stamp = |place: usize| (place as f64 * 1e9 / hertz).round() as i64;
            files.into_iter().enumerate().map(|(place, path)| (stamp(place), path)).collect()
        }
        StampsPart::PlaceNames => stamps_of_places(&files)?.into_iter().zip(files).collect(),
    };
    for (stamp_ns, path) in stamped {
        found.add(None, stamp_ns, path)?;
    }
    found.numbers = (0..).zip(found.images.keys().map(|stamp| stamp.cast_signed())).collect();
    Ok(found)
}

impl SideImages {
    fn add(&mut self, number: Option<u64>, stamp_ns: i64, path: PathBuf) -> Result<(), ImportError> {
        if stamp_ns < 0 {
            return Err(ImportError::file(&path, format!("expected a stamp of 0 or later, found {stamp_ns} ns")));
        }
        if let Some(number) = number {
            self.numbers.insert(number, stamp_ns);
        }
        if let Some(first) = self.images.insert(stamp_ns.cast_unsigned(), path.clone()) {
            let fault = format!("it has the stamp of {}, {stamp_ns} ns: expected one image a moment", first.display());
            return Err(ImportError::file(&path, fault));
        }
        Ok(())
    }
}

fn list_of(root: &Path, lists: &[String]) -> Result<PathBuf, ImportError> {
    file_of(root, 0, lists).ok_or_else(|| missing(root, lists, "the stamps stand there: download it, too"))
}

/// Stamps of one unit in the last number of each name.
fn by_name(files: Vec<PathBuf>, unit: Unit) -> Result<Vec<(i64, PathBuf)>, ImportError> {
    let stamp = |path: PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut numbers = stem.rsplit(|c: char| !(c.is_ascii_digit() || c == '.')).filter(|part| !part.is_empty());
        let whole = (unit == Unit::Date).then_some(stem.as_str());
        let found = whole.or_else(|| numbers.next()).and_then(|number| parse_stamp(number, unit));
        let wrong = || ImportError::file(&path, format!("expected {} in its name", described(unit)));
        Ok((found.ok_or_else(wrong)?, path))
    };
    files.into_iter().map(stamp).collect()
}

/// A line for each image. Files are matched by their names alone, so that a list leads nowhere else.
fn by_list(
    list: &Path,
    files: Vec<PathBuf>,
    unit: Unit,
    [stamp, name]: [&String; 2],
    notes: &mut Vec<String>,
) -> Result<Vec<(i64, PathBuf)>, ImportError> {
    let mut there: BTreeMap<String, PathBuf> = files.into_iter().map(|path| (last_part(&path), path)).collect();
    let images = there.len();
    let table = Table::read(list)?;
    let (stamp, name) = (table.column(stamp)?, table.column(name)?);
    let (mut stamped, mut lost): (Vec<(i64, PathBuf)>, Vec<String>) = (Vec::new(), Vec::new());
    for row in table.rows() {
        let word = row.word(stamp)?;
        let stamp_ns = parse_stamp(word, unit).ok_or_else(|| row.wrong(described(unit), format!("'{word}'")))?;
        let named = row.word(name)?;
        if named.is_empty() {
            return Err(row.wrong("the name of an image", "nothing".to_owned()));
        }
        if let Some((before, _)) = stamped.last().filter(|(before, _)| *before >= stamp_ns) {
            return Err(row.wrong("a stamp after that of the line before", format!("{stamp_ns} ns after {before} ns")));
        }
        match there.remove(&last_part(Path::new(named))) {
            Some(path) => stamped.push((stamp_ns, path)),
            None => lost.push(named.to_owned()),
        }
    }
    if lost.len() > stamped.len() {
        let fault = format!(
            "{} of its {} images are not there, the first {}: was the download whole, and is the profile's column of names right?",
            lost.len(),
            lost.len() + stamped.len(),
            lost[0]
        );
        return Err(ImportError::file(list, fault));
    }
    let list = list.display();
    let not_there = |first: &String| format!("images of {list} that are not there: {}, the first {first}", lost.len());
    notes.extend(lost.first().map(not_there));
    let left = there.len();
    notes.extend((left > 0).then(|| format!("images that are not in {list} and are left out: {left} of {images}")));
    Ok(stamped)
}

/// The stamp of the image with number i in line i.
fn by_line(list: &Path, files: Vec<PathBuf>, unit: Unit, mut found: SideImages) -> Result<SideImages, ImportError> {
    let stamps = read_lines(list, unit)?;
    if let Some(at) = stamps.windows(2).position(|pair| pair[0] >= pair[1]) {
        let (before, after) = (stamps[at], stamps[at + 1]);
        let fault =
            format!("stamp {} is {after} ns, not after the {before} ns before it: expected one for each image", at + 2);
        return Err(ImportError::file(list, fault));
    }
    for (number, path) in numbers_of_names(&files)?.into_iter().zip(files) {
        let stamp = usize::try_from(number).ok().and_then(|number| stamps.get(number)).copied();
        let beyond =
            || format!("expected a stamp for image {}, found {} stamps: is it cut off?", path.display(), stamps.len());
        let stamp_ns = stamp.ok_or_else(|| ImportError::file(list, beyond()))?;
        found.add(Some(number), stamp_ns, path)?;
    }
    Ok(found)
}

fn last_part(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
