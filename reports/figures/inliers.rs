//! How many inliers verified candidates had, beside the threshold (thesis Fig 3.5 has the verification).

use super::arrange::{Row, Setting};
use super::data::Data;
use super::events::Events;
use super::figure::Figure;
use crate::chart::elements::{Key, Patch, Rule, Tick};
use crate::chart::palette::Tone;
use crate::chart::scale::{Scale, rounded, tick_text, ticks, whole_ticks};
use crate::chart::{Chart, WIDTH, number_ticks};
use crate::error::ReportError;
use crate::input::CellInput;
use crate::wording::listed;
use std::collections::BTreeSet;

const BINS: u32 = 40;

/// What a ground truth says of a candidate; in the order stacked.
const VERDICTS: [(Option<bool>, &str); 3] =
    [(Some(true), "right place"), (None, "not judged"), (Some(false), "wrong place")];

fn tone(verdict: Option<bool>) -> Tone {
    match verdict {
        Some(true) => Tone::plain(),
        Some(false) => Tone::wrong(),
        None => Tone::soft(),
    }
}

pub(super) fn figure(setting: &Setting<'_>, name: &str) -> Result<Figure, ReportError> {
    let mut data = Data::new(&["live", "from_inliers", "to_inliers", "place", "count"]);
    let mut panels = Vec::new();
    for (i, row) in setting.rows.iter().enumerate() {
        panels.push(chart(setting, row, format!("{name}-inliers{i}"), &mut data)?);
    }
    let judged = match setting.truths() {
        None => "No ground truth judges them.".to_owned(),
        Some(truths) => format!("Bars are stacked: filled right places, hollow wrong places, according to {truths}."),
    };
    Ok(Figure {
        id: format!("{name}-inliers-figure"),
        title: "Inliers of verified candidates".to_owned(),
        caption: format!(
            "Inliers of each verified candidate, from the tables of events: one panel per live traversal, the cells of \
             single experiences pooled (collectives only where there are no others). {judged} The dotted line is the \
             threshold of {} inliers. Counts, without uncertainty.",
            setting.thresholds()
        ),
        panels,
        more: Vec::new(),
        data,
    })
}

/// The cells pooled in a panel: a collective repeats the candidates of its members, so that it counts only where it is
/// alone.
fn pooled<'a>(setting: &Setting<'_>, row: &Row<'a>) -> Vec<&'a CellInput> {
    let cells = |collective: bool| -> Vec<&'a CellInput> {
        let columns = setting.columns.iter().zip(&row.cells).filter(|(column, _)| column.collective == collective);
        columns.filter_map(|(_, cell)| *cell).collect()
    };
    let singles = cells(false);
    if singles.is_empty() { cells(true) } else { singles }
}

/// Counts of candidates by inliers, in bins of `bin`, and in each by verdict.
struct Histogram {
    bin: u32,
    /// How far the first bin begins below zero.
    shift: u32,
    bars: Vec<[u32; 3]>,
}

impl Histogram {
    fn of(candidates: &[(u32, Option<bool>)], thresholds: &BTreeSet<u32>) -> Self {
        let inliers = candidates.iter().map(|(inliers, _)| *inliers);
        let most = inliers.chain(thresholds.iter().map(|threshold| threshold + 1)).max().unwrap_or(1);
        let bin = most.div_ceil(BINS).max(1);
        // Bins begin at a threshold that all share, so that no bar stands on both sides of it.
        let shared = thresholds.first().filter(|_| thresholds.len() == 1);
        let shift = shared.map_or(0, |threshold| (bin - threshold % bin) % bin);
        let mut bars = vec![[0; 3]; ((most + shift) / bin + 1) as usize];
        for (inliers, correct) in candidates {
            let verdict = VERDICTS.iter().position(|(verdict, _)| verdict == correct).unwrap_or(1);
            bars[((inliers + shift) / bin) as usize][verdict] += 1;
        }
        Self { bin, shift, bars }
    }

    /// The inliers of a bar: the least, and the least of the next one.
    fn range(&self, bar: usize) -> (u32, u32) {
        let bar = bar as u32;
        ((bar * self.bin).saturating_sub(self.shift), (bar + 1) * self.bin - self.shift)
    }

    fn highest(&self) -> u32 {
        self.bars.iter().map(|bar| bar.iter().sum()).max().unwrap_or(0)
    }

