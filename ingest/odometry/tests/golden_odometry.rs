//! Odometry on every real sequence with known poses that the data folder holds: folders with `calib.txt` (two 3x4 projections),
//! `poses.txt` (a 3x4 pose per line) and two folders of images.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../../tests/golden_data.rs"]
mod golden_data;

use furrow_model::{GreyImage, Se3, StereoRig};
use furrow_odometry::{Odometry, OdometryParams};
use std::path::{Path, PathBuf};

#[test]
fn golden_odometry_ends_near_the_true_pose() {
    let Some(data) = golden_data::data() else { return };
    let mut tried = 0;
    for calibration in golden_data::files_below(&data).iter().filter(|file| file.ends_with("calib.txt")) {
        let Some(sequence) = Sequence::open(calibration) else { continue };
        let (error_m, failed) = end_error(&sequence);
        let length_m: f64 = sequence.steps().map(|step| step.distance_m()).sum();
        let percent = 100.0 * error_m / length_m;
        eprintln!("{}: end error {error_m:.3} m, {percent:.2} % of {length_m:.1} m", calibration.display());
        assert_eq!(failed, 0, "failed steps");
        assert!(percent <= 1.5, "end error {percent} %");
        for (file, peer_m) in peer_end_errors(sequence.poses.len(), length_m) {
            assert!(error_m <= 1.1 * peer_m, "{error_m} m, but {file:?} has a median of {peer_m} m");
        }
        tried += 1;
    }
    if tried == 0 {
        eprintln!("SKIPPED: no folder of {} holds calib.txt, poses.txt and two image folders", data.display());
    }
}

struct Sequence {
    rig: StereoRig,
    poses: Vec<Se3>,
    pairs: Vec<(PathBuf, PathBuf)>,
}

impl Sequence {
    /// `None`, with a line on stderr, where the folder of `calibration` has another form.
    fn open(calibration: &Path) -> Option<Self> {
        let folder = calibration.parent()?;
        let [left, right] = &rows_of_12(calibration)[..] else {
            return skip(folder, "calib.txt is not two projections");
        };
        let poses: Vec<Se3> = rows_of_12(&folder.join("poses.txt")).iter().map(pose).collect();
        let mut images: Vec<PathBuf> = std::fs::read_dir(folder).ok()?.flatten().map(|e| e.path()).collect();
        images.retain(|path| path.is_dir());
        images.sort();
        let [left_images, right_images] = &images[..] else { return skip(folder, "not two image folders") };
        let (left_files, right_files) = (golden_data::files_below(left_images), golden_data::files_below(right_images));
        if poses.len() < 2 || left_files.len() != poses.len() || right_files.len() != poses.len() {
            return skip(folder, "poses and images differ in number");
        }
        let first = decode(&left_files[0]);
        let rig = StereoRig {
            width: first.width as u32,
            height: first.height as u32,
            focal_px: left[0],
            cu_px: left[2],
            cv_px: left[6],
            baseline_m: -right[3] / right[0],
        };
        Some(Self { rig, poses, pairs: left_files.into_iter().zip(right_files).collect() })
    }

    fn steps(&self) -> impl Iterator<Item = Se3> + '_ {
        self.poses.windows(2).map(|pair| pair[0].inverse().compose(&pair[1]))
    }
}

fn skip<T>(folder: &Path, why: &str) -> Option<T> {
    eprintln!("SKIPPED: {}: {why}", folder.display());
    None
}

fn rows_of_12(file: &Path) -> Vec<[f64; 12]> {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        <[f64; 12]>::try_from(numbers).ok()
    };
    text.lines().filter_map(row).collect()
}

fn pose(row: &[f64; 12]) -> Se3 {
    let at = |i: usize, j: usize| row[4 * i + j];
    Se3 {
        rotation: std::array::from_fn(|i| std::array::from_fn(|j| at(i, j))),
        translation_m: std::array::from_fn(|i| at(i, 3)),
    }
}

/// Distance between the last position found and the true one, both from the first frame, and the number of failed steps.
fn end_error(sequence: &Sequence) -> (f64, usize) {
    let mut odometry = Odometry::new(sequence.rig, OdometryParams::default());
    let (mut first_from_here, mut failed) = (Se3::IDENTITY, 0);
    for (left, right) in &sequence.pairs {
        match odometry.push(&decode(left), &decode(right)) {
            None => {}
            Some(Ok(motion)) => first_from_here = first_from_here.compose(&motion.previous_from_current),
            Some(Err(failure)) => {
                eprintln!("{}: {failure}", left.display());
                failed += 1;
            }
        }
    }
    let truth = sequence.poses[0].inverse().compose(&sequence.poses[sequence.poses.len() - 1]);
    (truth.inverse().compose(&first_from_here).distance_m(), failed)
}

/// Median end error over seeds, from every table of the peer's default settings that belongs to a sequence of as many frames and the same length.
fn peer_end_errors(frames: usize, length_m: f64) -> Vec<(PathBuf, f64)> {
    let Some(golden) = golden_data::golden() else { return Vec::new() };
    let mut found = Vec::new();
    for file in golden_data::files_below(&golden) {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some(prefix) = name.strip_suffix("_default_errors.csv") else { continue };
        let poses = rows_of_12(&file.with_file_name(format!("{prefix}_default_poses.txt")));
        let text = std::fs::read_to_string(&file).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let header = lines.next().unwrap();
        let column = |name: &str| header.iter().position(|field| *field == name);
        let (Some(length), Some(error)) = (column("path_length_m"), column("end_error_m")) else { continue };
        let rows: Vec<[f64; 2]> = lines.map(|row| [length, error].map(|i| row[i].parse().unwrap())).collect();
        let mut errors: Vec<f64> =
            rows.iter().filter(|row| (row[0] - length_m).abs() < 0.01).map(|row| row[1]).collect();
        errors.sort_by(f64::total_cmp);
        if poses.len() == frames && !errors.is_empty() {
            let median = (errors[(errors.len() - 1) / 2] + errors[errors.len() / 2]) / 2.0;
            found.push((file, median));
        }
    }
    found
}

fn decode(file: &Path) -> GreyImage {
    use zune_jpeg::zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
    let bytes = std::fs::read(file).unwrap();
    if bytes.starts_with(b"\x89PNG") {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let samples = info.color_type.samples();
        let grey = pixels[..info.buffer_size()].chunks_exact(samples).map(|p| match p {
            [r, g, b, ..] => ((299 * u32::from(*r) + 587 * u32::from(*g) + 114 * u32::from(*b) + 500) / 1000) as u8,
            _ => p[0],
        });
        return GreyImage::new(info.width as usize, info.height as usize, grey.collect()).unwrap();
    }
    let options = DecoderOptions::default().jpeg_set_out_colorspace(ColorSpace::Luma);
    let mut decoder = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let pixels = decoder.decode().unwrap();
    let (width, height) = decoder.dimensions().unwrap();
    GreyImage::new(width, height, pixels).unwrap()
}
