//! True poses as rows of columns: of any body, with quaternions, angles or neither, in metres or degrees.

use super::error::ImportError;
use super::paths::{file_of, missing};
use super::posture::{along_the_way, body_from_forward_camera, world_from_body};
use super::profile::{RowsPart, Unit};
use super::stamps::{described, numbers_of_rows, parse_stamp, read_lines, stamp_in};
use super::table::{Column, Row, Table, columns, cut, read_text};
use super::utm::{utm_in_zone, utm_of};
use furrow_catalog::images::read_body_from_camera;
use furrow_model::Se3;
use std::path::{Path, PathBuf};

/// What the columns of a row say.
struct Columns {
    stamp: Option<Column>,
    nanoseconds: Option<Column>,
    position: [Column; 3],
    quaternion_xyzw: Option<[Column; 4]>,
    roll_pitch_yaw: Option<[Column; 3]>,
}

impl Columns {
    fn of(table: &Table, rows: &RowsPart) -> Result<Self, ImportError> {
        let none = [String::new(), String::new(), String::new()];
        let position = rows.position.as_ref().or(rows.geodetic.as_ref()).unwrap_or(&none);
        Ok(Self {
            stamp: if rows.lines.is_empty() { Some(table.column(&rows.stamp)?) } else { None },
            nanoseconds: rows.nanoseconds.as_ref().map(|name| table.column(name)).transpose()?,
            position: columns(table, position)?,
            quaternion_xyzw: rows.quaternion_xyzw.as_ref().map(|names| columns(table, names)).transpose()?,
            roll_pitch_yaw: rows.roll_pitch_yaw.as_ref().map(|names| columns(table, names)).transpose()?,
        })
    }
}

/// Reads the poses of rows: stamps ascending, the left camera in the world.
pub(super) fn read_rows(
    root: &Path,
    above: u8,
    rows: &RowsPart,
    files: &[PathBuf],
) -> Result<Vec<(i64, Se3)>, ImportError> {
    let lines = match rows.lines.as_slice() {
        [] => None,
        names => {
            let file =
                file_of(root, 0, names).ok_or_else(|| missing(root, names, "the stamps of the poses stand there"))?;
            Some((read_lines(&file, rows.unit)?, file))
        }
    };
    let numbers = numbers_of_rows(files)?;
    let (mut stamps, mut places, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    for (file, number) in files.iter().zip(numbers) {
        let table = Table::read(file)?;
        let columns = Columns::of(&table, rows)?;
        for (row, number) in table.rows().zip(number..) {
            let stamp_ns = match &lines {
                None => stamp_of(&row, &columns, rows.unit)?,
                Some((lines, list)) => stamp_in(lines, list, number)?,
            };
            match stamps.last() {
                Some(before) if *before == stamp_ns => continue,
                Some(before) if *before > stamp_ns => {
                    return Err(
                        row.wrong("a stamp after that of the row before", format!("{stamp_ns} ns after {before} ns"))
                    );
                }
                _ => {}
            }
            stamps.push(stamp_ns);
            places.push(row.numbers(&columns.position)?);
            turns.push(turn_of(&row, &columns)?);
        }
    }
    let grid_north = if rows.geodetic.is_some() { onto_grid(&mut places, &files[0])? } else { Vec::new() };
    let on_body = body_from_left(root, above, rows)?;
    let mut poses = world_from_left(rows, &places, &turns, on_body);
    if rows.roll_pitch_yaw.is_some() || rows.quaternion_xyzw.is_some() {
        poses.iter_mut().zip(grid_north).for_each(|(pose, angle)| turn_about_itself(pose, angle));
    }
    Ok(stamps.into_iter().zip(poses).collect())
}

/// Latitude, longitude and altitude become metres east, north and up in the UTM zone of the first place, which all
/// traversals of a site share. Returns how far the grid's north lies clockwise from true north at each place, radians.
fn onto_grid(places: &mut [[f64; 3]], file: &Path) -> Result<Vec<f64>, ImportError> {
    let zone = places.first().and_then(|[latitude, longitude, _]| utm_of(*latitude, *longitude)).map(|utm| utm.zone);
    let mut angles = Vec::with_capacity(places.len());
    for [latitude, longitude, altitude] in places {
        let utm = utm_in_zone(*latitude, *longitude, zone).ok_or_else(|| {
            let fault = format!("expected latitude and longitude in degrees, found {latitude}, {longitude}");
            ImportError::file(file, fault)
        })?;
        (*latitude, *longitude, *altitude) = (utm.east_m, utm.north_m, *altitude);
        angles.push(utm.convergence_rad);
    }
    Ok(angles)
}

/// Turns a camera about the vertical through it, radians against the clock as seen from above.
fn turn_about_itself(pose: &mut Se3, angle_rad: f64) {
    let (sin, cos) = libm::sincos(angle_rad);
    let turn = Se3 { rotation: [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]], translation_m: [0.0; 3] };
    pose.rotation = turn.compose(&Se3 { translation_m: [0.0; 3], ..*pose }).rotation;
}

