//! From data to a figure's coordinates.

/// A linear axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub from: f64,
    pub to: f64,
    pub px_from: f64,
    pub px_to: f64,
}

impl Scale {
    /// Where `value` is drawn.
    pub fn px(&self, value: f64) -> f64 {
        let share = if self.to > self.from { (value - self.from) / (self.to - self.from) } else { 0.0 };
        rounded(self.px_from + share * (self.px_to - self.px_from))
    }
}

/// Coordinates to a hundredth of a unit: finer than any printer, shorter than any `f64`.
pub(crate) fn rounded(px: f64) -> f64 {
    (px * 100.0).round() / 100.0
}

/// Round numbers from 0 to at least `top`, about `wanted` of them; the last is the axis' end.
pub(crate) fn ticks(top: f64, wanted: usize) -> Vec<f64> {
    let top = if top.is_finite() && top > 0.0 { top } else { 1.0 };
    let rough = top / wanted.max(1) as f64;
    let decade = 10f64.powf(rough.log10().floor());
    let step =
        [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|m| m * decade).find(|step| *step >= rough * 0.999).unwrap_or(rough);
    let steps = (top / step - 1e-9).ceil().max(1.0) as usize;
    (0..=steps).map(|i| i as f64 * step).collect()
}

/// The same for counts: whole numbers only.
pub(crate) fn whole_ticks(top: u32, wanted: usize) -> Vec<f64> {
    if top as usize <= wanted {
        return (0..=top.max(1)).map(f64::from).collect();
    }
    let fine = ticks(f64::from(top), wanted);
    if fine.iter().all(|tick| tick.fract() == 0.0) { fine } else { ticks(f64::from(top), wanted / 2) }
}

/// A tick's text: no more decimals than the step needs.
pub(crate) fn tick_text(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_reach_the_top() {
        for (top, expected) in [
            (50.0, &[0.0, 10.0, 20.0, 30.0, 40.0, 50.0][..]),
            (1.0, &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
            (0.0, &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        ] {
            let got = ticks(top, 5);
            assert_eq!(got.len(), expected.len(), "{top}: {got:?}");
            assert!(got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{top}: {got:?}");
        }
        assert_eq!(whole_ticks(3, 5), [0.0, 1.0, 2.0, 3.0]);
        assert!(whole_ticks(12, 5).iter().all(|tick| tick.fract() == 0.0));
        assert_eq!(tick_text(0.2 + 0.1), "0.3");
    }
}
