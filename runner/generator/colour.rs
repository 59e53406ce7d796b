//! Log-opponent colours (Ruderman, Cronin and Chiao 1998): linear light of gamma 2.2, its logarithm, and three axes of
//! which one is brightness. Another illuminant multiplies light, and so shifts these.

use crate::lanes;
use std::sync::OnceLock;

/// The gamma of an 8-bit image.
const GAMMA: f64 = 2.2;
/// Added to light before the logarithm: about the light of grey level 10 of 255, so that black stays finite.
const FLOOR: f64 = 7.8e-4;
/// Pixels with a channel at or above this level are blown out: what they really were is unknown.
pub const BLOWN_OUT: u8 = 253;
/// Linear light above which brightness is held back, so that highlights fade instead of cutting off.
const SHOULDER: f64 = 0.8;
/// Steps of the square root of light in the table of grey levels: less than a tenth of a level each.
const ROOTS: usize = 8192;

/// Tables over the 256 grey levels, and back.
pub(crate) struct Tables {
    /// ln(light + floor) of each level.
    pub log: [f32; 256],
    /// Light above which brightness is held back, for a pixel that had this level.
    pub knee: [f32; 256],
    /// Light over light and floor, of each level.
    pub kept: [f32; 256],
    /// Grey level by the square root of light, in steps of 1 / [`ROOTS`].
    pub level: Vec<u8>,
}

/// The tables, made once.
pub(crate) fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let light = |level: usize| libm::pow(level as f64 / 255.0, GAMMA);
        let level = |root: usize| {
            let share = root as f64 / ROOTS as f64;
            (255.0 * libm::pow(share * share, 1.0 / GAMMA)).round() as u8
        };
        Tables {
            log: std::array::from_fn(|i| libm::log(light(i) + FLOOR) as f32),
            knee: std::array::from_fn(|i| light(i).max(SHOULDER) as f32),
            kept: std::array::from_fn(|i| (light(i) / (light(i) + FLOOR)) as f32),
            level: (0..=ROOTS).map(level).collect(),
        }
    })
}

/// Linear light of a grey level, 0 to 1.
pub(crate) fn light(level: u8) -> f32 {
    libm::pow(f64::from(level) / 255.0, GAMMA) as f32
}

const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// 1 / sqrt(6).
const SIXTH: f32 = 0.408_248_3;

/// Brightness, red against green, and both against blue, of the logarithms of red, green and blue.
#[inline(always)]
pub fn opponent([r, g, b]: [f32; 3]) -> [f32; 3] {
    [(r + g + b) * (1.0 / 3.0), (r - g) * HALF, (r + g - 2.0 * b) * SIXTH]
}

/// The inverse of [`opponent`].
#[inline(always)]
pub(crate) fn logarithms([l, o1, o2]: [f32; 3]) -> [f32; 3] {
    let (across, along) = (o1 * HALF, o2 * SIXTH);
    [l + across + along, l - across + along, l - 2.0 * along]
}

/// The place in [`Tables::level`] of a logarithm, for a pixel whose highlights are held back above `knee` and of whose
/// light the share `kept` is its own, the rest the floor.
///
/// Brighter pixels give the floor back by subtraction, as it was added. A darker one would lose more than it had and be
/// black, and with it all that the shadows hold; it is dimmed in proportion instead. Both agree where nothing changes.
///
/// The shoulder begins at the pixel's own light where that is above 0.8, so an unchanged pixel stays unchanged; above
/// it, light nears 1 as a hyperbola with slope 1 at the knee.
#[inline(always)]
pub(crate) fn root_of(log: f32, knee: f32, kept: f32) -> f32 {
    let floored = lanes::exp(log);
    let light = (floored - FLOOR as f32).max(floored * kept);
    let (over, room) = ((light - knee).max(0.0), 1.0 - knee);
    let held = light.min(knee) + over * room / (over + room).max(1e-12);
    (held.min(1.0)).sqrt() * ROOTS as f32
}

/// The log-opponent colour of a pixel as training and flow see it.
pub fn colour_of(rgb: [u8; 3]) -> [f32; 3] {
    let tables = tables();
    opponent(rgb.map(|level| tables.log[usize::from(level)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_comes_back() {
        let tables = tables();
        for level in 0..=255_usize {
            let root = root_of(tables.log[level], tables.knee[level], tables.kept[level]);
            assert_eq!(tables.level[lanes::whole(root)], level as u8);
        }
    }

    #[test]
    fn shadows_are_dimmed_in_proportion_and_not_cut_off() {
        let tables = tables();
        for level in [3_usize, 6, 12, 60] {
            // A third less light of everything.
            let root = root_of(tables.log[level] + (2.0_f32 / 3.0).ln(), tables.knee[level], tables.kept[level]);
            let expected = libm::pow(2.0 / 3.0, 1.0 / GAMMA) * level as f64;
            assert!((f64::from(tables.level[lanes::whole(root)]) - expected).abs() <= 0.6, "level {level}");
        }
    }

    #[test]
    fn opponent_axes_turn_back() {
        let rgb = [-3.0, -1.5, 0.2];
        let back = logarithms(opponent(rgb));
        assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-5), "{back:?}");
        assert!(opponent([-1.0; 3])[1..].iter().all(|o| o.abs() < 1e-6));
    }

    #[test]
    fn highlights_fade_and_keep_their_order() {
        let mut last = 0.0;
        for i in 0..200 {
            let held = root_of((i as f32 * 0.02).ln(), 0.8, 0.0);
            assert!(held >= last && held <= ROOTS as f32);
            last = held;
        }
        // Light 2 above a knee of 0.8: 0.8 + 1.2 x 0.2 / 1.4.
        let held = (root_of(2.0_f32.ln(), 0.8, 0.0) / ROOTS as f32).powi(2);
        assert!((held - (0.8 + 0.24 / 1.4)).abs() < 1e-3, "{held}");
    }
}
