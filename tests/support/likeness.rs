//! What images are like, in a few numbers, so that the simulated field can be held against photographs and another
//! renderer's images. Included by the tests of the field's appearance and by its benchmark.

use furrow_catalog::images::{ColourImage, decode_colour, grey_of, resized};
use furrow_runner::localiser::surf::{SurfParams, detect};
use rayon::prelude::*;
use std::path::Path;

/// All images are looked at in this many columns.
const COLUMNS: usize = 640;

/// Names of the numbers, in their order.
pub const NAMES: [&str; 8] =
    ["keypoints", "gradient", "steep", "shadows", "middle", "lights", "saturation", "hue spread"];

/// SURF keypoints (Hessian 400) on the area of 640x360; median and 90th percentile of the gradient's length, grey
/// levels a pixel; 5th, 50th and 95th percentile of the grey levels; mean saturation (HSV); circular spread of hue
/// weighted by saturation, 0 to 1.
pub type Likeness = [f64; NAMES.len()];

fn percentile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// What one image is like.
pub fn likeness(image: &ColourImage) -> Likeness {
    let rows = image.height * COLUMNS / image.width;
    let image = resized(image, COLUMNS, rows).expect("an image that can be resized");
    let grey = grey_of(&image);
    let at = |u: usize, v: usize| f64::from(grey.row(v)[u]);
    let inner = (1..rows - 1).flat_map(|v| (1..COLUMNS - 1).map(move |u| (u, v)));
    let slope = |(u, v): (usize, usize)| (at(u + 1, v) - at(u - 1, v)).hypot(at(u, v + 1) - at(u, v - 1)) / 2.0;
    let slopes = sorted(inner.map(slope));
    let greys = sorted((0..rows).flat_map(|v| grey.row(v).iter().map(|&value| f64::from(value))));
    let (mut saturation, mut hue) = (0.0, [0.0; 2]);
    for pixel in image.rgb.chunks_exact(3) {
        let [r, g, b] = [0, 1, 2].map(|k| f64::from(pixel[k]));
        saturation += (r.max(g).max(b) - r.min(g).min(b)) / r.max(g).max(b).max(1.0);
        // The chromatic plane: its angle is the hue, its length grows with saturation.
        hue = [hue[0] + r - (g + b) / 2.0, hue[1] + (g - b) * 0.75_f64.sqrt()];
    }
    let chroma: f64 = (image.rgb.chunks_exact(3))
        .map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k])))
        .map(|[r, g, b]| (r - (g + b) / 2.0).hypot((g - b) * 0.75_f64.sqrt()))
        .sum();
    let pixels = (COLUMNS * rows) as f64;
    let keypoints = detect(&grey, &SurfParams::GOLDEN).len() as f64 * (640.0 * 360.0) / pixels;
    [
        keypoints,
        percentile(&slopes, 0.5),
        percentile(&slopes, 0.9),
        percentile(&greys, 0.05),
        percentile(&greys, 0.5),
        percentile(&greys, 0.95),
        saturation / pixels,
        1.0 - hue[0].hypot(hue[1]) / chroma.max(1.0),
    ]
}

/// What the images of a folder are like, in the order of their names; nothing where there is no such folder.
pub fn of_folder(folder: &Path) -> Vec<Likeness> {
    let mut files: Vec<_> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    let image = |path: &std::path::PathBuf| decode_colour(&std::fs::read(path).ok()?, None).ok();
    files.par_iter().filter_map(image).map(|image| likeness(&image)).collect()
}

/// The given percentile of each number.
pub fn each(all: &[Likeness], share: f64) -> Likeness {
    std::array::from_fn(|k| percentile(&sorted(all.iter().map(|one| one[k])), share))
}
