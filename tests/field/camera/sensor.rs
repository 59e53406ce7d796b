//! What a sensor makes of light: shot and read noise, a tone curve, eight bits.

use crate::chance::mix;
use crate::vector::whole;
use furrow_model::widest;
use rayon::prelude::*;

/// Pixels that a thread takes at a time.
const PIXELS: usize = 1280;
/// Pixels that are worked on at once: loops without branches become vector instructions.
const LANES: usize = 64;

/// Electrons of a full pixel at gain 1, and of the read noise.
const FULL_WELL: f32 = 6000.0;
const READ_NOISE: f32 = 7.0;

/// A sensor during one exposure.
pub struct Sensor {
    seed: u64,
    white: [f32; 3],
    veil: [f32; 3],
    scale: f32,
    shot: f32,
    read: f32,
}

impl Sensor {
    /// A sensor whose noise has this `seed`, on all of which the lens throws the light `veil`, and that multiplies
    /// light by `white` and `scale`, at this gain.
    pub fn new(seed: u64, veil: [f32; 3], white: [f32; 3], scale: f32, gain: f32) -> Sensor {
        let read = READ_NOISE / FULL_WELL * gain;
        Sensor { seed, white, veil, scale, shot: gain / FULL_WELL, read: read * read }
    }

    /// The image, blue green red, of light of which the share `falloff` arrives.
    pub fn image(&self, light: &[[f32; 3]], falloff: &[f32]) -> Vec<u8> {
        let mut image = vec![0; 3 * light.len()];
        image.par_chunks_mut(3 * PIXELS).enumerate().for_each(|(chunk, image)| {
            let first = chunk * PIXELS;
            expose(self, &light[first..], &falloff[first..], first as u64, image);
        });
        image
    }
}

widest!(
    fn expose(sensor: &Sensor, light: &[[f32; 3]], falloff: &[f32], first: u64, image: &mut [u8]) -> ()
        = expose_anywhere
);

/// The `image` of `light` (which may be longer), whose first pixel is the `first` one of the picture.
#[inline(always)]
fn expose_anywhere(sensor: &Sensor, light: &[[f32; 3]], falloff: &[f32], first: u64, image: &mut [u8]) {
    let (tones, normal) = (tones(), normals());
    let brightest = (tones.len() - 1) as f32;
    let chunks = image.chunks_mut(3 * LANES).zip(light.chunks(LANES)).zip(falloff.chunks(LANES));
    for (chunk, ((image, light), falloff)) in chunks.enumerate() {
        let mut lanes = [[0.0; 3]; LANES];
        lanes.iter_mut().zip(light).zip(falloff).for_each(|((lane, light), falloff)| {
            *lane = std::array::from_fn(|c| (light[c] * falloff + sensor.veil[c]) * sensor.white[c] * sensor.scale);
        });
        let mut chance = [[0.0; 3]; LANES];
        for (k, chance) in chance.iter_mut().enumerate() {
            let pixel = first + (chunk * LANES + k) as u64;
            let bits = mix(sensor.seed ^ pixel.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            *chance = std::array::from_fn(|channel| normal[(bits >> (16 * channel)) as usize % NORMALS]);
        }
        let mut steps = [[0; 3]; LANES];
        let (flat, chance) = (lanes.as_flattened(), chance.as_flattened());
        for (k, step) in steps.as_flattened_mut().iter_mut().enumerate() {
            let noisy = flat[k] + (sensor.shot * flat[k].min(1.5) + sensor.read).sqrt() * chance[k];
            *step = whole((noisy * TONE_STEPS).clamp(0.0, brightest));
        }
        for (pixel, steps) in image.chunks_exact_mut(3).zip(steps) {
            (0..3).for_each(|channel| pixel[2 - channel] = tones[steps[channel] as usize]);
        }
    }
}

/// Values of the table of normal chance.
const NORMALS: usize = 4096;

/// Values of a normal distribution of mean 0 and standard deviation 1 at equal steps of probability: a uniform number
/// in, a normal one out.
fn normals() -> &'static [f32; NORMALS] {
    static TABLE: std::sync::OnceLock<[f32; NORMALS]> = std::sync::OnceLock::new();
    TABLE.get_or_init(|| {
        let share_below = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
        let mut z = -5.0;
        std::array::from_fn(|k| {
            // Newton's steps from one value to the next.
            let wanted = (k as f64 + 0.5) / NORMALS as f64;
            for _ in 0..40 {
                let density = libm::exp(-0.5 * z * z) / (2.0 * std::f64::consts::PI).sqrt();
                z += ((wanted - share_below(z)) / density).clamp(-0.5, 0.5);
            }
            z as f32
        })
    })
}

/// Linear value at which the tone curve's toe halves what is darker.
const TOE: f32 = 0.006;
/// Steps of the tone curve per unit of linear value.
const TONE_STEPS: f32 = 4096.0;

/// The tone curve: the gamma of sRGB with a shoulder, so that bright things fade instead of cutting off. From 0 to 4.
fn tones() -> &'static [u8] {
    static CURVE: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    CURVE.get_or_init(|| {
        let value = |i: usize| {
            let x = (i as f32 + 0.5) / TONE_STEPS;
            // A short toe, as cameras have: the deepest shade goes black but for what the lens throws over it.
            let x = x * x / (x + TOE) * (1.0 + TOE);
            // Linear below 0.6, then an exponential approach to 1.
            let y = if x < 0.6 { x } else { 0.6 + 0.4 * (1.0 - libm::expf(-(x - 0.6) / 0.4)) };
            let encoded = if y <= 0.003_130_8 { 12.92 * y } else { 1.055 * libm::powf(y, 1.0 / 2.4) - 0.055 };
            (encoded * 255.0 + 0.5).clamp(0.0, 255.0) as u8
        };
        (0..4 * TONE_STEPS as usize).map(value).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_chance_is_normal() {
        let moment = |power: i32| normals().iter().map(|&z| f64::from(z).powi(power)).sum::<f64>() / NORMALS as f64;
        assert!(moment(1).abs() < 1e-6 && (moment(2) - 1.0).abs() < 2e-3 && (moment(4) - 3.0).abs() < 0.05);
        // Half of a normal distribution lies within 0.674490 of its mean.
        assert!((normals()[3 * NORMALS / 4] - 0.674_49).abs() < 1e-3);
    }
}
