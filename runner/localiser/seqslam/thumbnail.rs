//! Small images with their light taken out (Milford and Wyeth 2012, section III.A).

use furrow_model::GreyImage;

/// Columns and rows of a thumbnail, and the side of the patches that are normalised, as in OpenSeqSLAM.
const COLUMNS: usize = 64;
const ROWS: usize = 32;
const PATCH: usize = 8;

/// An image reduced to 64 x 32 pixels by area; in every patch of 8 x 8 pixels the mean is 0 and the standard deviation
/// 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Thumbnail {
    pixels: Vec<f32>,
}

impl Thumbnail {
    /// The thumbnail of `image`; all zeros for an empty image. Patches of one grey are all zeros.
    pub fn of(image: &GreyImage) -> Self {
        let mut pixels = if image.pixels.is_empty() { vec![0.0; COLUMNS * ROWS] } else { reduced(image) };
        for top in (0..ROWS).step_by(PATCH) {
            for left in (0..COLUMNS).step_by(PATCH) {
                normalise_patch(&mut pixels, left, top);
            }
        }
        Self { pixels: pixels.into_iter().map(|pixel| pixel as f32).collect() }
    }

    /// Mean absolute difference of the pixels of two thumbnails where they overlap, the least of all sideways shifts of
    /// up to `shift` of their width.
    pub fn difference(&self, other: &Self, shift: f64) -> f64 {
        let most = ((shift.clamp(0.0, 0.5) * COLUMNS as f64).round()) as usize;
        (1..=most)
            .flat_map(|columns| [self.shifted_difference(other, columns), other.shifted_difference(self, columns)])
            .fold(self.shifted_difference(other, 0), f64::min)
    }

    /// With this thumbnail's column `columns` on the other's column 0.
    fn shifted_difference(&self, other: &Self, columns: usize) -> f64 {
        let rows = self.pixels.chunks_exact(COLUMNS).zip(other.pixels.chunks_exact(COLUMNS));
        let differences = rows.flat_map(|(a, b)| a[columns..].iter().zip(b).map(|(a, b)| f64::from((a - b).abs())));
        differences.sum::<f64>() / (ROWS * (COLUMNS - columns)) as f64
    }
}

/// Means over the rectangles that the image's area falls into.
fn reduced(image: &GreyImage) -> Vec<f64> {
    let across = spans(image.width, COLUMNS);
    let down = spans(image.height, ROWS);
    let mut reduced = Vec::with_capacity(COLUMNS * ROWS);
    for rows in &down {
        for columns in &across {
            let mut sum = 0.0;
            for &(y, row_share) in rows {
                let row = image.row(y);
                sum += row_share * columns.iter().map(|&(x, share)| share * f64::from(row[x])).sum::<f64>();
            }
            reduced.push(sum);
        }
    }
    reduced
}

/// For each of `cells` equal parts of `length` pixels: the pixels it overlaps, and how much of the part each is.
fn spans(length: usize, cells: usize) -> Vec<Vec<(usize, f64)>> {
    let ratio = length as f64 / cells as f64;
    let part = |cell: usize| {
        let (start, end) = (cell as f64 * ratio, (cell + 1) as f64 * ratio);
        let pixels = start.floor() as usize..(end.ceil() as usize).min(length);
        pixels
            .map(|pixel| (pixel, ((end.min(pixel as f64 + 1.0) - start.max(pixel as f64)) / ratio).max(0.0)))
            .collect()
    };
    (0..cells).map(part).collect()
}

fn normalise_patch(pixels: &mut [f64], left: usize, top: usize) {
    let places = || (top..top + PATCH).flat_map(|y| (left..left + PATCH).map(move |x| y * COLUMNS + x));
    let count = (PATCH * PATCH) as f64;
    let mean = places().map(|place| pixels[place]).sum::<f64>() / count;
    let variance = places().map(|place| (pixels[place] - mean) * (pixels[place] - mean)).sum::<f64>() / count;
    // Below a thousandth of a grey level there is only rounding to be enlarged.
    let scale = if variance > 1e-6 { 1.0 / variance.sqrt() } else { 0.0 };
    places().for_each(|place| pixels[place] = (pixels[place] - mean) * scale);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: usize, height: usize, grey: impl Fn(usize, usize) -> usize) -> GreyImage {
        let pixels = (0..width * height).map(|i| (grey(i % width, i / width) % 256) as u8).collect();
        GreyImage::new(width, height, pixels).unwrap()
    }

    /// Brightness and contrast of whole patches do not show; another scene does.
    #[test]
    fn light_is_taken_out() {
        let scene = |x: usize, y: usize| (x / 7 * 31 + y / 5 * 17) % 100;
        let plain = Thumbnail::of(&image(128, 64, scene));
        let brighter = Thumbnail::of(&image(128, 64, |x, y| 2 * scene(x, y) + 20));
        let other = Thumbnail::of(&image(128, 64, |x, y| (x / 5 * 13 + y / 9 * 29) % 100));
        assert!(plain.difference(&brighter, 0.0) < 1e-5, "{}", plain.difference(&brighter, 0.0));
        assert!(plain.difference(&other, 0.0) > 0.3, "{}", plain.difference(&other, 0.0));
        let flat = Thumbnail::of(&image(70, 33, |_, _| 90));
        assert_eq!(flat, Thumbnail::of(&GreyImage::new(0, 0, vec![]).unwrap()));
    }

    /// A view turned by a patch's width is the same view, once it is looked for.
    #[test]
    fn a_turned_view_is_recognised_by_shifting() {
        let scene = |x: usize, y: usize| (x / 3 * 57 + y / 4 * 29 + x * y / 50) % 200;
        let plain = Thumbnail::of(&image(256, 64, scene));
        let turned = Thumbnail::of(&image(256, 64, |x, y| scene(x + 32, y)));
        assert!(plain.difference(&turned, 0.0) > 0.3 && plain.difference(&turned, 7.0 / 64.0) > 0.3);
        for (a, b) in [(&plain, &turned), (&turned, &plain)] {
            assert!(a.difference(b, 8.0 / 64.0) < 1e-6, "{}", a.difference(b, 8.0 / 64.0));
        }
    }

    /// At sizes that are no multiples, against sums over a grid 64 times as fine as the pixels.
    #[test]
    fn pixels_are_area_means() {
        let (width, height) = (101, 47);
        let image = image(width, height, |x, y| x * 37 + y * 91 + x * y);
        let fine = |cell: usize, length: usize, cells: usize, k: usize| {
            ((cell as f64 + (k as f64 + 0.5) / 256.0) * length as f64 / cells as f64) as usize
        };
        let reduced = reduced(&image);
        for (cell, &mean) in reduced.iter().enumerate().step_by(97) {
            let (column, row) = (cell % COLUMNS, cell / COLUMNS);
            let mut sum = 0.0;
            for j in 0..256 {
                for i in 0..256 {
                    sum += f64::from(image.at(fine(column, width, COLUMNS, i), fine(row, height, ROWS, j)));
                }
            }
            assert!((mean - sum / 65_536.0).abs() < 1.0, "cell {cell}: {mean} {}", sum / 65_536.0);
        }
    }
}
