//! SURF against OpenCV's keypoints and descriptors, for every image of the golden folder that has them.

#![allow(clippy::unwrap_used, reason = "a golden file that cannot be read fails the test")]

#[path = "../../../tests/support/golden_data.rs"]
mod golden_data;

use furrow_localiser::surf::{Descriptor, Features, Keypoint, SurfParams, describe, surf};
use furrow_model::GreyImage;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// One image with what OpenCV found in it.
struct Golden {
    name: String,
    image: GreyImage,
    params: SurfParams,
    keypoints: Vec<Keypoint>,
    descriptors: Vec<(usize, Descriptor)>,
}

/// Every `NAME.png` with `NAME_{rot,upright}_keypoints.csv.gz` beside it.
fn golden_sets() -> Vec<Golden> {
    let Some(folder) = golden_data::golden() else { return Vec::new() };
    let mut sets = Vec::new();
    for png in golden_data::files_below(&folder).into_iter().filter(|path| path.extension().is_some_and(|e| e == "png"))
    {
        for (kind, params) in [("rot", SurfParams::GOLDEN), ("upright", SurfParams::GOLDEN_UPRIGHT)] {
            let beside = |part: &str| -> PathBuf {
                let stem = png.file_stem().unwrap().to_string_lossy();
                png.with_file_name(format!("{stem}_{kind}_{part}.csv.gz"))
            };
            let keypoints = beside("keypoints");
            if !keypoints.exists() {
                continue;
            }
            let descriptors = beside("descriptors");
            if !descriptors.exists() {
                eprintln!("SKIPPED: descriptors; there is no {}", descriptors.display());
            }
            let descriptor = |row: Vec<f64>| (row[0] as usize, std::array::from_fn(|i| row[i + 1] as f32));
            sets.push(Golden {
                name: format!("{} {kind}", png.file_stem().unwrap().to_string_lossy()),
                image: read_png(&png),
                params,
                keypoints: rows_of(&keypoints).into_iter().map(|row| keypoint(&row)).collect(),
                descriptors: rows_of(&descriptors).into_iter().map(descriptor).collect(),
            });
        }
    }
    if sets.is_empty() {
        eprintln!("SKIPPED: no NAME.png with NAME_rot_keypoints.csv.gz below {}", folder.display());
    }
    sets
}

fn read_png(path: &Path) -> GreyImage {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Grayscale, png::BitDepth::Eight),
        "{}",
        path.display()
    );
    pixels.truncate(info.buffer_size());
    GreyImage::new(info.width as usize, info.height as usize, pixels).unwrap()
}

/// The numbers of a gzipped CSV file with one header line; none where there is no file.
fn rows_of(path: &Path) -> Vec<Vec<f64>> {
    let Ok(file) = File::open(path) else { return Vec::new() };
    let mut text = String::new();
    flate2::read::GzDecoder::new(file).read_to_string(&mut text).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

fn keypoint(row: &[f64]) -> Keypoint {
    Keypoint {
        x_px: row[1] as f32,
        y_px: row[2] as f32,
        size_px: row[3] as f32,
        angle_deg: row[4] as f32,
        response: row[5] as f32,
        octave: row[6] as u8,
        laplacian_sign: row[7] as i8,
    }
}

/// Place, octave and sign alike: the same blob.
fn is_same_blob(a: &Keypoint, b: &Keypoint) -> bool {
    let near = (a.x_px - b.x_px).abs() <= 0.01 && (a.y_px - b.y_px).abs() <= 0.01;
    near && a.octave == b.octave && a.laplacian_sign == b.laplacian_sign
}

fn share(part: usize, of: usize) -> f64 {
    part as f64 / of.max(1) as f64
}

fn largest_difference(a: &Descriptor, b: &Descriptor) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// At least 99.5 % of the blobs, as many in number, in the same order; of those sizes and angles equal, responses to
/// 4e-7.
#[test]
fn golden_surf_keypoints() {
    for golden in golden_sets() {
        let Features { keypoints, .. } = surf(&golden.image, &golden.params);
        let found = golden.keypoints.iter().filter(|want| keypoints.iter().any(|k| is_same_blob(k, want))).count();
        let same = |alike: &dyn Fn(&Keypoint, &Keypoint) -> bool| {
            keypoints.iter().zip(&golden.keypoints).filter(|(have, want)| alike(have, want)).count()
        };
        let total = golden.keypoints.len();
        let in_place = same(&is_same_blob);
        let sizes = same(&|a, b| a.size_px == b.size_px);
        let angles = same(&|a, b| (a.angle_deg - b.angle_deg).abs() < 1e-3);
        let responses = same(&|a, b| (a.response - b.response).abs() <= 4e-7 * b.response);
        let equal = same(&|a, b| a == b);
        eprintln!(
            "{}: {} keypoints of {total}; found {found}, in order {in_place}, size {sizes}, angle {angles}, response {responses}; bitwise equal {equal}",
            golden.name,
            keypoints.len(),
        );
        assert_eq!(keypoints.len(), total, "{}", golden.name);
        for (what, count) in
            [("found", found), ("order", in_place), ("size", sizes), ("angle", angles), ("response", responses)]
        {
            assert!(share(count, total) >= 0.995, "{}: {what} {count} of {total}", golden.name);
        }
    }
}

/// 99.5 % of the descriptors within 1e-3 in every number, found from the image alone.
#[test]
fn golden_surf_descriptors() {
    for golden in golden_sets() {
        let ours = surf(&golden.image, &golden.params);
        let close = golden.descriptors.iter().filter(|(index, want)| {
            let same = |i: &usize| is_same_blob(&ours.keypoints[*i], &golden.keypoints[*index]);
            let mine = (0..ours.keypoints.len()).find(|i| same(i));
            mine.is_some_and(|i| largest_difference(&ours.descriptors[i], want) <= 1e-3)
        });
        let (close, total) = (close.count(), golden.descriptors.len());
        eprintln!("{}: {close} of {total} descriptors within 1e-3", golden.name);
        assert!(share(close, total) >= 0.995 || total == 0, "{}: {close} of {total}", golden.name);
    }
}

/// Describing OpenCV's own keypoints gives OpenCV's descriptors.
#[test]
fn golden_surf_describe_given_keypoints() {
    for golden in golden_sets() {
        let given: Vec<Keypoint> = golden.descriptors.iter().map(|&(index, _)| golden.keypoints[index]).collect();
        let ours = describe(&golden.image, &given, golden.params.upright);
        let differences = ours.iter().zip(&golden.descriptors).map(|(have, (_, want))| largest_difference(have, want));
        let worst = differences.clone().fold(0.0, f32::max);
        let (close, total) = (differences.filter(|&d| d <= 1e-3).count(), ours.len());
        eprintln!("{}: {close} of {total} descriptors within 1e-3, largest difference {worst:e}", golden.name);
        assert!(share(close, total) >= 0.995 || total == 0, "{}: {close} of {total}", golden.name);
    }
}
