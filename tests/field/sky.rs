//! The light: sun, sky, clouds and headlights. Radiance in W/m^2/sr, irradiance in W/m^2, red, green, blue.

use crate::chance::{Dice, periodic_fractal};
use crate::traversal::{Traversal, Weather};
use crate::vector::{V3, smoothstep, v3};
use std::f32::consts::{FRAC_PI_3, FRAC_PI_4, PI};

/// Sky light over sun light, against the clear-sky figures: a dry blue sky. With three times as much, the tall trees of
/// the Old Zoo looked so much alike two hours apart that matches fell by half only; shadows have to be dark for them to
/// fall to a third over the whole loop (0.55: to 37 %, 0.45: 34 %, 0.38: 33 %). What lights shade besides is sunlight
/// that leaves scatter, which comes from the sun's side.
const SKY_SHARE: f32 = 0.24;
/// How much brighter than that the sky itself is seen. Over photographs of sunlit ground it is brighter still, but
/// leaves against the sky look alike at every hour: with 2.6 at a share of 0.30, matches two hours away were 37 % of
/// those of the same hour over the Old Zoo's loop; now 31 %.
const SEEN: f32 = 1.6;
/// Columns and rows of the cloud texture.
const CLOUDS: usize = 512;

/// The light of one traversal.
#[derive(Debug, Clone)]
pub struct Sky {
    /// Unit vector to the sun.
    pub to_sun: V3,
    /// The sun's irradiance on a surface that faces it; zero below the horizon.
    pub sun: V3,
    /// Whether the robot drives with headlights: the sun is more than 3 degrees under the horizon.
    pub headlights: bool,
    /// Irradiance by direction of the surface: nine spherical harmonics (Ramamoorthi and Hanrahan 2001).
    ambient: [V3; 9],
    /// Irradiance of level ground.
    pub overhead: V3,
    scale: f32,
    low: f32,
    grey: f32,
    cloud_cover: f32,
    clouds: Vec<f32>,
    drift: (f32, f32),
}

impl Sky {
    /// The light over `traversal`.
    pub fn over(traversal: &Traversal) -> Sky {
        let position = traversal.sun();
        let [e, n, u] = position.east_north_up.map(|v| v as f32);
        let elevation_deg = position.elevation_deg as f32;
        let mut dice = Dice::of(traversal.traversal_seed(), 2);
        let (through, grey, cover) = match traversal.weather {
            Weather::Clear => (1.0, 0.0, 0.28),
            Weather::Hazy => (0.62, 0.4, 0.42),
            Weather::Cloudy => (0.85, 0.25, 0.6),
            Weather::Overcast => (0.0, 0.92, 1.0),
        };
        let clear_w = direct_irradiance(elevation_deg);
        let diffuse_w = SKY_SHARE * diffuse_irradiance(elevation_deg) + (1.0 - through) * 0.3 * clear_w * u.max(0.0);
        let mut sky = Sky {
            to_sun: v3(e, n, u),
            sun: sun_colour(elevation_deg) * (clear_w * through),
            headlights: elevation_deg < -3.0,
            ambient: [V3::default(); 9],
            overhead: V3::default(),
            scale: 1.0,
            low: 1.0 - smoothstep(0.0, 25.0, elevation_deg),
            grey,
            cloud_cover: (cover + 0.08 * dice.normal()).clamp(0.0, 1.0),
            clouds: bake_clouds(dice.bits() as u32),
            drift: (dice.unit() * CLOUDS as f32, dice.unit() * CLOUDS as f32),
        };
        let flat: f32 = directions().map(|(d, weight)| luminance(sky.gradient(d)) * d.z.max(0.0) * weight).sum();
        sky.scale = diffuse_w / flat.max(1e-9);
        let bounce = ground_bounce(&sky, diffuse_w);
        sky.ambient = project(|d| if d.z > 0.0 { sky.gradient(d) } else { bounce });
        sky.overhead = sky.ambient(V3::UP);
        sky
    }

