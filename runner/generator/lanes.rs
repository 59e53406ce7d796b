//! Arithmetic that compilers turn into vector instructions: no branch, no call, no table. Every step is one plain `f32`
//! operation, so that all machines and instruction sets give the same bits.

/// Adding this to a number below 2^22 in size leaves its nearest whole number in the lowest bits.
const WHOLE: f32 = 12_582_912.0;

/// e to the power of `x`, to within 3e-7 of the value; `x` is held to what an `f32` can say.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let twos = (x * std::f32::consts::LOG2_E).clamp(-126.0, 126.0);
    let shifted = twos + WHOLE;
    let part = (twos - (shifted - WHOLE)) * std::f32::consts::LN_2;
    // Taylor's polynomial on [-ln 2 / 2, ln 2 / 2].
    let small = 1.0
        + part
            * (1.0
                + part
                    * (0.5 + part * (1.0 / 6.0 + part * (1.0 / 24.0 + part * (1.0 / 120.0 + part * (1.0 / 720.0))))));
    let exponent = shifted.to_bits().wrapping_sub(WHOLE.to_bits()).wrapping_add(127) << 23;
    small * f32::from_bits(exponent)
}

/// The nearest whole number of a number from 0 to 2^22.
#[inline(always)]
pub(crate) fn whole(x: f32) -> usize {
    (x + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits()) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_e_are_those_of_libm() {
        for i in -2000..=2000 {
            let x = i as f32 * 0.01;
            let (found, wanted) = (f64::from(exp(x)), libm::exp(f64::from(x)));
            assert!((found / wanted - 1.0).abs() < 2e-6, "{x}: {found} {wanted}");
        }
        assert!(exp(-1e9) >= 0.0 && exp(1e9).is_finite());
    }

    #[test]
    fn whole_numbers_are_the_nearest() {
        for (x, wanted) in [(0.0, 0), (0.4, 0), (0.6, 1), (8191.51, 8192), (254.9, 255)] {
            assert_eq!(whole(x), wanted);
        }
    }
}