fn stamp_of(row: &Row<'_>, columns: &Columns, unit: Unit) -> Result<i64, ImportError> {
    let word = columns.stamp.map_or(Ok(""), |column| row.word(column))?;
    let parsed = match columns.nanoseconds {
        None => parse_stamp(word, unit),
        Some(column) => {
            let nanos = row.word(column)?.parse::<i64>().ok().filter(|nanos| (0..1_000_000_000).contains(nanos));
            let seconds = word.parse::<i64>().ok().and_then(|seconds| seconds.checked_mul(1_000_000_000));
            seconds.zip(nanos).and_then(|(seconds, nanos)| seconds.checked_add(nanos))
        }
    };
    parsed.ok_or_else(|| row.wrong(described(unit), format!("'{}'", cut(word))))
}

/// How a row's body is turned.
enum Turn {
    Quaternion([f64; 4]),
    Angles([f64; 3]),
    Unknown,
}

fn turn_of(row: &Row<'_>, columns: &Columns) -> Result<Turn, ImportError> {
    if let Some(columns) = &columns.quaternion_xyzw {
        let quaternion = row.numbers(columns)?;
        let norm = quaternion.iter().map(|v| v * v).sum::<f64>().sqrt();
        // Rounded to three digits, a quaternion is off by less than this; in another order or unit it is farther off.
        return if (norm - 1.0).abs() < 0.05 {
            Ok(Turn::Quaternion(quaternion))
        } else {
            Err(row.wrong("a quaternion of length 1", format!("length {norm:.3}")))
        };
    }
    columns.roll_pitch_yaw.as_ref().map_or(Ok(Turn::Unknown), |columns| Ok(Turn::Angles(row.numbers(columns)?)))
}

fn world_from_left(rows: &RowsPart, places: &[[f64; 3]], turns: &[Turn], on_body: Option<Se3>) -> Vec<Se3> {
    if turns.iter().all(|turn| matches!(turn, Turn::Unknown)) {
        return along_the_way(places);
    }
    let pose = |(place, turn): (&[f64; 3], &Turn)| match turn {
        Turn::Quaternion(xyzw) => Se3::from_quaternion(*xyzw, *place).compose(&on_body.unwrap_or(Se3::IDENTITY)),
        Turn::Angles(angles) => {
            let body_from_left = on_body.unwrap_or_else(|| body_from_forward_camera(rows.axes));
            world_from_body(rows.axes, *angles, *place).compose(&body_from_left)
        }
        Turn::Unknown => Se3 { translation_m: *place, ..Se3::IDENTITY },
    };
    places.iter().zip(turns).map(pose).collect()
}

/// The left camera on the body; `None` where the profile does not tell or its files are not there.
fn body_from_left(root: &Path, above: u8, rows: &RowsPart) -> Result<Option<Se3>, ImportError> {
    if let Some(numbers) = &rows.body_from_left
        && let [a, b, c, x, d, e, f, y, g, h, i, z, ..] = numbers[..]
    {
        return Ok(Some(se3([a, b, c, d, e, f, g, h, i], [x, y, z])));
    }
    if let Some(file) = file_of(root, above, &rows.body_from_left_file) {
        return Ok(read_body_from_camera(&file)?.map(|(rotation, translation)| se3(rotation, translation)));
    }
    let mut left_from_body = Se3::IDENTITY;
    for name in &rows.left_from_body_files {
        let Some(file) = file_of(root, above, std::slice::from_ref(name)) else { return Ok(None) };
        left_from_body = left_from_body.compose(&read_kitti_step(&file)?);
    }
    Ok((!rows.left_from_body_files.is_empty()).then(|| left_from_body.inverse()))
}

/// The `R` and `T` of KITTI's `calib_velo_to_cam.txt` and `calib_imu_to_velo.txt`.
fn read_kitti_step(file: &Path) -> Result<Se3, ImportError> {
    let text = read_text(file)?;
    let numbers = |key: &str| -> Option<Vec<f64>> {
        let line = text.lines().find_map(|line| line.trim().strip_prefix(key))?;
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    };
    let rotation = numbers("R:").and_then(|numbers| <[f64; 9]>::try_from(numbers).ok());
    let translation = numbers("T:").and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    let step = rotation.zip(translation).map(|(rotation, translation)| se3(rotation, translation));
    step.ok_or_else(|| ImportError::file(file, "expected lines 'R:' with 9 numbers and 'T:' with 3"))
}

/// A transform from a matrix by rows and a translation.
pub(super) fn se3(r: [f64; 9], translation_m: [f64; 3]) -> Se3 {
    Se3 { rotation: [[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]], translation_m }
}
