//! Seeded chance: hashes, a small stream of numbers, and smooth noise over the plane. Nothing here depends on order or
//! threads.

/// Mixes 64 bits so that every input bit reaches every output bit (the finaliser of SplitMix64, Steele et al. 2014).
#[inline]
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// One seed out of two: the second names a thing within the first's domain.
#[inline]
pub fn derive(seed: u64, thing: u64) -> u64 {
    mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_add(mix(thing.wrapping_add(0x2545_f491_4f6c_dd1d))))
}

/// One seed out of a seed and a name.
pub fn derive_name(seed: u64, name: &str) -> u64 {
    name.bytes().fold(derive(seed, name.len() as u64), |seed, byte| derive(seed, u64::from(byte)))
}

/// A stream of numbers from a seed (SplitMix64).
#[derive(Debug, Clone)]
pub struct Dice {
    state: u64,
}

impl Dice {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: mix(seed ^ 0x6a09_e667_f3bc_c909) }
    }

    /// The stream of `seed` for the thing `thing`.
    pub fn of(seed: u64, thing: u64) -> Self {
        Self::new(derive(seed, thing))
    }

    /// 64 uniform bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.state)
    }

    /// Uniform in [0, 1).
    #[inline]
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [from, to).
    #[inline]
    pub fn within(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * self.unit()
    }

    /// Uniform among 0 .. count; 0 where the count is 0.
    #[inline]
    pub fn below(&mut self, count: usize) -> usize {
        ((self.bits() >> 32).wrapping_mul(count as u64) >> 32) as usize
    }

    /// True with this probability.
    #[inline]
    pub fn chance(&mut self, probability: f32) -> bool {
        self.unit() < probability
    }

    /// Close to normal with mean 0 and standard deviation 1: the sum of four uniform numbers (never beyond 3.5).
    #[inline]
    pub fn normal(&mut self) -> f32 {
        (self.unit() + self.unit() + self.unit() + self.unit() - 2.0) * 1.732_050_8
    }
}

/// The hash of a lattice point, uniform in [0, 1).
#[inline(always)]
pub fn lattice(x: i32, y: i32, seed: u32) -> f32 {
    let mut h =
        (x as u32).wrapping_mul(0x8da6_b343) ^ (y as u32).wrapping_mul(0xd816_3841) ^ seed.wrapping_mul(0xcb1a_b31f);
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    ((h ^ (h >> 16)) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Smooth value noise in [0, 1): one feature per unit length.
#[inline(always)]
pub fn noise(x: f32, y: f32, seed: u32) -> f32 {
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let (xi, yi) = (x0 as i32, y0 as i32);
    blend(fx, fy, |dx, dy| lattice(xi.wrapping_add(dx), yi.wrapping_add(dy), seed))
}

/// Noise that repeats every `period` units in both directions.
#[inline]
pub fn periodic_noise(x: f32, y: f32, period: i32, seed: u32) -> f32 {
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let (xi, yi) = (x0 as i32, y0 as i32);
    blend(fx, fy, |dx, dy| lattice((xi + dx).rem_euclid(period), (yi + dy).rem_euclid(period), seed))
}

#[inline(always)]
fn blend(fx: f32, fy: f32, at: impl Fn(i32, i32) -> f32) -> f32 {
    let (sx, sy) = (fx * fx * (3.0 - 2.0 * fx), fy * fy * (3.0 - 2.0 * fy));
    let top = at(0, 0) + (at(1, 0) - at(0, 0)) * sx;
    let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * sx;
    top + (bottom - top) * sy
}

/// Noise of several octaves, each half as strong and twice as fine, in [0, 1).
pub fn fractal(x: f32, y: f32, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1.0);
    for octave in 0..octaves {
        sum += weight * noise(x * scale, y * scale, seed.wrapping_add(octave * 77));
        weight *= 0.5;
        scale *= 2.03;
    }
    sum / (1.0 - weight * 2.0)
}

/// Fractal noise that repeats every `period` units.
pub fn periodic_fractal(x: f32, y: f32, period: i32, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1);
    for octave in 0..octaves {
        sum +=
            weight * periodic_noise(x * scale as f32, y * scale as f32, period * scale, seed.wrapping_add(octave * 77));
        weight *= 0.5;
        scale *= 2;
    }
    sum / (1.0 - weight * 2.0)
}
