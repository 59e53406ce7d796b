//! The camera: from radiance to eight bits, with a camera's faults.
//!
//! [`settings`] says what camera a traversal has; [`optics`] brings the light to its sensors, through [`lens`]es or
//! ideally; [`blur`] is what moves while the shutter is open; [`sensor`] makes noise and eight bits; [`delivery`]
//! stamps the images and loses some.

pub mod blur;
pub mod delivery;
pub mod lens;
pub mod optics;
pub mod sensor;
pub mod settings;

use crate::chance::derive;
use crate::render::Radiance;
use furrow_model::StereoRig;
use optics::Optics;
use sensor::Sensor;

/// Distance between the cameras: a ZED 2i.
pub const BASELINE_M: f64 = 0.12;
/// Focal length over the image's width: half of a ZED 2i at 1280 columns (264 px at 640).
const FOCAL_PER_WIDTH: f64 = 264.0 / 640.0;
/// Image value per W/m^2/sr and second: a field in full sun needs about a millisecond.
const SENSITIVITY: f32 = 2.2;
/// Longest exposure and greatest gain.
const LONGEST_S: f32 = 0.010;
const SHORTEST_S: f32 = 0.000_05;
const GREATEST_GAIN: f32 = 16.0;
/// Where auto-exposure holds the mean of the image as it is seen: of the square roots of light, near enough to the tone
/// curve. Like this a strip of bright sky does not darken a wood, as it would in the mean of light itself.
const MEAN: f32 = 0.39;
/// Share of the picture's mean light that the lens scatters over all of it: the veiling glare of an ordinary small lens
/// (ISO 9358) is 2 to 3 %.
const VEILING_GLARE: f32 = 0.025;
/// Light that is so many times a full pixel's glares no more: the sun's disc would by its few pixels decide how bright
/// shade is.
const BRIGHTEST_GLARE: f32 = 4.0;
/// Share of its way to the right exposure that the camera goes in one frame.
const HASTE: f32 = 0.25;

/// The rectified pair at this size.
pub fn rig((width, height): (u32, u32)) -> StereoRig {
    StereoRig {
        width,
        height,
        focal_px: FOCAL_PER_WIDTH * f64::from(width),
        cu_px: 0.5 * (f64::from(width) - 1.0),
        cv_px: 0.5 * (f64::from(height) - 1.0),
        baseline_m: BASELINE_M,
    }
}

/// How a frame was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// Exposure time in seconds.
    pub time_s: f32,
    /// Gain, from 1.
    pub gain: f32,
}

impl Exposure {
    fn of(product: f32) -> Exposure {
        let time_s = product.clamp(SHORTEST_S, LONGEST_S);
        Exposure { time_s, gain: (product / time_s).clamp(1.0, GREATEST_GAIN) }
    }

    fn product(self) -> f32 {
        self.time_s * self.gain
    }
}

/// The exposure control and sensor of one traversal.
pub struct Camera {
    seed: u64,
    exposure: Option<Exposure>,
    white: [f32; 3],
}

impl Camera {
    /// A camera with its own noise, and its white balance half adapted to light of the colour `illuminant`.
    pub fn new(seed: u64, illuminant: [f32; 3]) -> Camera {
        let mean = (illuminant[0] + illuminant[1] + illuminant[2]) / 3.0;
        let white = illuminant.map(|c| libm::powf((mean / c.max(1e-9)).clamp(0.4, 2.5), 0.65));
        Camera { seed, exposure: None, white }
    }

    /// The exposure of the frame to come; `None` before the first was metered.
    pub fn exposure(&self) -> Option<Exposure> {
        self.exposure
    }

    /// Measures what falls on the left sensor and sets the exposure of the frame to come: straight away at first, then
    /// with a lag. Both eyes share it.
    pub fn meter(&mut self, left: &Radiance) -> Exposure {
        let product = match self.exposure.map(Exposure::product) {
            None => (0..12).fold(1e-3, |product, _| wanted(left, product)),
            Some(before) => {
                let ratio = (wanted(left, before) / before).clamp(0.25, 4.0);
                before * (1.0 + HASTE * (ratio - 1.0))
            }
        };
        let exposure = Exposure::of(product);
        self.exposure = Some(exposure);
        exposure
    }