    /// Radiance of the cloudless sky from the direction `d` (unit, upwards): brighter at the horizon and around the
    /// sun. As deep a blue as over dry country: dark as it has to be ([`SEEN`]), a paler one was taken for dusk.
    #[inline(always)]
    fn gradient(&self, d: V3) -> V3 {
        let up = d.z.max(0.0);
        let haze = (1.0 - up) * (1.0 - up);
        let haze = haze * haze;
        let zenith = v3(0.10, 0.37, 1.10);
        let horizon = v3(0.50, 0.79, 1.20).mix(v3(1.0, 0.78, 0.58), 0.7 * self.low);
        let blue = zenith.mix(horizon, 0.18 + 0.82 * haze) * (0.70 + 1.4 * haze);
        let near_sun = (d.dot(self.to_sun)).max(0.0);
        let p4 = near_sun * near_sun * near_sun * near_sun;
        let p32 = p4 * p4;
        let p32 = p32 * p32 * p32 * p32;
        let glow = v3(1.0, 0.93, 0.80).mix(v3(1.0, 0.66, 0.36), self.low) * (0.35 * p4 + 1.6 * p32 * p32);
        let overcast = v3(0.82, 0.86, 0.90) * (0.45 + 0.55 * up);
        ((blue + glow).mix(overcast, self.grey)) * self.scale
    }

    /// Radiance that arrives from the direction `d` (unit, upwards), clouds and sun disc included.
    #[inline(always)]
    pub fn radiance(&self, d: V3) -> V3 {
        let clear = self.gradient(d);
        let up = d.z.max(0.02);
        let far = 60.0 / (up + 0.12);
        let density = self.cloud(d.x * far + self.drift.0, d.y * far + self.drift.1);
        let edge = 1.0 - self.cloud_cover;
        let veil = smoothstep(edge, edge + 0.35, density) * smoothstep(0.01, 0.12, d.z) * (0.85 - 0.5 * self.grey);
        let toward = 0.5 + 0.5 * d.dot(self.to_sun);
        let lit = v3(1.0, 0.97, 0.93) * (self.scale * (0.95 + 0.7 * toward * toward))
            + self.sun * (0.03 + 0.05 * toward * toward);
        let radiance = clear.mix(lit, veil);
        let disc = smoothstep(0.99985, 0.99998, d.dot(self.to_sun));
        radiance * SEEN + self.sun * (400.0 * disc * (1.0 - veil))
    }

    #[inline(always)]
    fn cloud(&self, x: f32, y: f32) -> f32 {
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let at = |dx: i32, dy: i32| {
            let column = (x0 as i32 + dx).rem_euclid(CLOUDS as i32) as usize;
            self.clouds[(y0 as i32 + dy).rem_euclid(CLOUDS as i32) as usize * CLOUDS + column]
        };
        let top = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
        let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
        top + (bottom - top) * fy
    }

    /// Irradiance of a surface with the unit normal `n` from sky and ground together, nothing in the way.
    #[inline(always)]
    pub fn ambient(&self, n: V3) -> V3 {
        let a = &self.ambient;
        let sum = a[0] + a[1] * n.y + a[2] * n.z + a[3] * n.x + a[4] * (n.x * n.y) + a[5] * (n.y * n.z);
        let sum = sum + a[6] * (3.0 * n.z * n.z - 1.0) + a[7] * (n.x * n.z) + a[8] * (n.x * n.x - n.y * n.y);
        v3(sum.x.max(0.0), sum.y.max(0.0), sum.z.max(0.0))
    }
}

/// Rec. 709 luminance.
pub fn luminance(colour: V3) -> f32 {
    0.2126 * colour.x + 0.7152 * colour.y + 0.0722 * colour.z
}

/// Direct normal irradiance: 1361 * 0.7^(AM^0.678) (Meinel and Meinel 1976) with the air mass of Kasten and Young
/// (1989).
fn direct_irradiance(elevation_deg: f32) -> f32 {
    if elevation_deg <= 0.0 {
        return 0.0;
    }
    let sin = libm::sinf(elevation_deg.to_radians());
    let air_mass = 1.0 / (sin + 0.50572 * libm::powf(elevation_deg + 6.07995, -1.6364));
    1361.0 * libm::powf(0.7, libm::powf(air_mass, 0.678))
}

/// Diffuse irradiance of the ground under a clear sky; below the horizon it falls by 10^(0.38 elevation) down to
/// starlight.
fn diffuse_irradiance(elevation_deg: f32) -> f32 {
    if elevation_deg > 0.0 {
        10.0 + 115.0 * libm::powf(libm::sinf(elevation_deg.to_radians()), 0.6)
    } else {
        10.0 * libm::powf(10.0, 0.38 * elevation_deg).max(2e-5)
    }
}

