//! Contrasts, asked for and answered.

use super::cells::in_setting;
use furrow_model::{Contrast, Difference, signed};
use furrow_runner::{Contrasts, MissingContrast, Study};
use serde_json::{Value, json};
use std::fmt::Write;

/// The contrasts that a matrix asks for, before it is run.
pub fn asked_json(study: &Study) -> Value {
    let pairs = study.contrasts().flat_map(|asked| asked.pairs.iter().map(move |pair| (asked, pair)));
    pairs.map(|(asked, pair)| with_setting(json!(pair), &asked.setting)).collect()
}

/// The same, a line per contrast; empty if it asks for none.
pub fn asked_text(study: &Study) -> String {
    let pairs = study.contrasts().flat_map(|asked| asked.pairs.iter().map(move |pair| (asked, pair)));
    pairs.map(|(asked, pair)| format!("contrast {}\n", title(&pair.of, &pair.over, &asked.setting))).collect()
}

/// The contrasts of a run, and those that could not be computed.
pub fn found_json(contrasts: &Contrasts) -> Value {
    let missing = contrasts.missing.iter().map(|MissingContrast { pair, setting, reason }| {
        with_setting(json!({ "of": pair.of, "over": pair.over, "reason": reason }), setting)
    });
    let found = contrasts.found.iter().map(|contrast| {
        let mut value = json!(contrast);
        value["pooled"] = json!(contrast.live.len() > 1);
        value
    });
    found.chain(missing).collect()
}

/// Adds the setting, if the matrix has several.
fn with_setting(mut value: Value, setting: &str) -> Value {
    if !setting.is_empty() {
        value["setting"] = json!(setting);
    }
    value
}

/// A table, a line per contrast; empty if there is none.
pub fn found_text(contrasts: &Contrasts) -> String {
    if contrasts.found.is_empty() && contrasts.missing.is_empty() {
        return String::new();
    }
    let named = |contrast: &Contrast| title(&contrast.of, &contrast.over, &contrast.setting);
    let wide = contrasts.found.iter().map(|contrast| named(contrast).chars().count()).max().unwrap_or(0).max(8);
    // Two live traversals may be of one slot.
    let several = contrasts.found.iter().any(|contrast| contrast.live.len() > 1);
    let live_wide = if several { 18 } else { 6 };
    let mut text = "\ndifferences with 95 % paired bootstrap intervals\n".to_owned();
    let _ = writeln!(
        text,
        "{:<wide$} {:<live_wide$} {:<28} {:<28} {:<34} lost-distance area, m",
        "contrast", "live", "good", "right", "lost %"
    );
    for contrast in &contrasts.found {
        let live = match contrast.live.as_slice() {
            [one] if several => format!("{} {}", one.slot, one.traversal.short()),
            [one] => one.slot.to_string(),
            _ => "pooled".to_owned(),
        };
        let _ = writeln!(
            text,
            "{:<wide$} {live:<live_wide$} {:<28} {:<28} {:<34} {}",
            named(contrast),
            difference_text(&contrast.good, 1.0, 0),
            contrast.right.map_or("-".to_owned(), |right| difference_text(&right, 1.0, 0)),
            difference_text(&contrast.lost_fraction, 100.0, 1),
            difference_text(&contrast.area_m, 1.0, 2),
        );
    }
    for missing in &contrasts.missing {
        text += &missing_text(missing);
        text.push('\n');
    }
    text
}

/// A contrast that could not be computed, and why.
pub fn missing_text(missing: &MissingContrast) -> String {
    format!("{}: {}", title(&missing.pair.of, &missing.pair.over, &missing.setting), missing.reason)
}

/// `children over 10:00 [600 words]`.
fn title(of: &str, over: &str, setting: &str) -> String {
    in_setting(&format!("{of} over {over}"), setting)
}

/// `+12 [+3, +20] better`.
fn difference_text(difference: &Difference, unit: f64, digits: usize) -> String {
    let [low, high] = difference.interval;
    let shown = |value: f64| signed(unit * value, digits);
    format!("{} [{}, {}] {}", shown(difference.difference), shown(low), shown(high), difference.verdict)
}
