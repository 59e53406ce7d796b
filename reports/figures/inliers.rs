//! How many inliers verified candidates had, with the threshold (SPEC 7).

use super::{Figure, listed, thresholds};
use crate::arrange::{Row, Setting};
use crate::chart::{Chart, Patch, Rule, Tick, WIDTH};
use crate::data::Data;
use crate::events::{self, Verified};
use crate::input::{CellInput, ReportError};
use crate::legend::Key;
use crate::palette::Tone;
use crate::scale::{rounded, tick_text, ticks, whole_ticks};
use crate::wording;
use std::collections::BTreeSet;

const BINS: u32 = 40;

/// What a ground truth says of a candidate; in the order stacked.
const VERDICTS: [(Option<bool>, &str); 3] =
    [(Some(true), "right place"), (None, "not judged"), (Some(false), "wrong place")];

fn tone(verdict: Option<bool>) -> Tone {
    match verdict {
        Some(true) => Tone::plain(),
        Some(false) => Tone::wrong(),
        None => Tone { class: "tone-soft".to_owned(), light: "#8a929c".to_owned(), dark: String::new() },
    }
}

pub(super) fn figure(setting: &Setting<'_>, name: &str) -> Result<Figure, ReportError> {
    let mut data = Data::new(&["live", "from_inliers", "to_inliers", "place", "count"]);
    let mut panels = Vec::new();
    for (i, row) in setting.rows.iter().enumerate() {
        panels.push(chart(setting, row, format!("{name}-inliers{i}"), &mut data)?);
    }
    let truths =
        setting.distinct(|outcome| outcome.evaluation.ground_truth.as_ref().map(|truth| wording::shown(&truth.source)));
    let judged = match listed(truths.into_iter().flatten()) {
        none if none.is_empty() => "No ground truth judges them.".to_owned(),
        sources => {
            format!("Filled bars are right and hollow ones wrong places, as judged by {sources}; they are stacked.")
        }
    };
    Ok(Figure {
        id: format!("{name}-inliers-figure"),
        title: "Inliers of the candidates".to_owned(),
        caption: format!(
            "How many inliers each verified candidate reached, from the tables of events: a panel per live pass, the cells of single \
             experiences taken together (collectives where there are no others). {judged} The dotted line is the threshold of {} inliers. \
             Counts, without uncertainty.",
            thresholds(setting)
        ),
        panels,
        more: Vec::new(),
        data,
    })
}

/// The cells pooled in a panel: a collective repeats the candidates of its members, so that it counts only where it is alone.
fn pooled<'a>(setting: &Setting<'_>, row: &Row<'a>) -> Vec<&'a CellInput> {
    let of = |collective: bool| -> Vec<&'a CellInput> {
        let columns = setting.columns.iter().zip(&row.cells).filter(|(column, _)| column.collective == collective);
        columns.filter_map(|(_, cell)| *cell).collect()
    };
    let singles = of(false);
    if singles.is_empty() { of(true) } else { singles }
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, data: &mut Data) -> Result<Chart, ReportError> {
    let mut candidates: Vec<Verified> = Vec::new();
    let mut limits = BTreeSet::new();
    for cell in pooled(setting, row) {
        candidates.extend(events::verified(cell)?);
        limits.insert(cell.outcome.threshold_inliers);
    }
    let most = candidates
        .iter()
        .map(|candidate| candidate.inliers)
        .chain(limits.iter().map(|limit| limit + 1))
        .max()
        .unwrap_or(1);
    let bin = most.div_ceil(BINS).max(1);
    // Bins begin at a threshold that all share, so that no bar stands on both sides of it.
    let shift = limits.first().filter(|_| limits.len() == 1).map_or(0, |limit| (bin - limit % bin) % bin);
    let bins = ((most + shift) / bin + 1) as usize;
    let mut heights = vec![[0u32; 3]; bins];
    for candidate in &candidates {
        let verdict = VERDICTS.iter().position(|(verdict, _)| *verdict == candidate.correct).unwrap_or(1);
        heights[((candidate.inliers + shift) / bin) as usize][verdict] += 1;
    }
    let y_ticks = whole_ticks(heights.iter().map(|bar| bar.iter().sum::<u32>()).max().unwrap_or(0), 4);
    let texts: Vec<String> = y_ticks.iter().map(|tick| tick_text(*tick)).collect();
    let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
    let mut chart = Chart::new(id, format!("Live {}: inliers", row.label), &widest, WIDTH, 170.0);
    let (x, y) = (
        chart.x_scale(f64::from(bin) * bins as f64 - f64::from(shift)),
        chart.y_scale(y_ticks.last().copied().unwrap_or(1.0)),
    );
    let tick = |at: f64, text: String| Tick { at, full: text.clone(), text };
    chart.y_ticks = y_ticks.iter().zip(texts).map(|(value, text)| tick(y.px(*value), text)).collect();
    let x_values = ticks(x.to, 6).into_iter().filter(|value| *value <= x.to && value.fract() == 0.0);
    chart.x_ticks = x_values.map(|value| tick(x.px(value), tick_text(value))).collect();
    chart.x_label = if bin == 1 { "inliers".to_owned() } else { format!("inliers, in bins of {bin}") };
    chart.y_label = "verified candidates".to_owned();
    for (i, bar) in heights.iter().enumerate() {
        let (from, to) = ((i as u32 * bin).saturating_sub(shift), (i as u32 + 1) * bin - shift);
        let mut below = 0;
        for (j, count) in bar.iter().copied().enumerate().filter(|(_, count)| *count > 0) {
            let (left, right) = (x.px(f64::from(from)), x.px(f64::from(to)));
            let (top, bottom) = (y.px(f64::from(below + count)), y.px(f64::from(below)));
            let range = if to == from + 1 { from.to_string() } else { format!("{from} to {}", to - 1) };
            data.push(vec![row.label.clone().into(), from.into(), (to - 1).into(), VERDICTS[j].1.into(), count.into()]);
            let hollow = VERDICTS[j].0 == Some(false);
            let inset = if hollow { 1.2 } else { 0.5 };
            chart.patches.push(Patch {
                x: rounded(left + inset),
                y: rounded(top + if hollow { 0.8 } else { 0.0 }),
                w: rounded((right - left - 2.0 * inset).max(0.4)),
                h: rounded((bottom - top - if hollow { 0.8 } else { 0.0 }).max(0.4)),
                tone: tone(VERDICTS[j].0),
                opacity: 0.85,
                hollow,
                text: String::new(),
                title: format!("{range} inliers, {}: {count}", VERDICTS[j].1),
                series: Some(j),
                data: vec![("from", from.to_string()), ("count", count.to_string())],
            });
            below += count;
        }
    }
    for limit in &limits {
        let at = x.px(f64::from(*limit));
        chart.rules.push(Rule {
            x: at,
            text: format!("threshold {limit}"),
            before: at > chart.plot.x + 0.7 * chart.plot.w,
        });
    }
    let total = |verdict: usize| heights.iter().map(|bar| bar[verdict]).sum::<u32>();
    let told: Vec<String> = VERDICTS.iter().enumerate().map(|(i, (_, name))| format!("{name}: {}", total(i))).collect();
    chart.desc = format!(
        "{} verified candidates. {}. Threshold {}.",
        candidates.len(),
        told.join("; "),
        listed(limits.iter().map(u32::to_string))
    );
    let keys = VERDICTS.iter().enumerate().filter(|(i, _)| total(*i) > 0);
    chart.add_legend(
        keys.map(|(i, (verdict, name))| Key::patch(name, tone(*verdict), *verdict != Some(false)).of(i)).collect(),
    );
    Ok(chart)
}
