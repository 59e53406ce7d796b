//! The table of contrasts, where its numbers come from, and what is to be said beside it.

use crate::figures::contrasts::live;
use crate::input::ContrastInput;
use crate::wording;
use furrow_model::{Contrast, ContrastPass, Difference, signed};
use serde::Serialize;
use std::collections::BTreeSet;

/// A difference as shown.
#[derive(Serialize)]
pub(crate) struct Shown {
    name: &'static str,
    value: String,
    pub text: String,
    pub interval: String,
    pub verdict: String,
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

/// Where one contrast's numbers come from.
#[derive(Serialize)]
pub(crate) struct Lineage {
    number: usize,
    of: String,
    over: String,
    setting: String,
    live: String,
    frames: u32,
    /// What is subtracted: the measure, the contender's number, the other's.
    differences: Vec<[String; 3]>,
    truth: Option<String>,
    passes: Vec<Pass>,
}

/// The two cells of a contrast on one live pass.
#[derive(Serialize)]
struct Pass {
    slot: String,
    traversal: String,
    /// The beginnings of the cells' keys, and whether the page tells of them.
    cells: [(String, bool); 2],
}

/// The lineage of every contrast; `cells` are those that the page has a lineage of, by the beginnings of their keys.
pub(crate) fn lineages(input: &ContrastInput, cells: &BTreeSet<String>) -> Vec<Lineage> {
    let pass = |pass: &ContrastPass| Pass {
        slot: pass.slot.to_string(),
        traversal: pass.traversal.to_string(),
        cells: pass.cells.map(|cell| (cell.short(), cells.contains(&cell.short()))),
    };
    let lineage = |(i, contrast): (usize, &Contrast)| Lineage {
        number: i + 1,
        of: wording::shown(&contrast.of),
        over: wording::shown(&contrast.over),
        setting: wording::shown(&contrast.setting),
        live: live(contrast, &input.found),
        frames: contrast.frames,
        differences: differences(contrast),
        truth: contrast.truth.as_deref().map(wording::shown),
        passes: contrast.live.iter().map(pass).collect(),
    };
    input.found.iter().enumerate().map(lineage).collect()
}

fn differences(contrast: &Contrast) -> Vec<[String; 3]> {
    let told = |name: &str, difference: &Difference, text: &dyn Fn(f64) -> String| {
        [name.to_owned(), text(difference.of), text(difference.over)]
    };
    let count = |value: f64| format!("{value:.0}");
    let right = contrast.right.as_ref().map(|right| told("right localisations", right, &count));
    let rest = [
        told("good localisations", &contrast.good, &count),
        told("lost", &contrast.lost_fraction, &wording::percent),
        told("lost-distance area", &contrast.area_m, &|metres| format!("{metres:.2} m")),
    ];
    right.into_iter().chain(rest).collect()
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
        let [low, high] = difference.interval.map(number);
        Some(Shown {
            name,
            value: difference.difference.to_string(),
            text: number(difference.difference) + after,
            interval: format!("{low} to {high}"),
            verdict: difference.verdict.to_string(),
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
