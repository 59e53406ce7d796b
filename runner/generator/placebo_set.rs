//! As many different placebos as a collective has generated members.

use crate::Generator;

/// Exponents, deviations and widths of further placebos move away from the first ones by this each time round.
const STEP: f64 = 0.1;

/// `n` different placebos: gamma 0.8, gamma 1.25, noise of 3 grey levels, a blur of 0.8 pixels, then the same a little
/// stronger.
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
