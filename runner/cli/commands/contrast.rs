//! Contrasts as people and programs read them.

use furrow_model::{Contrast, Difference};
use furrow_runner::{Contrasts, Plan};
use serde_json::{Value, json};
use std::fmt::Write;

/// What was found, and what could not be; before a run, what will be asked.
pub(super) fn contrasts_json(contrasts: Option<&Contrasts>, plan: &Plan) -> Value {
    let Some(contrasts) = contrasts else {
        return json!(plan.contrasts.iter().flat_map(|asked| &asked.pairs).collect::<Vec<_>>());
    };
    let missing = contrasts.missing.iter();
    let missing = missing.map(|(pair, reason)| json!({ "of": pair.of, "over": pair.over, "reason": reason }));
    let found = contrasts.found.iter().map(|contrast| {
        let mut value = json!(contrast);
        value["pooled"] = json!(contrast.live.len() > 1);
        value
    });
    json!(found.chain(missing).collect::<Vec<Value>>())
}

/// A table, a line per contrast; empty where none is asked.
pub(super) fn contrasts_text(contrasts: Option<&Contrasts>, plan: &Plan) -> String {
    let Some(contrasts) = contrasts else {
        let pairs = plan.contrasts.iter().flat_map(|asked| &asked.pairs);
        return pairs.map(|pair| format!("contrast {} over {}\n", pair.of, pair.over)).collect();
    };
    if contrasts.found.is_empty() && contrasts.missing.is_empty() {
        return String::new();
    }
    let title = |contrast: &Contrast| format!("{} over {}", contrast.of, contrast.over);
    let wide = contrasts.found.iter().map(|contrast| title(contrast).chars().count()).max().unwrap_or(0).max(8);
    // Two passes may be of one slot.
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
            [pass] if several => format!("{} {}", pass.slot, pass.traversal.short()),
            [pass] => pass.slot.to_string(),
            _ => "pooled".to_owned(),
        };
        let _ = writeln!(
            text,
            "{:<wide$} {live:<live_wide$} {:<28} {:<28} {:<34} {}",
            title(contrast),
            told(&contrast.good, 1.0, 0),
            contrast.right.map_or("-".to_owned(), |right| told(&right, 1.0, 0)),
            told(&contrast.lost_fraction, 100.0, 1),
            told(&contrast.area_m, 1.0, 2),
        );
    }
    for (pair, reason) in &contrasts.missing {
        let _ = writeln!(text, "{} over {}: {reason}", pair.of, pair.over);
    }
    text
}

/// `+12 [3, 20] better`.
fn told(difference: &Difference, unit: f64, digits: usize) -> String {
    let [low, high] = difference.interval;
    let shown = |value: f64| format!("{:+.digits$}", unit * value);
    format!("{} [{}, {}] {}", shown(difference.difference), shown(low), shown(high), difference.verdict)
}
