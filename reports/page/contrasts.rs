//! The table of contrasts, and what is to be said beside it.

use crate::figures::contrast_rows::live;
use crate::input::ContrastInput;
use crate::wording;
use furrow_model::{Contrast, Difference, chance, signed};
use serde::Serialize;

/// A difference as shown.
#[derive(Serialize)]
pub(crate) struct Shown {
    name: &'static str,
    value: String,
    pub text: String,
    /// Empty where there is none.
    pub interval: String,
    pub verdict: String,
    /// `p 0.012` and `Holm 0.024`; none without an interval.
    pub chances: Vec<String>,
    /// Whether the verdict falls when corrected for the number of contrasts.
    falls: bool,
}

#[derive(Serialize)]
pub(crate) struct Row {
    /// Its place among the contrasts, from 1.
    number: usize,
    pub of: String,
    pub over: String,
    setting: String,
    pub live: String,
    pub numbers: Vec<Option<Shown>>,
}

/// The section's words and numbers.
#[derive(Serialize)]
pub(crate) struct ContrastTable {
    notes: Vec<String>,
    /// Whether rows tell their setting.
    settings: bool,
    pub rows: Vec<Row>,
}

/// None where the matrix asks for no contrast.
pub(crate) fn table(input: &ContrastInput) -> Option<ContrastTable> {
    let notes: Vec<String> = input.notes.iter().map(|note| wording::shown(note)).collect();
    let settings = input.found.iter().any(|contrast| !contrast.setting.is_empty());
    (!input.found.is_empty() || !notes.is_empty()).then(|| ContrastTable {
        notes,
        settings,
        rows: input.found.iter().enumerate().map(|(i, contrast)| row(i + 1, contrast, &input.found)).collect(),
    })
}

fn row(number: usize, contrast: &Contrast, all: &[Contrast]) -> Row {
    let shown = |name, difference: &Difference, unit: f64, digits: usize, after: &str| {
        let number = |value: f64| signed(unit * value, digits).replace('-', "\u{2212}");
        let interval = difference.interval.map(|interval| interval.map(number));
        let both = difference.p.zip(difference.p_holm);
        Some(Shown {
            name,
            value: difference.difference.to_string(),
            text: number(difference.difference) + after,
            interval: interval.map_or(String::new(), |[low, high]| format!("{low} to {high}")),
            verdict: difference.verdict.to_string(),
            chances: both
                .map_or(Vec::new(), |(p, holm)| vec![format!("p {}", chance(p)), format!("Holm {}", chance(holm))]),
            falls: difference.falls_when_corrected(),
        })
    };
    Row {
        number,
        of: wording::shown(&contrast.of),
        over: wording::shown(&contrast.over),
        setting: wording::shown(&contrast.setting),
        live: live(contrast, all),
        numbers: vec![
            contrast.right.as_ref().and_then(|right| shown("right", right, 1.0, 0, "")),
            shown("good", &contrast.good, 1.0, 0, ""),
            shown("lost_fraction", &contrast.lost_fraction, 100.0, 1, "\u{202f}%"),
            shown("area_m", &contrast.area_m, 1.0, 2, " m"),
        ],
    }
}
