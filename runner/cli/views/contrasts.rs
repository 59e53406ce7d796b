//! Contrasts, asked for and answered.

use super::cells::in_setting;
use furrow_model::{Contrast, Difference, chance, signed};
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
    let mut text =
        "\ndifferences with 95 % intervals by Student's t, along a traversal of 60 m or more, or over several; \
                    p, and p corrected for the number of contrasts (Holm)\n"
            .to_owned();
    let rows: Vec<[String; 4]> = contrasts.found.iter().map(numbers).collect();
    let widest = |i: usize| rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0).max(8);
    let [good, right, lost, _] = [0, 1, 2, 3].map(widest);
    let _ = writeln!(
        text,
        "{:<wide$} {:<live_wide$} {:<good$} {:<right$} {:<lost$} lost-distance area, m",
        "contrast", "live", "good", "right", "lost %"
    );
    for (contrast, row) in contrasts.found.iter().zip(&rows) {
        let live = match contrast.live.as_slice() {
            [one] if several => format!("{} {}", one.slot, one.traversal.short()),
            [one] => one.slot.to_string(),
            _ => "pooled".to_owned(),
        };
        let _ = writeln!(
            text,
            "{:<wide$} {live:<live_wide$} {:<good$} {:<right$} {:<lost$} {}",
            named(contrast),
            row[0],
            row[1],
            row[2],
            row[3],
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

/// Good, right, lost in percent, area in metres.
fn numbers(contrast: &Contrast) -> [String; 4] {
    [
        difference_text(&contrast.good, 1.0, 0),
        contrast.right.map_or("-".to_owned(), |right| difference_text(&right, 1.0, 0)),
        difference_text(&contrast.lost_fraction, 100.0, 1),
        difference_text(&contrast.area_m, 1.0, 2),
    ]
}

/// `+12 [+3, +20] better, p 0.012, Holm 0.024`; without an interval why there is none.
fn difference_text(difference: &Difference, unit: f64, digits: usize) -> String {
    let shown = |value: f64| signed(unit * value, digits);
    let (value, verdict) = (shown(difference.difference), difference.verdict);
    let Some([low, high]) = difference.interval else { return format!("{value} {verdict}") };
    let p = difference.p.map_or(String::new(), |p| format!(", p {}", chance(p)));
    let holm = difference.p_holm.map_or(String::new(), |p| format!(", Holm {}", chance(p)));
    format!("{value} [{}, {}] {verdict}{p}{holm}", shown(low), shown(high))
}
