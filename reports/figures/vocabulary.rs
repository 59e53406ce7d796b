//! What the vocabulary's size changes: good localisations over words (thesis Fig 3.4; experiment X2).

use super::arrange::Setting;
use super::data::{Data, Value};
use super::figure::Figure;
use super::interval;
use crate::chart::Chart;
use crate::chart::elements::{Key, Line, Mark};
use crate::chart::palette::{Tone, Tones};
use crate::chart::scale::tick_text;
use crate::chart::shape::{mark_path, polyline};
use furrow_model::Outcome;
use std::collections::BTreeMap;

/// Outcomes of one live traversal and experience by the words of their vocabulary.
type Series<'a> = BTreeMap<u32, &'a Outcome>;

/// Series by the labels of their live traversal and experience.
type AllSeries<'a> = BTreeMap<(String, String), Series<'a>>;

/// A number, and its interval where it has one.
type Measured = (f64, Option<[f64; 2]>);

/// None where all cells have as many words.
pub(super) fn figure(settings: &[Setting<'_>], tones: &Tones) -> Option<Figure> {
    let series = series(settings)?;
    let good = |outcome: &Outcome| {
        let e = &outcome.evaluation;
        Some((f64::from(e.good), e.good_interval.map(|ends| ends.map(f64::from))))
    };
    let percent = |outcome: &Outcome| Some((outcome.evaluation.percent_good?, None));
    let good_texts = ["Good localisations by words", "good localisations (frames)"];
    let percent_texts = ["Percentage that is good by words", "good (% of returned places)"];
    Some(Figure {
        id: "vocabulary-figure".to_owned(),
        title: "Vocabulary size".to_owned(),
        caption: "Good localisations, and the percentage of returned places that are good, over the number of words: \
            one line per live traversal and experience, from settings that differ in nothing else. Counts of single \
            traversals; vertical bars are 95 % intervals along one road, which do not cover the variation between \
            traversals; a traversal of less than 60 m has none."
            .to_owned(),
        panels: vec![
            panel("vocabulary-good", good_texts, &series, tones, &good),
            panel("vocabulary-percent", percent_texts, &series, tones, &percent),
        ],
        more: Vec::new(),
        data: data(&series),
    })
}

fn series<'a>(settings: &[Setting<'a>]) -> Option<AllSeries<'a>> {
    let mut series = AllSeries::new();
    let mut doubled = false;
    for (row, column, cell) in settings.iter().flat_map(Setting::places) {
        let outcomes = series.entry((row.label.clone(), column.label.clone())).or_default();
        doubled |= outcomes.insert(cell.outcome.codebook_words, &cell.outcome).is_some();
    }
    series.retain(|_, outcomes| outcomes.len() > 1);
    // Where settings differ in something else as well, words alone do not tell cells apart.
    (!series.is_empty() && !doubled).then_some(series)
}

fn data(series: &AllSeries<'_>) -> Data {
    let mut data = Data::new(&["cell", "live", "experience", "words", "good", "low", "high", "percent_good"]);
    for ((live, experience), outcomes) in series {
        for (words, outcome) in outcomes {
            let e = &outcome.evaluation;
            let [low, high] = e.good_interval.map_or([Value::Missing, Value::Missing], |ends| ends.map(Value::from));
            data.push(vec![
                outcome.key.short().into(),
                live.as_str().into(),
                experience.as_str().into(),
                (*words).into(),
                e.good.into(),
                low,
                high,
                e.percent_good.into(),
            ]);
        }
    }
    data
}

fn panel(
    id: &str,
    [title, y_label]: [&str; 2],
    series: &AllSeries<'_>,
    tones: &Tones,
    value: &dyn Fn(&Outcome) -> Option<Measured>,
) -> Chart {
    let all = || series.values().flat_map(|outcomes| outcomes.iter());
    let most_words = all().map(|(words, _)| *words).max().unwrap_or(1);
    let height = |(value, interval): Measured| interval.map_or(value, |[_, high]| high.max(value));
    let top = all().filter_map(|(_, outcome)| value(outcome)).map(height).fold(0.0, f64::max);
    let (mut chart, x, y) = Chart::from_zero(id, title, (f64::from(most_words), "words"), (top, y_label));
    let (mut keys, mut texts) = (Vec::new(), Vec::new());
    for (index, ((live, experience), outcomes)) in series.iter().enumerate() {
        let slot = outcomes.values().find_map(|outcome| outcome.members.first()).map(|member| member.slot);
        let tone = slot.map_or_else(Tone::ink, |slot| tones.of(slot));
        let name = format!("live {live} against {experience}");
        let cells: Vec<String> = outcomes.values().map(|outcome| outcome.key.short()).collect();
        let points = outcomes.iter().filter_map(|(words, outcome)| Some((*words, *outcome, value(outcome)?)));
        let points: Vec<(u32, &Outcome, Measured)> = points.collect();
        chart.lines.push(Line {
            d: polyline(points.iter().map(|(words, _, (value, _))| (x.px(f64::from(*words)), y.px(*value)))),
            tone: tone.clone(),
            dash: "",
            width: 2.0,
            title: name.clone(),
            series: Some(index),
            data: vec![("cells", cells.join(" "))],
        });
        for (words, outcome, (value, interval)) in points {
            let (px, key) = (x.px(f64::from(words)), outcome.key.short());
            let mut title = format!("{name}, {words} words: {}", tick_text(value));
            if let Some([low, high]) = interval {
                title.push_str(&format!(" (95 % interval {} to {})", tick_text(low), tick_text(high)));
                chart.lines.push(interval::upright((px, y), [low, high], &tone, &title, (index, key.clone())));
            }
            chart.marks.push(Mark {
                d: mark_path(index, px, y.px(value), 4.2),
                tone: tone.clone(),
                filled: true,
                title: title.clone(),
                series: Some(index),
                data: vec![("cell", key), ("words", words.to_string()), ("value", value.to_string())],
            });
            texts.push(title);
        }
        keys.push(Key::new(&name, tone, Some(""), Some(index % 6), true).switching(index));
    }
    chart.desc = format!("{}.", texts.join("; "));
    chart.add_legend(keys);
    chart
}
