//! Tables of inertial measurements and satellite fixes beside loose images.

use super::error::ImportError;
use super::paths::{file_of, files_of};
use super::profile::SensorPart;
use super::stamps::{described, numbers_of_rows, parse_stamp, read_lines, stamp_in};
use super::table::{Table, columns, cut};
use std::path::{Path, PathBuf};

/// The measurements of one sensor, in the file's order.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorSeries {
    /// What the profile calls it.
    pub name: String,
    /// Inertial measurements: turn rates in rad/s, accelerations in m/s².
    pub imu: Vec<(i64, [f64; 6])>,
    /// Fixes: latitude and longitude in degrees, altitude in metres.
    pub fixes: Vec<(i64, [f64; 3])>,
}

/// Reads a sensor's table and says which files it stands in; `None` where the dataset came without.
pub(super) fn read_sensor(root: &Path, part: &SensorPart) -> Result<Option<(SensorSeries, Vec<PathBuf>)>, ImportError> {
    let mut files = files_of(root, &part.files);
    if files.is_empty() {
        return Ok(None);
    }
    let list = file_of(root, 0, &part.lines);
    if !part.lines.is_empty() && list.is_none() {
        return Ok(None);
    }
    let lines = list.as_deref().map(|list| read_lines(list, part.unit)).transpose()?;
    let mut series = SensorSeries { name: part.name.clone(), imu: Vec::new(), fixes: Vec::new() };
    let numbers = if lines.is_some() { numbers_of_rows(&files)? } else { vec![0; files.len()] };
    for (file, number) in files.iter().zip(numbers) {
        let table = Table::read(file)?;
        let stamp = if lines.is_some() { None } else { Some(table.column(&part.stamp)?) };
        let imu = part.imu.as_ref().map(|names| columns(&table, names)).transpose()?;
        let fix = part.fix.as_ref().map(|names| columns(&table, names)).transpose()?;
        for (row, number) in table.rows().zip(number..) {
            let stamp_ns = match (&lines, &list, stamp) {
                (Some(lines), Some(list), _) => stamp_in(lines, list, number)?,
                (_, _, Some(stamp)) => {
                    let word = row.word(stamp)?;
                    let wrong = || row.wrong(described(part.unit), format!("'{}'", cut(word)));
                    parse_stamp(word, part.unit).ok_or_else(wrong)?
                }
                _ => continue,
            };
            if let Some(columns) = &imu {
                series.imu.push((stamp_ns, row.numbers(columns)?));
            }
            if let Some(columns) = &fix {
                series.fixes.push((stamp_ns, row.numbers(columns)?));
            }
        }
    }
    files.extend(list);
    Ok(Some((series, files)))
}
