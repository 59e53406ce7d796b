//! Optimal-transport flow applied to an image: the colours of each cell are moved by its transport map (Gaussian
//! optimal transport; Pitié and Kokaram 2007), interpolated between cells.

use crate::bands::BANDS;
use crate::cells::{COLUMNS, ROWS, between};
use crate::colour::{logarithms, root_of, tables};
use crate::otf::Otf;
use crate::planes::Planes;
use crate::relight::Shading;
use crate::{lanes, shadow};
use furrow_model::ColourImage;
use furrow_model::widest;
use std::ops::Range;

/// What is interpolated from cell to cell: the upper triangle of A_z, the source's mean, the moved mean, the logarithms
/// of the gains at z.
const PARAMETERS: usize = 6 + 3 + 3 + BANDS;
type Parameters = [f32; PARAMETERS];

/// The cells' parameters at one z.
fn parameters(otf: &Otf, z: f64) -> Vec<Parameters> {
    let of_cell = |cell: &crate::otf::CellMap| {
        let a = cell.transport.at(z);
        let moved: [f64; 3] = std::array::from_fn(|i| (1.0 - z) * cell.source[i] + z * cell.target[i]);
        let triangle = [a[0][0], a[0][1], a[0][2], a[1][1], a[1][2], a[2][2]];
        let gains = cell.log_gains.map(|gain| z * gain);
        let mut all = triangle.into_iter().chain(cell.source).chain(moved).chain(gains);
        std::array::from_fn(|_| all.next().unwrap_or(0.0) as f32)
    };
    otf.cells.iter().map(of_cell).collect()
}

/// The image moved by `z`; `planes` already holds it. `shading` is what relights it.
pub(crate) fn flow(otf: &Otf, image: &ColourImage, z: f64, shading: Option<&Shading>, planes: &mut Planes) -> Vec<u8> {
    let cells = parameters(otf, z);
    planes.lift.clear();
    if otf.strengths.shadow > 0.0 {
        shadow::lift(&otf.shades, z * otf.strengths.shadow, planes, image.height);
    }
    if let Some(shading) = shading {
        shading.lift(z * otf.strengths.relight, planes, image.height);
    }
    let gain_of_noise = otf.noise.finest_gain(z * otf.strengths.sensor);
    let mut rgb = vec![0; image.rgb.len()];
    let mut row_cells = [[0.0; PARAMETERS]; COLUMNS];
    for (y, target) in rgb.chunks_exact_mut(3 * image.width).enumerate() {
        let (row, down) = between(y, image.height, ROWS);
        for (i, cell) in row_cells.iter_mut().enumerate() {
            let (above, below) = (&cells[row * COLUMNS + i], &cells[(row + 1) * COLUMNS + i]);
            *cell = std::array::from_fn(|k| above[k] + down * (below[k] - above[k]));
        }
        let source = &image.rgb[3 * y * image.width..3 * (y + 1) * image.width];
        for (columns, column) in &planes.stretches.stretches {
            let ends = (&row_cells[*column], &row_cells[column + 1]);
            let pixels = 3 * columns.start..3 * columns.end;
            let rgb = (&source[pixels.clone()], &mut target[pixels]);
            flow_stretch(planes, ends, gain_of_noise, columns.clone(), y, rgb);
        }
    }
    rgb
}

widest!(fn flow_stretch<'a>(planes: &Planes, ends: (&Parameters, &Parameters), finest: f32, columns: Range<usize>, y: usize, rgb: (&'a [u8], &'a mut [u8])) -> () = flow_stretch_anywhere);

/// Pixels worked on at once.
const LANES: usize = 16;

/// The pixels of a row between two columns of cells.
#[inline(always)]
fn flow_stretch_anywhere(
    planes: &Planes,
    (left, right): (&Parameters, &Parameters),
    finest: f32,
    columns: Range<usize>,
    y: usize,
    (source, target): (&[u8], &mut [u8]),
) {
    let tables = tables();
    let row = y * planes.width;
    let blocks = source.chunks(3 * LANES).zip(target.chunks_mut(3 * LANES));
    for (block, (source, target)) in blocks.enumerate() {
        let (first, pixels) = (columns.start + block * LANES, source.len() / 3);
        let at = row + first;
        let take = |plane: &[f32]| {
            let mut lanes = [0.0; LANES];
            lanes[..pixels].copy_from_slice(&plane[at..at + pixels]);
            lanes
        };
        let (l, o1, o2) = (take(&planes.l), take(&planes.o1), take(&planes.o2));
        let blurs: [[f32; LANES]; BANDS] = [
            take(&planes.pyramid.blurs[0]),
            take(&planes.pyramid.blurs[1]),
            take(&planes.pyramid.blurs[2]),
            take(&planes.pyramid.blurs[3]),
        ];
        let lift = if planes.lift.is_empty() { [0.0; LANES] } else { take(&planes.lift) };
        let mut share = [0.0; LANES];
        share[..pixels].copy_from_slice(&planes.stretches.share[first..first + pixels]);
        let (mut knees, mut kept) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for (i, pixel) in source.as_chunks::<3>().0.iter().enumerate() {
            for c in 0..3 {
                knees[c][i] = tables.knee[usize::from(pixel[c])];
                kept[c][i] = tables.kept[usize::from(pixel[c])];
            }
        }
        let mut roots = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let p = |k: usize| left[k] + share[i] * (right[k] - left[k]);
            let v = [blurs[3][i] - p(6), o1[i] - p(7), o2[i] - p(8)];
            let moved = [
                p(0) * v[0] + p(1) * v[1] + p(2) * v[2] + p(9),
                p(1) * v[0] + p(3) * v[1] + p(4) * v[2] + p(10),
                p(2) * v[0] + p(4) * v[1] + p(5) * v[2] + p(11),
            ];
            let details = (l[i] - blurs[0][i]) * finest * lanes::exp(p(12))
                + (blurs[0][i] - blurs[1][i]) * lanes::exp(p(13))
                + (blurs[1][i] - blurs[2][i]) * lanes::exp(p(14))
                + (blurs[2][i] - blurs[3][i]) * lanes::exp(p(15));
            let logs = logarithms([moved[0] + details + lift[i], moved[1], moved[2]]);
            for c in 0..3 {
                roots[c][i] = root_of(logs[c], knees[c][i], kept[c][i]);
            }
        }
        for (i, pixel) in target.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            *pixel = std::array::from_fn(|c| tables.level[lanes::whole(roots[c][i])]);
        }
    }
}