/// The sun's colour, luminance 1: 5600 K when high, about 2500 K at one degree.
fn sun_colour(elevation_deg: f32) -> V3 {
    let high = v3(1.06, 0.99, 0.91);
    let low = v3(1.75, 0.88, 0.30);
    let colour = low.mix(high, smoothstep(-2.0, 30.0, elevation_deg).sqrt());
    colour * (1.0 / luminance(colour))
}

fn ground_bounce(sky: &Sky, diffuse_w: f32) -> V3 {
    let sun = sky.sun * (0.55 * sky.to_sun.z.max(0.0));
    (sun + v3(0.9, 1.0, 1.1) * (0.7 * diffuse_w)).times(v3(0.17, 0.16, 0.09)) * (1.0 / PI)
}

/// Directions spread evenly over the sphere (a Fibonacci spiral) with their solid angles.
fn directions() -> impl Iterator<Item = (V3, f32)> {
    const COUNT: usize = 1024;
    (0..COUNT).map(|i| {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / COUNT as f32;
        let around = i as f32 * 2.399_963_1;
        let r = (1.0 - z * z).max(0.0).sqrt();
        (v3(r * libm::cosf(around), r * libm::sinf(around), z), 4.0 * PI / COUNT as f32)
    })
}

/// The nine coefficients of the irradiance under `radiance`, basis constants and cosine lobe folded in.
fn project(radiance: impl Fn(V3) -> V3) -> [V3; 9] {
    const BASIS: [f32; 9] =
        [0.282_095, 0.488_603, 0.488_603, 0.488_603, 1.092_548, 1.092_548, 0.315_392, 1.092_548, 0.546_274];
    // pi, 2 pi / 3 and pi / 4 for the three bands.
    const LOBE: [f32; 9] = [PI, BAND_1, BAND_1, BAND_1, FRAC_PI_4, FRAC_PI_4, FRAC_PI_4, FRAC_PI_4, FRAC_PI_4];
    const BAND_1: f32 = 2.0 * FRAC_PI_3;
    let mut sums = [V3::default(); 9];
    for (d, weight) in directions() {
        let light = radiance(d) * weight;
        let terms = [1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y];
        for k in 0..9 {
            sums[k] += light * (terms[k] * BASIS[k] * BASIS[k] * LOBE[k]);
        }
    }
    sums
}

fn bake_clouds(seed: u32) -> Vec<f32> {
    let cell = |i: usize| {
        let (x, y) = ((i % CLOUDS) as f32 / 64.0, (i / CLOUDS) as f32 / 32.0);
        let bend = periodic_fractal(x, y, 8, 3, seed ^ 0x55);
        let streaks = periodic_fractal(x + 0.8 * bend, y + 0.4 * bend, 8, 5, seed);
        // The vertical period is twice the horizontal one, so that clouds are drawn out along one direction.
        streaks * 1.25 - 0.08
    };
    (0..CLOUDS * CLOUDS).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traversal::Site;

    fn at(slot: &str) -> Sky {
        Sky::over(&Traversal::new(Site::Backsburg, slot.parse().expect("a slot")))
    }

    #[test]
    fn ambient_light_of_an_even_sky_is_pi_times_its_radiance() {
        let even = Sky { ambient: project(|_| v3(2.0, 2.0, 2.0)), ..at("10:00") };
        for n in [V3::UP, v3(0.6, 0.0, 0.8), v3(0.0, -1.0, 0.0)] {
            assert!((even.ambient(n).y - 2.0 * PI).abs() < 0.02);
        }
    }

    #[test]
    fn light_follows_the_sun() {
        let (night, dawn, noon) = (at("04:30"), at("06:00"), at("12:00"));
        assert!(night.headlights && !dawn.headlights);
        assert!(night.sun == V3::default() && luminance(night.ambient(V3::UP)) < 0.01);
        assert!(luminance(dawn.sun) < 0.15 * luminance(noon.sun));
        assert!(dawn.sun.x > 2.0 * dawn.sun.z, "red at dawn");
        assert!((850.0..1050.0).contains(&luminance(noon.sun)), "{:?}", noon.sun);
    }
}
