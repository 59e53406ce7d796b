//! Rectification against OpenCV's own numbers.

#[path = "../../tests/support/golden_data.rs"]
mod golden_data;

use furrow_catalog::images::{Rectifier, Side, StereoCalibration, decode_grey, read_calibration_files};
use std::fs;
use std::path::{Path, PathBuf};

const MAP_HEADER: &str = "camera,u,v,source_x,source_y";

/// One row of a map grid: the rectified pixel and the source pixel that it shows.
struct Sample {
    side: Side,
    rectified: [f64; 2],
    source: [f64; 2],
}

/// Every readable `calib_cam_to_cam.txt` of the recordings.
fn calibrations() -> Vec<(PathBuf, StereoCalibration)> {
    let files = golden_data::data().map(|folder| golden_data::files_below(&folder)).unwrap_or_default();
    let named = files.into_iter().filter(|path| path.file_name().is_some_and(|name| name == "calib_cam_to_cam.txt"));
    named.map(|path| (path.clone(), read_calibration_files(&[path], None).expect("a readable calibration"))).collect()
}

fn map_grids() -> Vec<(PathBuf, Vec<Sample>)> {
    let files = golden_data::golden().map(|folder| golden_data::files_below(&folder)).unwrap_or_default();
    let csvs = files.into_iter().filter(|path| path.extension().is_some_and(|extension| extension == "csv"));
    let texts = csvs.map(|path| (fs::read_to_string(&path).expect("a readable CSV"), path));
    texts
        .filter(|(text, _)| text.lines().next() == Some(MAP_HEADER))
        .map(|(text, path)| (path, samples(&text)))
        .collect()
}

fn samples(text: &str) -> Vec<Sample> {
    let rows = text.lines().skip(1).filter(|line| !line.trim().is_empty());
    rows.map(|row| {
        let numbers: Vec<f64> = row.split(',').map(|number| number.trim().parse().expect("a number")).collect();
        let [camera, u, v, x, y] = numbers[..] else { panic!("not five numbers: {row}") };
        Sample { side: if camera == 0.0 { Side::Left } else { Side::Right }, rectified: [u, v], source: [x, y] }
    })
    .collect()
}

/// The largest distance between a grid and a rectifier's map, in pixels.
fn largest_error_px(rectifier: &Rectifier, samples: &[Sample]) -> f64 {
    let errors = samples.iter().map(|Sample { side, rectified: [u, v], source: [x, y] }| {
        rectifier.source_of(*side, *u, *v).map_or(f64::INFINITY, |[found_x, found_y]| (found_x - x).hypot(found_y - y))
    });
    errors.fold(0.0, f64::max)
}

/// The calibration whose maps a grid was made with: the one that fits it best.
fn best_fit(samples: &[Sample]) -> Option<(f64, StereoCalibration)> {
    let fits = calibrations().into_iter().map(|(_, calibration)| {
        (largest_error_px(&Rectifier::from_record(&calibration).expect("a stereo pair"), samples), calibration)
    });
    fits.min_by(|a, b| a.0.total_cmp(&b.0))
}

#[test]
fn golden_rectify_maps() {
    let grids = map_grids();
    if grids.is_empty() {
        eprintln!("SKIPPED: no CSV with the header {MAP_HEADER}");
    }
    for (path, samples) in grids {
        let Some((error_px, _)) = best_fit(&samples) else {
            eprintln!("SKIPPED: no calib_cam_to_cam.txt for {}", path.display());
            continue;
        };
        eprintln!("{}: {} samples, largest error {error_px:.2e} px", path.display(), samples.len());
        assert!(!samples.is_empty() && error_px < 1e-3, "{}: off by up to {error_px} px", path.display());
    }
}

/// `rectified_left_7.png` for `source_left_7.png`.
fn partner(source: &Path) -> Option<(Side, PathBuf)> {
    let name = source.file_name()?.to_str()?;
    let rest = name.strip_prefix("source_")?;
    let side = if rest.starts_with("left_") { Side::Left } else { Side::Right };
    let partner = source.with_file_name(format!("rectified_{rest}"));
    (rest.ends_with(".png") && partner.exists()).then_some((side, partner))
}

#[test]
fn golden_rectify_pixels() {
    let Some(folder) = golden_data::golden() else { return };
    let mut checked = 0;
    for source in golden_data::files_below(&folder) {
        let Some((side, partner)) = partner(&source) else { continue };
        let recorded = decode_grey(&fs::read(&source).unwrap(), None).unwrap();
        let expected = decode_grey(&fs::read(&partner).unwrap(), None).unwrap();
        let shares = calibrations().into_iter().filter_map(|(_, calibration)| {
            let size = Some((expected.width as u32, expected.height as u32));
            let rectifier = Rectifier::from_record(&StereoCalibration { rectified_size: size, ..calibration }).unwrap();
            let found = rectifier.rectify_grey(side, recorded.clone()).ok()?;
            let near = found.pixels.iter().zip(&expected.pixels).filter(|(a, b)| a.abs_diff(**b) <= 1).count();
            let equal = found.pixels.iter().zip(&expected.pixels).filter(|(a, b)| a == b).count();
            Some((near as f64 / expected.pixels.len() as f64, equal as f64 / expected.pixels.len() as f64))
        });
        let Some((near, equal)) = shares.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            eprintln!("SKIPPED: no calib_cam_to_cam.txt for {}", source.display());
            continue;
        };
        eprintln!("{}: {:.4} % within 1 grey level, {:.4} % equal", source.display(), near * 100.0, equal * 100.0);
        assert!(near >= 0.999, "{}: only {:.3} % within 1 grey level", source.display(), near * 100.0);
        checked += 1;
    }
    if checked == 0 {
        eprintln!("SKIPPED: no source_left_*.png with a rectified_left_*.png and a calibration");
    }
}
