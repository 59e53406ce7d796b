//! Placebos: changes that know nothing of any hour. A set of generated experiences that does no better than as many of
//! these was lucky among many, no more.

use crate::bands::{Blur, sigma_px};
use crate::sensor::add_noise;
use furrow_model::ColourImage;

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
