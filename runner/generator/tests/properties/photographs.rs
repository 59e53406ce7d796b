//! On real photographs, where there are any.

use crate::quality::judge_all;
use crate::{golden_data, largest_difference, moved, trained};
use furrow_generator::Strengths;
use furrow_model::ColourImage;
use std::path::Path;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

fn photo(path: &Path) -> Option<ColourImage> {
    let options = DecoderOptions::default().jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(std::fs::read(path).ok()?), options);
    let rgb = decoder.decode().ok()?;
    let (width, height) = decoder.dimensions()?;
    Some(ColourImage { width, height, rgb })
}

/// Some JPEG photographs below a folder of the data.
fn photos(folder: &str, count: usize) -> Vec<ColourImage> {
    let Some(data) = golden_data::data() else { return Vec::new() };
    let files = golden_data::files_below(&data.join(folder));
    let found: Vec<ColourImage> = files.iter().filter_map(|file| photo(file)).take(count).collect();
    if found.is_empty() {
        eprintln!("SKIPPED: no photographs in {folder} of {}", data.display());
    }
    found
}

#[test]
fn nothing_moves_at_zero_and_no_z_is_a_jump() {
    let autumn = photos("stromovka_2season_traverse/autumn", 6);
    let snow = photos("stromovka_2season_traverse/winter", 6);
    if autumn.is_empty() || snow.is_empty() {
        return;
    }
    let flow = trained(&autumn, &snow, Strengths::default());
    for image in autumn.iter().chain(&snow) {
        assert!(largest_difference(&moved(&flow, image, 0.0), image) <= 1);
    }
    judge_all(&autumn[0], &snow[0], |z| moved(&flow, &autumn[0], z));
}

#[test]
fn months_and_streets_are_left_alone_at_zero() {
    for folder in ["stromovka_12conditions/images", "kitti_raw_drive_A/image_00"] {
        let found = photos(folder, 8);
        for pair in found.windows(2) {
            let flow = trained(&pair[..1], &pair[1..], Strengths { sensor: 1.0, shadow: 1.0, ..Strengths::default() });
            assert!(largest_difference(&moved(&flow, &pair[0], 0.0), &pair[0]) <= 1);
        }
    }
}
