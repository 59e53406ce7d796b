//! True poses as a dataset writes them, as poses of the left camera in a world with x east, y north, z up.

use super::error::ImportError;
use super::paths::{files_of, folders};
use super::posture::UP_FROM_CAMERA;
use super::profile::TruthPart;
use super::table::{cut, read_text};
use super::truth_rows::{read_rows, se3};
use furrow_model::Se3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The true poses of a dataset.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedTruth {
    /// The file that they stand in, or the folder of files.
    pub path: PathBuf,
    /// Stamps in nanoseconds, ascending, and the left camera in the world.
    pub poses: Vec<(i64, Se3)>,
}

/// Poses in TUM's form, every digit of a stamp: what the store keeps.
pub fn tum_text(poses: &[(i64, Se3)]) -> String {
    let line = |(stamp_ns, pose): &(i64, Se3)| {
        let [tx, ty, tz] = pose.translation_m;
        let [qx, qy, qz, qw] = pose.quaternion_xyzw();
        let (seconds, nanos) = (stamp_ns.div_euclid(1_000_000_000), stamp_ns.rem_euclid(1_000_000_000));
        format!("{seconds}.{nanos:09} {tx} {ty} {tz} {qx} {qy} {qz} {qw}\n")
    };
    poses.iter().map(line).collect()
}

/// Reads the true poses that a profile names; `None` where the dataset came without. `numbers` are the stamps of the
/// left images by number, for poses that have none of their own.
pub(super) fn read_truth(
    root: &Path,
    part: &TruthPart,
    numbers: &BTreeMap<u64, i64>,
) -> Result<Option<ImportedTruth>, ImportError> {
    let whole = root.canonicalize().unwrap_or_else(|_| root.to_owned());
    let name = whole.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let patterns: Vec<String> = part.files.iter().map(|file| file.replace("{name}", &name)).collect();
    let places = folders(root, part.above).into_iter().map(|folder| files_of(&folder, &patterns));
    let files = places.into_iter().find(|files| !files.is_empty()).unwrap_or_default();
    let Some(first) = files.first() else { return Ok(None) };
    let poses = match &part.rows {
        Some(rows) => read_rows(root, part.above, rows, &files)?,
        None => read_matrices(first, numbers)?,
    };
    if poses.is_empty() {
        return Err(ImportError::file(first, "it holds no pose: is it cut off?"));
    }
    let path = if files.len() > 1 { first.parent().unwrap_or(first) } else { first };
    Ok(Some(ImportedTruth { path: path.to_owned(), poses }))
}

/// KITTI's poses of the first camera: a line of 12 numbers an image.
fn read_matrices(file: &Path, numbers: &BTreeMap<u64, i64>) -> Result<Vec<(i64, Se3)>, ImportError> {
    let text = read_text(file)?;
    let mut poses = Vec::new();
    for (number, (index, line)) in (0..).zip(text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty())) {
        let words: Option<Vec<f64>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
        let matrix =
            words.and_then(|words| <[f64; 12]>::try_from(words).ok()).filter(|m| m.iter().all(|v| v.is_finite()));
        let Some(m) = matrix else {
            let (path, found) = (file.to_owned(), format!("'{}'", cut(line)));
            return Err(ImportError::Line {
                path,
                line: index + 1,
                expected: "the 12 numbers of a pose".to_owned(),
                found,
            });
        };
        let Some(stamp_ns) = numbers.get(&number) else { continue };
        poses.push((
            *stamp_ns,
            UP_FROM_CAMERA.compose(&se3([m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]], [m[3], m[7], m[11]])),
        ));
    }
    Ok(poses)
}
