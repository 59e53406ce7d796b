//! Placebos (SPEC 3.3): changes that know nothing of any hour. A set of generated experiences that does no better than as many of these
//! was lucky among many, no more.

use crate::Generator;
use crate::bands::{Blur, sigma_px};
use crate::sensor::add_noise;
use furrow_model::ColourImage;

/// Exponents, deviations and widths of further placebos move away from the first ones by this each time round.
const STEP: f64 = 0.1;

/// `n` different placebos: gamma 0.8, gamma 1.25, noise of 3 grey levels, a blur of 0.8 pixels, then the same a little stronger.
pub fn placebo_set(n: usize) -> Vec<Generator> {
    let placebo = |i: usize| {
        let more = 1.0 + STEP * (i / 4) as f64;
        // Rounded, so that names are short.
        let rounded = |value: f64| (value * 1000.0).round() / 1000.0;
        match i % 4 {
            0 => Generator::Gamma(rounded(0.8 / more)),
            1 => Generator::Gamma(rounded(1.25 * more)),
            2 => Generator::Noise(rounded(3.0 * more)),
            _ => Generator::Blur(rounded(0.8 * more)),
        }
    };
    (0..n).map(placebo).collect()
}

/// Grey levels to the power of `exponent`.
pub(crate) fn gamma(image: &ColourImage, exponent: f64) -> Vec<u8> {
    let level = |level: usize| (255.0 * libm::pow(level as f64 / 255.0, exponent)).round() as u8;
    let table: [u8; 256] = std::array::from_fn(level);
    image.rgb.iter().map(|value| table[usize::from(*value)]).collect()
}

/// Independent noise on every value.
pub(crate) fn noise(image: &ColourImage, deviation: f64, seed: u64) -> Vec<u8> {
    let mut rgb = image.rgb.clone();
    if deviation > 0.0 {
        add_noise(&mut rgb, deviation, seed);
    }
    rgb
}

/// A Gaussian blur of `sigma` pixels of an image 640 wide.
pub(crate) fn blur(image: &ColourImage, sigma: f64) -> Vec<u8> {
    let sigma_px = sigma * sigma_px(0, image.width) / sigma_px(0, 640);
    let mut rgb = image.rgb.clone();
    if sigma_px <= 0.0 {
        return rgb;
    }
    let (mut blur, mut blurred) = (Blur::default(), Vec::new());
    for channel in 0..3 {
        let plane: Vec<f32> = image.rgb.iter().skip(channel).step_by(3).map(|value| f32::from(*value)).collect();
        blur.blur(&plane, image.width, sigma_px, &mut blurred);
        for (value, blurred) in rgb.iter_mut().skip(channel).step_by(3).zip(&blurred) {
            *value = (blurred + 0.5).clamp(0.0, 255.0) as u8;
        }
    }
    rgb
}
