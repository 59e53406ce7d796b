//! What no profile may ask: files outside the dataset's folder, numbers beyond reason, both forms of one thing.

use super::profile::{CalibrationPart, ImagesPart, Profile, RowsPart, StampsPart, TruthPart};

/// So many folders above a dataset may be looked into at most.
const MOST_ABOVE: u8 = 3;

/// What is wrong with a profile, in words; nothing where it can be used.
pub(super) fn check_profile(profile: &Profile) -> Result<(), String> {
    match (&profile.images, &profile.recording) {
        (Some(_), Some(_)) => return Err("expected [images] or [recording], found both".to_owned()),
        (None, None) => return Err("expected [images] or [recording], found neither".to_owned()),
        _ => {}
    }
    profile.within.iter().filter(|folder| *folder != ".").try_for_each(|folder| check_path("within", folder))?;
    if let Some(images) = &profile.images {
        check_images(images)?;
    }
    if let Some(recording) = &profile.recording {
        check_paths("recording.files", &recording.files)?;
        recording.beside.iter().try_for_each(|path| check_path("recording.beside", path))?;
        if !profile.sensors.is_empty() {
            return Err("[[sensors]] go with [images]: those of bags are found by their types".to_owned());
        }
    }
    profile.calibration.as_ref().map_or(Ok(()), check_calibration)?;
    profile.truth.as_ref().map_or(Ok(()), |truth| check_truth(truth, profile.images.is_some()))?;
    for sensor in &profile.sensors {
        check_paths("sensors.files", &sensor.files)?;
        sensor.lines.iter().try_for_each(|path| check_path("sensors.lines", path))?;
        if sensor.imu.is_some() == sensor.fix.is_some() {
            return Err(format!("sensor '{}': expected either imu or fix", sensor.name));
        }
    }
    Ok(())
}

fn check_images(images: &ImagesPart) -> Result<(), String> {
    for (name, side) in [("images.left", Some(&images.left)), ("images.right", images.right.as_ref())] {
        let Some(side) = side else { continue };
        check_paths(&format!("{name}.files"), &side.files)?;
        side.lookup_table.iter().try_for_each(|path| check_path(&format!("{name}.lookup_table"), path))?;
        match &side.stamps {
            StampsPart::List { files, .. } | StampsPart::Lines { files, .. } => {
                check_paths(&format!("{name}.stamps.files"), files)?;
            }
            StampsPart::Rate { hertz } if !(*hertz > 0.0 && *hertz <= 1e4) => {
                return Err(format!("{name}.stamps.hertz: expected images a second, above 0 to 10000, found {hertz}"));
            }
            StampsPart::Rate { .. } | StampsPart::Names { .. } | StampsPart::PlaceNames => {}
        }
    }
    Ok(())
}

fn check_calibration(calibration: &CalibrationPart) -> Result<(), String> {
    calibration.files.iter().try_for_each(|path| check_path("calibration.files", path))?;
    calibration.pinhole.iter().try_for_each(|path| check_path("calibration.pinhole", path))?;
    check_above("calibration.above", calibration.above)?;
    let told = [!calibration.files.is_empty(), calibration.text.is_some(), !calibration.pinhole.is_empty()];
    if told.iter().filter(|is_told| **is_told).count() > 1 {
        return Err("calibration: expected one of files, text and pinhole".to_owned());
    }
    if calibration.baseline_m.is_some_and(|metres| !(0.01..=5.0).contains(&metres)) {
        return Err("calibration.baseline_m: expected 0.01 to 5 metres between two cameras".to_owned());
    }
    Ok(())
}

fn check_truth(truth: &TruthPart, has_images: bool) -> Result<(), String> {
    let forms = [truth.rows.is_some(), truth.matrices, truth.place_names];
    if forms.iter().filter(|is_form| **is_form).count() != 1 {
        return Err("truth: expected one of [truth.rows], matrices = true and place_names = true".to_owned());
    }
    if !truth.place_names {
        check_paths("truth.files", &truth.files)?;
    }
    check_above("truth.above", truth.above)?;
    match &truth.rows {
        Some(rows) => check_rows(rows),
        None if has_images => Ok(()),
        None => Err("truth: bags have poses by stamp only: expected [truth.rows]".to_owned()),
    }
}

fn check_rows(rows: &RowsPart) -> Result<(), String> {
    for (name, paths) in [
        ("truth.lines", &rows.lines),
        ("truth.body_from_left_file", &rows.body_from_left_file),
        ("truth.left_from_body_files", &rows.left_from_body_files),
    ] {
        paths.iter().try_for_each(|path| check_path(name, path))?;
    }
    if rows.position.is_some() == rows.geodetic.is_some() {
        return Err("truth: expected either position or geodetic".to_owned());
    }
    if rows.quaternion_xyzw.is_some() && rows.roll_pitch_yaw.is_some() {
        return Err("truth: expected one of quaternion_xyzw and roll_pitch_yaw".to_owned());
    }
    match &rows.body_from_left {
        Some(numbers) if numbers.len() != 16 || !numbers.iter().all(|number| number.is_finite()) => {
            Err(format!("truth.body_from_left: expected 16 numbers, 4x4 by rows, found {}", numbers.len()))
        }
        _ => Ok(()),
    }
}

fn check_paths(key: &str, paths: &[String]) -> Result<(), String> {
    if paths.is_empty() {
        return Err(format!("{key}: expected at least one file, found an empty list"));
    }
    paths.iter().try_for_each(|path| check_path(key, path))
}

/// A path may lead nowhere but down.
fn check_path(key: &str, path: &str) -> Result<(), String> {
    let parts: Vec<&str> = path.split('/').collect();
    let leads_out =
        path.contains('\\') || path.contains(':') || parts.iter().any(|part| matches!(*part, "" | "." | ".."));
    let stars = path.matches('*').count();
    let last = parts.last().copied().unwrap_or_default();
    if leads_out || stars > 1 || (stars == 1 && !last.contains('*')) {
        return Err(format!(
            "{key}: expected a path below the dataset's folder, as in cam0/data/*.png, with at most one * in its last \
             part, found '{path}'"
        ));
    }
    Ok(())
}

fn check_above(key: &str, above: u8) -> Result<(), String> {
    if above > MOST_ABOVE { Err(format!("{key}: expected at most {MOST_ABOVE}, found {above}")) } else { Ok(()) }
}
