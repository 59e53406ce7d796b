//! The illumination-invariant image (Maddern et al. 2014, "Illumination invariant imaging"): one number per pixel that,
//! for a camera with narrow bands under light of any colour temperature, depends on the surface alone.

use furrow_model::ColourImage;
use serde::{Deserialize, Serialize};

/// How invariant images are made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Invariant {
    /// The share of blue: 1 / l2 = alpha / l1 + (1 - alpha) / l3 for the camera's peak wavelengths of blue l1, green
    /// l2, red l3.
    pub alpha: f64,
}

impl Default for Invariant {
    /// Peaks at 450, 540 and 610 nm, usual for a colour sensor with an infrared filter.
    fn default() -> Self {
        Self { alpha: (1.0 / 540.0 - 1.0 / 610.0) / (1.0 / 450.0 - 1.0 / 610.0) }
    }
}

/// What keeps black's logarithm finite, in linear light.
const FLOOR: f32 = 7.8e-4;

impl Invariant {
    /// 0.5 + ln G - alpha ln B - (1 - alpha) ln R in every channel (Eq 2 of the paper), blended with the image by `z`.
    pub(crate) fn apply(&self, image: &ColourImage, z: f64) -> Vec<u8> {
        let logs: [f32; 256] = std::array::from_fn(|level| libm::logf(crate::colour::light(level as u8) + FLOOR));
        let (alpha, z) = (self.alpha as f32, z as f32);
        let pixel = |rgb: &[u8; 3]| {
            let [r, g, b] = rgb.map(|level| logs[usize::from(level)]);
            let invariant = 255.0 * (0.5 + g - alpha * b - (1.0 - alpha) * r).clamp(0.0, 1.0);
            rgb.map(|level| (f32::from(level) + z * (invariant - f32::from(level)) + 0.5).clamp(0.0, 255.0) as u8)
        };
        image.rgb.as_chunks::<3>().0.iter().flat_map(pixel).collect()
    }
}
