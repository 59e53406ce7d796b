//! What each pixel shows, gathered into points to be lit, and the finished pixels made of them.

use super::backdrop::behind_all;
use super::eye::Eye;
use super::gather::{OnFacet, OnGround, facet_points, ground_points};
use super::hills::HILLTOPS;
use super::light::{Points, leaving};
use super::prepare::Prepared;
use super::raster::{NOTHING, Nearest};
use super::stage::Stage;
use crate::lanes::LANES;
use crate::vector::V3;

/// Width of a finished pixel in fine ones.
const COARSE: f32 = 1.5;

/// The finished pixels of a band, and one over the depth of each. Three by three fine pixels make two by two finished
/// ones by the area that they share; where all nine show bare ground or open sky, the four are lit at their own
/// centres, over a footprint that is as much wider.
#[inline(always)]
pub fn shade(stage: &Stage, eye: &Eye, prepared: &[Prepared], nearest: &Nearest) -> (Vec<[f32; 3]>, Vec<f32>) {
    let (blocks, rows) = (nearest.width / 3, nearest.rows / 3);
    let mut pixels = vec![[0.0; 3]; 4 * blocks * rows];
    let mut depths = vec![0.0; 4 * blocks * rows];
    let mut smooth = vec![false; blocks];
    let mut row =
        Row { stage, eye, prepared, facets: Vec::new(), ground: Vec::new(), colours: vec![V3::default(); 9 * blocks] };
    for block_row in 0..rows {
        let y = (nearest.first_row + 3 * block_row) as f32;
        let square = |block: usize| {
            let (corner, place) = (3 * block_row * nearest.width + 3 * block, ((3 * block) as f32, y));
            Square { eye, prepared, nearest, corner, place }
        };
        for (block, smooth) in smooth.iter_mut().enumerate() {
            let square = square(block);
            *smooth = square.is_smooth();
            for k in 0..if *smooth { 4 } else { 9 } {
                let sample = if *smooth { square.coarse(k) } else { square.fine(k) };
                row.add(&sample, 9 * block + k);
            }
        }
        row.light();
        for (block, &smooth) in smooth.iter().enumerate() {
            let colours = &row.colours[9 * block..9 * block + 9];
            let colours = if smooth { [colours[0], colours[1], colours[2], colours[3]] } else { averaged(colours) };
            for (k, colour) in colours.into_iter().enumerate() {
                let i = (2 * block_row + k / 2) * 2 * blocks + 2 * block + k % 2;
                (pixels[i], depths[i]) = (colour.array(), square(block).inverse_depth(k / 2 * 2, k % 2 * 2));
            }
        }
    }
    (pixels, depths)
}

/// Four finished pixels from nine fine ones.
#[inline(always)]
fn averaged(colours: &[V3]) -> [V3; 4] {
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(lower, right)| {
        let at = |row: usize, column: usize| colours[3 * row + column];
        let (wt, wb) = if lower == 0 { (2.0, 1.0) } else { (1.0, 2.0) };
        let (wl, wr) = if right == 0 { (2.0, 1.0) } else { (1.0, 2.0) };
        let upper = at(lower, right) * wl + at(lower, right + 1) * wr;
        let below = at(lower + 1, right) * wl + at(lower + 1, right + 1) * wr;
        (upper * wt + below * wb) * (1.0 / 9.0)
    })
}

/// A place in the picture whose colour is wanted.
struct Sample {
    /// What it shows, or [`NOTHING`].
    index: u32,
    /// Fine column and row.
    x: f32,
    y: f32,
    inverse_depth: f32,
    /// Width of the pixel in fine ones.
    footprint: f32,
}

/// Three by three fine pixels, by the index of the first in the band.
struct Square<'a> {
    eye: &'a Eye,
    prepared: &'a [Prepared<'a>],
    nearest: &'a Nearest,
    corner: usize,
    /// The place of the first pixel: fine column and row.
    place: (f32, f32),
}