    /// The image of the light that falls on the sensor of `side` (0 left, 1 right) of `optics`: blue green red, row by
    /// row.
    pub fn develop(
        &self,
        radiance: &Radiance,
        optics: &Optics,
        exposure: Exposure,
        frame: u64,
        side: usize,
    ) -> Vec<u8> {
        let seed = derive(derive(self.seed, frame), side as u64);
        let scale = SENSITIVITY * exposure.product();
        let sensor = Sensor::new(seed, veil(&radiance.pixels, scale), self.white, scale, exposure.gain);
        sensor.image(&radiance.pixels, optics.falloff(side))
    }
}

/// What the lens scatters over the whole picture of this light, of which `scale` makes image values.
fn veil(light: &[[f32; 3]], scale: f32) -> [f32; 3] {
    let (brightest, every) = (BRIGHTEST_GLARE / scale, light.iter().step_by(7));
    let share = VEILING_GLARE / every.len().max(1) as f32;
    let sums =
        every.fold([0.0_f64; 3], |sums, pixel| std::array::from_fn(|c| sums[c] + f64::from(pixel[c].min(brightest))));
    sums.map(|sum| sum as f32 * share)
}

/// The product of time and gain at which the mean of the image, clipped where it is full, comes closer to `MEAN`.
fn wanted(image: &Radiance, product: f32) -> f32 {
    let scale = SENSITIVITY * product;
    let (mut sum, mut weights) = (0.0_f64, 0.0_f64);
    for row in (0..image.height).step_by(4) {
        // The sky counts half.
        let weight = if row * 5 < image.height * 2 { 0.5 } else { 1.0 };
        for column in (0..image.width).step_by(4) {
            let [r, g, b] = image.pixels[(row * image.width + column) as usize];
            sum += f64::from((scale * (0.25 * r + 0.6 * g + 0.15 * b)).min(1.0).sqrt()) * weight;
            weights += weight;
        }
    }
    let mean = (sum / weights) as f32;
    let short = MEAN / mean.max(1e-6);
    (product * (short * short).clamp(0.1, 10.0)).clamp(SHORTEST_S, LONGEST_S * GREATEST_GAIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> Radiance {
        Radiance { width: 64, height: 36, pixels: vec![[value; 3]; 64 * 36], inverse_depth: vec![0.0; 64 * 36] }
    }

    #[test]
    fn exposure_holds_the_mean_within_the_camera_s_limits() {
        let mut camera = Camera::new(1, [1.0; 3]);
        let bright = camera.meter(&flat(60.0));
        assert!(
            ((60.0 * SENSITIVITY * bright.product()).sqrt() - MEAN).abs() < 0.01 && bright.gain == 1.0,
            "{bright:?}"
        );
        for _ in 0..60 {
            camera.meter(&flat(0.01));
        }
        let dark = camera.meter(&flat(0.01));
        assert!(dark.time_s == LONGEST_S && (dark.gain - GREATEST_GAIN).abs() < 1e-4, "{dark:?}");
    }

    #[test]
    fn the_lens_veils_what_is_dark_by_a_share_of_the_mean() {
        let half: Vec<_> = (0..64 * 36).map(|i| if i % 2 == 0 { [1.0, 2.0, 0.5] } else { [0.0; 3] }).collect();
        let veil = veil(&half, 1.0);
        // The mean of the halves: 0.5, 1 and 0.25, of which the share is 2.5 %.
        for (veil, wanted) in veil.iter().zip([0.0125, 0.025, 0.00625]) {
            assert!((veil - wanted).abs() < 1e-4 * wanted, "{veil} {wanted}");
        }
        let [glaring, ..] = super::veil(&[[1e6; 3]; 7], 2.0);
        assert!((glaring - 0.05).abs() < 1e-6, "four times a full pixel of 0.5 at most: {glaring}");
    }

    #[test]
    fn noise_differs_between_eyes_and_grows_with_gain() {
        let camera = Camera::new(1, [1.0; 3]);
        let optics = Optics::rectified(&rig((64, 36)));
        // What the eyes' images of an even light differ in is noise alone.
        let spread = |gain: f32| {
            let exposure = Exposure { time_s: 0.18 / (SENSITIVITY * gain), gain };
            let [left, right] = [0, 1].map(|side| camera.develop(&flat(1.0), &optics, exposure, 3, side));
            let squares =
                left.iter().zip(&right).map(|(&l, &r)| (f64::from(l) - f64::from(r)) * (f64::from(l) - f64::from(r)));
            squares.sum::<f64>() / left.len() as f64
        };
        let (calm, rough) = (spread(1.0), spread(16.0));
        assert!(calm > 0.5 && rough > 8.0 * calm, "{calm} {rough}");
    }
}
