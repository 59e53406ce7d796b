//! What lies between the world and the sensors: either nothing but an ideal rectified pair, or the raw lenses.
//!
//! The renderer knows ideal cameras alone. For raw images it renders a wider and finer ideal picture, in the axes of
//! the rectified pair, and every raw pixel averages that picture over the area it sees.

use super::lens::{Lens, projection};
use crate::render::Radiance;
use furrow_model::{CameraCalibration, Distortion, StereoRig};
use rayon::prelude::*;

/// Pixels of the wide picture per pixel of the rectified image, along each side.
const FINER: f64 = 1.5;
/// Pixels of the wide picture beyond what the lenses see.
const MARGIN_PX: f64 = 2.0;

/// The light's way to both sensors.
pub struct Optics {
    rendered: StereoRig,
    calibrations: [CameraCalibration; 2],
    falloff: [Vec<f32>; 2],
    /// `None` where the rendered pictures are the sensors'.
    patches: Option<[Vec<Patch>; 2]>,
}

/// What a raw pixel sees of the wide picture: centre and size, pixels.
#[derive(Debug, Clone, Copy)]
struct Patch {
    centre: [f32; 2],
    size: [f32; 2],
}

impl Optics {
    /// An ideal pair that takes rectified images.
    pub fn rectified(rig: &StereoRig) -> Optics {
        let focal = rig.focal_px as f32;
        let falloff: Vec<f32> = (0..rig.width * rig.height)
            .map(|i| {
                let x = ((i % rig.width) as f32 - rig.cu_px as f32) / focal;
                let y = ((i / rig.width) as f32 - rig.cv_px as f32) / focal;
                vignette(x * x + y * y)
            })
            .collect();
        let calibrations = [0, 1].map(|side| {
            let (f, u, v) = (rig.focal_px, rig.cu_px, rig.cv_px);
            CameraCalibration {
                width: rig.width,
                height: rig.height,
                distortion: Distortion::RadialTangential,
                coefficients: vec![0.0; 5],
                intrinsics: [f, 0.0, u, 0.0, f, v, 0.0, 0.0, 1.0],
                rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                projection: projection(side, rig),
            }
        });
        Optics { rendered: *rig, calibrations, falloff: [falloff.clone(), falloff], patches: None }
    }

    /// The raw lenses of the pair whose rectified images are those of `rig`.
    pub fn raw(rig: &StereoRig) -> Optics {
        let lenses = [0, 1].map(|side| Lens::of(side, rig));
        let rays = lenses.each_ref().map(|lens| {
            (0..rig.width * rig.height)
                .into_par_iter()
                .map(|i| lens.raw_ray(f64::from(i % rig.width), f64::from(i / rig.width)))
                .collect::<Vec<_>>()
        });
        let falloff =
            rays.each_ref().map(|rays| rays.iter().map(|[x, y]| vignette((x * x + y * y) as f32)).collect::<Vec<_>>());
        let seen: [Vec<[f64; 2]>; 2] =
            [0, 1].map(|side| rays[side].iter().map(|&ray| lenses[side].rectified(ray)).collect());
        let rendered = wide(rig, &seen);
        let patches = seen.map(|seen| patches(rig, &rendered, &seen));
        Optics {
            rendered,
            calibrations: lenses.map(|lens| lens.calibration().clone()),
            falloff,
            patches: Some(patches),
        }
    }

    /// The ideal pair that has to be rendered.
    pub fn rendered(&self) -> &StereoRig {
        &self.rendered
    }

    /// What `sensor_msgs/CameraInfo` says of the left and the right camera.
    pub fn calibrations(&self) -> &[CameraCalibration; 2] {
        &self.calibrations
    }

    /// The share of light that reaches each pixel of the sensor on this side (0 left, 1 right), row by row.
    pub fn falloff(&self, side: usize) -> &[f32] {
        &self.falloff[side]
    }