impl Square<'_> {
    fn index(&self, row: usize, column: usize) -> u32 {
        self.nearest.index[self.corner + row * self.nearest.width + column]
    }

    /// One over the depth of what a fine pixel shows, 0 for the sky.
    #[inline(always)]
    fn inverse_depth(&self, row: usize, column: usize) -> f32 {
        if self.index(row, column) != NOTHING {
            return self.nearest.inverse_depth[self.corner + row * self.nearest.width + column];
        }
        let (x, y) = self.place;
        // The plane of the ground, where the ray goes down.
        (-self.eye.away(x + column as f32, y + row as f32).z / self.eye.position.z).max(0.0)
    }

    /// Whether nothing but ground, one facet of coarse texture, or the sky above the hills is seen.
    #[inline(always)]
    fn is_smooth(&self) -> bool {
        let first = self.index(0, 0);
        let all = |wanted: &dyn Fn(u32) -> bool| (1..9).all(|k| wanted(self.index(k / 3, k % 3)));
        if first == NOTHING {
            let (x, y) = self.place;
            let away = self.eye.away(x + 1.0, y + 2.0);
            return away.z > HILLTOPS * away.length() && all(&|index| index == NOTHING);
        }
        let facet = &self.prepared[first as usize];
        if facet.ground {
            all(&|index| index != NOTHING && self.prepared[index as usize].ground)
        } else {
            facet.magnified && all(&|index| index == first)
        }
    }

    /// One of four finished pixels. Its centre lies a quarter of a fine pixel inside the middle of its outer fine
    /// pixel.
    #[inline(always)]
    fn coarse(&self, k: usize) -> Sample {
        let (x0, y0) = self.place;
        let (row, column) = (k / 2, k % 2);
        let inside = |k: usize| if k == 0 { 0.25 } else { 1.75 };
        let (x, y) = (x0 + inside(column), y0 + inside(row));
        let index = self.index(2 * row, 2 * column);
        let inverse_depth = match index {
            NOTHING => 0.0,
            index => self.prepared[index as usize].w.at(x, y).max(1e-4),
        };
        Sample { index, x, y, inverse_depth, footprint: COARSE }
    }

    /// One of nine fine pixels.
    #[inline(always)]
    fn fine(&self, k: usize) -> Sample {
        let (x0, y0) = self.place;
        let (row, column) = (k / 3, k % 3);
        Sample {
            index: self.index(row, column),
            x: x0 + column as f32,
            y: y0 + row as f32,
            inverse_depth: self.nearest.inverse_depth[self.corner + row * self.nearest.width + column],
            footprint: 1.0,
        }
    }
}

/// The samples of a row of blocks, nine slots to a block.
struct Row<'a> {
    stage: &'a Stage<'a>,
    eye: &'a Eye,
    prepared: &'a [Prepared<'a>],
    facets: Vec<OnFacet>,
    ground: Vec<OnGround>,
    colours: Vec<V3>,
}

/// Samples that are lit at once.
enum Batch<'a> {
    Facets(&'a [OnFacet]),
    Ground(&'a [OnGround]),
}

impl Row<'_> {
    /// Takes up a sample. What met no facet is the plane of the ground, or the sky.
    #[inline(always)]
    fn add(&mut self, sample: &Sample, slot: usize) {
        let &Sample { index, x, y, inverse_depth, footprint } = sample;
        let seen = self.prepared.get(index as usize);
        if seen.is_some_and(|seen| !seen.ground) {
            self.facets.push(OnFacet { index, slot, x, y, inverse_depth });
            return;
        }
        let away = self.eye.away(x, y);
        let length = away.length();
        let d = away * (1.0 / length);
        let z = if seen.is_some() { 1.0 / inverse_depth } else { -self.eye.position.z / away.z };
        if seen.is_some() || away.z < 0.0 && z * length < 400.0 {
            let normal = seen.map_or(V3::UP, |seen| seen.facet.normal);
            let place = self.eye.position + away * z;
            self.ground.push(OnGround { slot, place, normal, d, distance_m: z * length, footprint });
        } else {
            self.colours[slot] = behind_all(self.stage, self.eye.position, d, footprint / self.eye.focal);
        }
    }

    /// Lights all samples taken up.
    #[inline(always)]
    fn light(&mut self) {
        let mut points = Points::NONE;
        let facets = self.facets.chunks(LANES).map(Batch::Facets);
        for batch in facets.chain(self.ground.chunks(LANES).map(Batch::Ground)) {
            let mut slots = [0; LANES];
            let count = match batch {
                Batch::Facets(samples) => {
                    slots.iter_mut().zip(samples).for_each(|(slot, sample)| *slot = sample.slot);
                    facet_points(self.eye, self.prepared, samples, &mut points);
                    samples.len()
                }
                Batch::Ground(samples) => {
                    slots.iter_mut().zip(samples).for_each(|(slot, sample)| *slot = sample.slot);
                    ground_points(self.stage, self.eye, samples, &mut points);
                    samples.len()
                }
            };
            let radiance = leaving(self.stage, self.eye, &mut points, count);
            slots[..count].iter().enumerate().for_each(|(k, &slot)| self.colours[slot] = radiance.at(k));
        }
        self.facets.clear();
        self.ground.clear();
    }
}
