//! Windows around keypoints: turned ones, sampled between pixels, and upright ones.

use super::patch::{Columns, LANES};
use furrow_model::GreyImage;

/// An image in which the four pixels of a bilinear sample lie side by side: every entry is a pixel (low byte) and the
/// one below it, so two neighbouring entries are the four. Below the last row lies the last row; behind the last entry
/// one more, so that each has a next.
pub(super) struct Quads {
    pub width: usize,
    pub height: usize,
    pub pairs: Vec<u16>,
}

impl Quads {
    pub fn of(image: &GreyImage) -> Self {
        let mut pairs = Vec::with_capacity(image.pixels.len() + 1);
        for y in 0..image.height {
            let below = image.row((y + 1).min(image.height - 1));
            pairs.extend(image.row(y).iter().zip(below).map(|(&pixel, &below)| u16::from_le_bytes([pixel, below])));
        }
        pairs.push(0);
        Self { width: image.width, height: image.height, pairs }
    }

    /// The grey level at (`x`, `y`), between four pixels and rounded; the nearest pixel where one is missing.
    #[inline(always)]
    fn sample(&self, x: i64, y: i64) -> f32 {
        let (last_x, last_y) = (self.width as i32 - 1, self.height as i32 - 1);
        let whole = |value: i64| (value >> 32) as i32;
        let part = |value: i64| (value as u32 >> 1) as f32 * FRACTION;
        let (mut column, mut row, mut right, mut down) = (whole(x), whole(y), part(x), part(y));
        let inside = (0..last_x).contains(&column) && (0..last_y).contains(&row);
        if !inside {
            let nearest = |value: i64, last: i32| whole(value.wrapping_add(HALF)).max(0).min(last);
            (column, row, right, down) = (nearest(x, last_x), nearest(y, last_y), 0.0, 0.0);
        }
        let index = row.wrapping_mul(self.width as i32).wrapping_add(column) as u32;
        let entry = (index as usize).min(self.pairs.len().saturating_sub(2));
        let column = |entry: usize| self.pairs[entry].to_le_bytes().map(f32::from);
        let ([this, below], [beside, across]) = (column(entry), column(entry + 1));
        let (left, up) = (1.0 - right, 1.0 - down);
        let upper = this * left * up + beside * right * up;
        (upper + below * left * down + across * right * down).round_ties_even()
    }
}

/// A square window of `side` pixels around (`x_px`, `y_px`), its first axis turned to `angle_rad`.
pub(super) struct Turn {
    cos: f32,
    sin: f32,
    start_x: f32,
    start_y: f32,
}

impl Turn {
    pub fn new(x_px: f32, y_px: f32, angle_rad: f32, side: usize) -> Self {
        let (sin, cos) = (-libm::sinf(angle_rad), libm::cosf(angle_rad));
        let offset = -(side as f32 - 1.0) / 2.0;
        let start_x = x_px + offset * cos + offset * sin;
        let start_y = y_px - offset * sin + offset * cos;
        Self { cos, sin, start_x, start_y }
    }

    /// Rows `first_row..first_row + 8` of the window of `side`.
    #[inline(always)]
    pub fn rows<'a>(&self, quads: &'a Quads, side: usize, first_row: usize) -> TurnedRows<'a> {
        let (mut start_x, mut start_y) = (self.start_x, self.start_y);
        for _ in 0..first_row {
            start_x += self.sin;
            start_y += self.cos;
        }
        let is_inside = self.is_inside([start_x, start_y], side, quads);
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            (x[lane], y[lane]) = (fixed(start_x), fixed(start_y));
            start_x += self.sin;
            start_y += self.cos;
        }
        TurnedRows { quads, x, y, dx: fixed(self.cos), dy: fixed(-self.sin), is_inside }
    }

    /// Whether all samples of eight rows of `side` from `start` on have their four pixels, with a pixel to spare.
    fn is_inside(&self, [start_x, start_y]: [f32; 2], side: usize, quads: &Quads) -> bool {
        let (columns, rows) = (side as f32, LANES as f32);
        let (right, down) = ([self.cos * columns, -self.sin * columns], [self.sin * rows, self.cos * rows]);
        let fits = |start: f32, a: f32, b: f32, length: usize| {
            start + a.min(0.0) + b.min(0.0) > 1.0 && start + a.max(0.0) + b.max(0.0) < length as f32 - 3.0
        };
        fits(start_x, right[0], down[0], quads.width) && fits(start_y, right[1], down[1], quads.height)
    }
}

/// Pixels in fixed point: whole pixels above, 2^-32 pixels below. Exact for coordinates, and for all but the smallest
/// steps.
fn fixed(pixels: f32) -> i64 {
    (f64::from(pixels) * 4_294_967_296.0) as i64
}

/// One part of the 2^31 in which [`TurnedRows`] counts fractions of a pixel.
pub(super) const FRACTION: f32 = 1.0 / 2_147_483_648.0;
/// Half a pixel in fixed point.
pub(super) const HALF: i64 = 1 << 31;

/// Eight rows of a turned window: where the next sample of each lies, and the step along the rows, in fixed point.
pub(super) struct TurnedRows<'a> {
    pub quads: &'a Quads,
    pub x: [i64; LANES],
    pub y: [i64; LANES],
    pub dx: i64,
    pub dy: i64,
    /// Whether no sample of these rows lacks a pixel.
    pub is_inside: bool,
}

impl Columns for TurnedRows<'_> {
    #[inline(always)]
    fn next_column(&mut self) -> [f32; LANES] {
        std::array::from_fn(|lane| {
            let (x, y) = (self.x[lane], self.y[lane]);
            (self.x[lane], self.y[lane]) = (x.wrapping_add(self.dx), y.wrapping_add(self.dy));
            self.quads.sample(x, y)
        })
    }
}

/// Eight rows of an upright window: rows of the window are columns of the image, read upwards.
pub(super) struct UprightRows<'a> {
    image: &'a GreyImage,
    columns: [usize; LANES],
    /// Whether the columns lie side by side, as they do away from the left and right edge.
    adjacent: bool,
    row: i32,
}

impl<'a> UprightRows<'a> {
    /// Rows `first_row..first_row + 8` of the window of `side` around (`x_px`, `y_px`).
    #[inline(always)]
    pub fn new(image: &'a GreyImage, x_px: f32, y_px: f32, side: usize, first_row: usize) -> Self {
        let offset = -(side as f32 - 1.0) / 2.0;
        let start_x = (x_px + offset).round_ties_even() as i32 + first_row as i32;
        let last = image.width.saturating_sub(1);
        let columns: [usize; LANES] =
            std::array::from_fn(|lane| usize::try_from(start_x + lane as i32).map_or(0, |x| x.min(last)));
        let adjacent = columns[LANES - 1] - columns[0] == LANES - 1;
        Self { image, columns, adjacent, row: (y_px - offset).round_ties_even() as i32 }
    }
}

impl Columns for UprightRows<'_> {
    #[inline(always)]
    fn next_column(&mut self) -> [f32; LANES] {
        let row = usize::try_from(self.row).map_or(0, |y| y.min(self.image.height - 1));
        self.row -= 1;
        let line = self.image.row(row);
        match line[self.columns[0]..].first_chunk::<LANES>() {
            Some(greys) if self.adjacent => greys.map(f32::from),
            _ => self.columns.map(|column| f32::from(line[column])),
        }
    }
}