    fn total(&self, verdict: usize) -> u32 {
        self.bars.iter().map(|bar| bar[verdict]).sum()
    }
}

fn chart(setting: &Setting<'_>, row: &Row<'_>, id: String, data: &mut Data) -> Result<Chart, ReportError> {
    let mut candidates = Vec::new();
    let mut thresholds = BTreeSet::new();
    for cell in pooled(setting, row) {
        candidates.extend(Events::of(cell)?.verified());
        thresholds.insert(cell.outcome.threshold_inliers);
    }
    let histogram = Histogram::of(&candidates, &thresholds);
    let y_ticks = whole_ticks(histogram.highest(), 4);
    let texts: Vec<String> = y_ticks.iter().map(|tick| tick_text(*tick)).collect();
    let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
    let mut chart = Chart::new(id, format!("Live {}: inliers", row.label), &widest, WIDTH, 170.0);
    let x = chart.x_scale(f64::from(histogram.bin) * histogram.bars.len() as f64 - f64::from(histogram.shift));
    let y = chart.y_scale(y_ticks.last().copied().unwrap_or(1.0));
    chart.y_ticks = y_ticks.iter().zip(texts).map(|(value, text)| Tick::new(y.px(*value), text)).collect();
    let whole = ticks(x.to, 6).into_iter().filter(|value| *value <= x.to && value.fract() == 0.0);
    chart.x_ticks = number_ticks(x, whole);
    let bin = histogram.bin;
    chart.x_label = if bin == 1 { "inliers".to_owned() } else { format!("inliers, in bins of {bin}") };
    chart.y_label = "verified candidates".to_owned();
    for bar in 0..histogram.bars.len() {
        draw_bar(&mut chart, (x, y), &histogram, bar, (&row.label, data));
    }
    for threshold in &thresholds {
        let at = x.px(f64::from(*threshold));
        let before = at > chart.plot.x + 0.7 * chart.plot.w;
        chart.rules.push(Rule { x: at, text: format!("threshold {threshold}"), before });
    }
    let totals = VERDICTS.iter().enumerate().map(|(i, (_, name))| format!("{name}: {}", histogram.total(i)));
    chart.desc = format!(
        "{} verified candidates. {}. Threshold {}.",
        candidates.len(),
        totals.collect::<Vec<_>>().join("; "),
        listed(thresholds.iter().map(u32::to_string))
    );
    let there = VERDICTS.iter().enumerate().filter(|(i, _)| histogram.total(*i) > 0);
    let key = |(i, (verdict, name)): (usize, &(Option<bool>, &str))| {
        Key::patch(name, tone(*verdict), *verdict != Some(false)).switching(i)
    };
    chart.add_legend(there.map(key).collect());
    Ok(chart)
}

/// One bar, its verdicts stacked, and its rows of the figure's data.
fn draw_bar(
    chart: &mut Chart,
    (x, y): (Scale, Scale),
    histogram: &Histogram,
    bar: usize,
    (live, data): (&str, &mut Data),
) {
    let (from, to) = histogram.range(bar);
    let (left, right) = (x.px(f64::from(from)), x.px(f64::from(to)));
    let range = if to == from + 1 { from.to_string() } else { format!("{from} to {}", to - 1) };
    let mut below = 0;
    for (j, count) in histogram.bars[bar].iter().copied().enumerate().filter(|(_, count)| *count > 0) {
        let (verdict, name) = VERDICTS[j];
        let (top, bottom) = (y.px(f64::from(below + count)), y.px(f64::from(below)));
        data.push(vec![live.into(), from.into(), (to - 1).into(), name.into(), count.into()]);
        let hollow = verdict == Some(false);
        let (inset, edge) = if hollow { (1.2, 0.8) } else { (0.5, 0.0) };
        chart.patches.push(Patch {
            x: rounded(left + inset),
            y: rounded(top + edge),
            w: rounded((right - left - 2.0 * inset).max(0.4)),
            h: rounded((bottom - top - edge).max(0.4)),
            tone: tone(verdict),
            opacity: 0.85,
            hollow,
            text: String::new(),
            title: format!("{range} inliers, {name}: {count}"),
            series: Some(j),
            data: vec![("from", from.to_string()), ("count", count.to_string())],
        });
        below += count;
    }
}
