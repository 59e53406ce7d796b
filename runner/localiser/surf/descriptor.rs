//! Direction and descriptor of a keypoint (Bay et al. 2008, section 4).

use super::integral::Integral;
use super::keypoint::{Descriptor, Keypoint};
use super::orientation::{Compass, gaussian, wavelet_fits};
use super::patch::{PATCH_SIDE, Patch, Shares, reduce};
use super::window::{Quads, Turn, UprightRows};
#[cfg(target_arch = "x86_64")]
use super::window_avx2::TurnedRowsAvx2;
use furrow_model::GreyImage;

/// Gradients along a side of the patch, cells along it, and the Gaussian over the gradients, in units of the scale s.
const GRADIENTS: usize = PATCH_SIDE - 1;
const CELLS: usize = 4;
const CELL_SIDE: usize = GRADIENTS / CELLS;
const SIGMA: f64 = 3.3;
/// The angle that stands for "not turned": up, with y down.
const UPRIGHT_DEG: f32 = 270.0;
/// Windows larger than this are cut; a keypoint would have to be thousands of pixels wide.
const MOST_WINDOW_SIDE: usize = 1 << 15;

/// The pixels that a descriptor is made of, and how they fall into its patch.
enum Window<'a> {
    /// Not turned.
    Upright { x_px: f32, y_px: f32, side: usize, shares: Shares },
    /// Turned.
    Turned { quads: &'a Quads, turn: Turn, side: usize, shares: Shares },
}

/// What describing keypoints of one image needs.
pub(super) struct Describer<'a> {
    image: &'a GreyImage,
    /// What turned windows are sampled from; none where all are upright.
    quads: Option<Quads>,
    compass: Compass,
    gaussian: [f32; GRADIENTS],
}

impl<'a> Describer<'a> {
    pub fn new(image: &'a GreyImage, upright: bool) -> Self {
        let quads = (!upright).then(|| Quads::of(image));
        Self { image, quads, compass: Compass::new(), gaussian: gaussian(SIGMA) }
    }

    /// The keypoint with its direction; `None` where the image behind `integral` has no room for a gradient.
    pub fn orient(&self, integral: &Integral, keypoint: Keypoint) -> Option<Keypoint> {
        if !wavelet_fits(keypoint.size_px, integral) {
            return None;
        }
        let is_upright = self.quads.is_none();
        let angle_deg = if is_upright { UPRIGHT_DEG } else { self.direction_deg(integral, &keypoint)? };
        Some(Keypoint { angle_deg, ..keypoint })
    }

    fn direction_deg(&self, integral: &Integral, keypoint: &Keypoint) -> Option<f32> {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as was just asked.
            return unsafe { self.direction_avx2(integral, keypoint) };
        }
        self.compass.direction_deg(integral, keypoint)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn direction_avx2(&self, integral: &Integral, keypoint: &Keypoint) -> Option<f32> {
        self.compass.direction_deg(integral, keypoint)
    }

    /// The descriptor of a keypoint of any origin.
    pub fn describe(&self, keypoint: &Keypoint) -> Descriptor {
        if self.image.pixels.is_empty() {
            return [0.0; 64];
        }
        let window = self.window(keypoint);
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as was just asked.
            return self.sum_up(&unsafe { self.patch_avx2(&window) });
        }
        self.sum_up(&self.patch(&window))
    }

    /// The window of 21 s around the keypoint, in its direction.
    fn window(&self, keypoint: &Keypoint) -> Window<'_> {
        let (x_px, y_px) = (keypoint.x_px, keypoint.y_px);
        let scale = keypoint.size_px * 1.2 / 9.0;
        let side = ((PATCH_SIDE as f32 * scale) as usize).clamp(PATCH_SIDE, MOST_WINDOW_SIDE);
        let shares = Shares::new(side);
        let Some(quads) = &self.quads else { return Window::Upright { x_px, y_px, side, shares } };
        let turn = Turn::new(x_px, y_px, keypoint.angle_deg * (std::f64::consts::PI / 180.0) as f32, side);
        Window::Turned { quads, turn, side, shares }
    }

    /// The window reduced to 21 x 21.
    #[inline(always)]
    fn patch(&self, window: &Window<'_>) -> Patch {
        match window {
            &Window::Upright { x_px, y_px, side, ref shares } => {
                reduce(shares, |row| UprightRows::new(self.image, x_px, y_px, side, row))
            }
            Window::Turned { quads, turn, side, shares } => reduce(shares, |row| turn.rows(quads, *side, row)),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn patch_avx2(&self, window: &Window<'_>) -> Patch {
        match window {
            Window::Upright { .. } => self.patch(window),
            // SAFETY: this function has AVX2.
            Window::Turned { quads, turn, side, shares } => {
                reduce(shares, |row| unsafe { TurnedRowsAvx2::new(&turn.rows(quads, *side, row)) })
            }
        }
    }

    /// Weighted gradients of the patch, summed in 4 x 4 cells of 5 x 5.
    fn sum_up(&self, patch: &Patch) -> Descriptor {
        let mut descriptor = [0.0_f32; 64];
        let mut square_length = 0.0_f64;
        for (cell, sums) in descriptor.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            for row in (cell / CELLS * CELL_SIDE..).take(CELL_SIDE) {
                for column in (cell % CELLS * CELL_SIDE..).take(CELL_SIDE) {
                    let weight = self.gaussian[row] * self.gaussian[column];
                    let [a, b] = [patch[row][column], patch[row][column + 1]];
                    let [c, d] = [patch[row + 1][column], patch[row + 1][column + 1]];
                    let (dx, dy) = ((b - a + d - c) * weight, (c - a + d - b) * weight);
                    for (sum, part) in sums.iter_mut().zip([dx, dy, dx.abs(), dy.abs()]) {
                        *sum += part;
                    }
                }
            }
            for sum in &*sums {
                square_length += f64::from(sum * sum);
            }
        }
        let scale = (1.0 / (square_length.sqrt() + f64::from(f32::EPSILON))) as f32;
        descriptor.map(|sum| sum * scale)
    }
}