    /// What falls on both sensors where the ideal pair would see `pictures`.
    pub fn focus(&self, pictures: [Radiance; 2]) -> [Radiance; 2] {
        let Some(patches) = &self.patches else { return pictures };
        let (width, height) = (self.calibrations[0].width, self.calibrations[0].height);
        let onto = |side: usize| {
            let pixels = patches[side].par_iter().map(|patch| patch.mean(&pictures[side])).collect();
            Radiance { width, height, pixels, inverse_depth: Vec::new() }
        };
        [onto(0), onto(1)]
    }
}

impl Patch {
    /// The mean of `picture` over the patch, every pixel by the area it shares with it.
    fn mean(&self, picture: &Radiance) -> [f32; 3] {
        let [(left, right), (top, bottom)] = [0, 1].map(|k| {
            let from = self.centre[k] - 0.5 * self.size[k] + 0.5;
            (from, from + self.size[k])
        });
        let share = |cell: usize, from: f32, to: f32| to.min(cell as f32 + 1.0) - from.max(cell as f32);
        let mut sum = [0.0_f32; 3];
        for row in top as usize..bottom.ceil() as usize {
            let tall = share(row, top, bottom);
            let line = &picture.pixels[row * picture.width as usize..];
            for (column, pixel) in line.iter().enumerate().take(right.ceil() as usize).skip(left as usize) {
                let area = tall * share(column, left, right);
                (0..3).for_each(|k| sum[k] += area * pixel[k]);
            }
        }
        sum.map(|s| s / (self.size[0] * self.size[1]))
    }
}

/// The ideal pair that sees all that both lenses see; `seen` are tangents in the rectified axes.
fn wide(rig: &StereoRig, seen: &[Vec<[f64; 2]>; 2]) -> StereoRig {
    let focal = FINER * rig.focal_px;
    let ends = |k: usize| {
        let mut tangents = seen.iter().flatten().map(|ray| ray[k]);
        let first = tangents.next().unwrap_or_default();
        let (low, high) = tangents.fold((first, first), |(low, high), t| (low.min(t), high.max(t)));
        // Half of the outermost patches lies beyond their centres.
        let half = 2.0 * FINER + MARGIN_PX;
        (half - low * focal, ((high - low) * focal + 2.0 * half) as u32 / 2 * 2 + 2)
    };
    let ((cu_px, width), (cv_px, height)) = (ends(0), ends(1));
    StereoRig { width, height, focal_px: focal, cu_px, cv_px, baseline_m: rig.baseline_m }
}

fn patches(rig: &StereoRig, wide: &StereoRig, seen: &[[f64; 2]]) -> Vec<Patch> {
    let (width, height) = (rig.width as usize, rig.height as usize);
    let at = |column: usize, row: usize| {
        let [x, y] = seen[row * width + column];
        [x * wide.focal_px + wide.cu_px, y * wide.focal_px + wide.cv_px]
    };
    let patch = |i: usize| {
        let (column, row) = (i % width, i / width);
        let span = |i: usize, count: usize| (i.saturating_sub(1), (i + 1).min(count - 1));
        let ((left, right), (top, bottom)) = (span(column, width), span(row, height));
        let wide_px = (at(right, row)[0] - at(left, row)[0]) / (right - left) as f64;
        let tall_px = (at(column, bottom)[1] - at(column, top)[1]) / (bottom - top) as f64;
        Patch { centre: at(column, row).map(|c| c as f32), size: [wide_px, tall_px].map(|c| c.max(1.0) as f32) }
    };
    (0..width * height).into_par_iter().map(patch).collect()
}

/// Light that is left towards the corners: 1 - a + a cos^4, a = 0.55, for the squared tangent of the angle to the axis.
fn vignette(tangent_squared: f32) -> f32 {
    let cos2 = 1.0 / (1.0 + tangent_squared);
    0.45 + 0.55 * cos2 * cos2
}
