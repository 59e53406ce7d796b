//! Sequences on disk: `calib.txt`, `poses.txt`, two folders of images. Included by the golden tests.

use crate::golden_data;
use furrow_model::{GreyImage, Se3, StereoRig};
use std::path::{Path, PathBuf};

/// A sequence of rectified pairs with true poses.
pub struct Sequence {
    pub rig: StereoRig,
    /// first_from_camera of each frame.
    pub poses: Vec<Se3>,
    pub pairs: Vec<(PathBuf, PathBuf)>,
}

impl Sequence {
    /// `None`, with a line on stderr, if the folder of `calibration` has another form.
    pub fn open(calibration: &Path) -> Option<Self> {
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

    #[allow(dead_code, reason = "each including test uses its part")]
    pub fn steps(&self) -> impl Iterator<Item = Se3> + '_ {
        self.poses.windows(2).map(|pair| pair[0].inverse().compose(&pair[1]))
    }
}

fn skip<T>(folder: &Path, why: &str) -> Option<T> {
    eprintln!("SKIPPED: {}: {why}", folder.display());
    None
}

/// The lines that hold twelve numbers.
pub fn rows_of_12(file: &Path) -> Vec<[f64; 12]> {
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

/// A grey image from PNG or JPEG.
pub fn decode(file: &Path) -> GreyImage {
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
