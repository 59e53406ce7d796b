//! What the vocabulary's size changes: good localisations over words (thesis Fig 3.4; X2), and what training takes (Fig 3.3; X1).

use super::Figure;
use crate::arrange::Setting;
use crate::chart::{Chart, Line, Mark, Tick, WIDTH};
use crate::data::{Data, Value};
use crate::input::Training;
use crate::legend::Key;
use crate::palette::{Tone, Tones};
use crate::scale::{Scale, tick_text, ticks};
use crate::shape::{mark_path, polyline};
use crate::wording;
use furrow_model::Outcome;
use std::collections::{BTreeMap, BTreeSet};

/// Outcomes of one live pass and experience by the words of their vocabulary.
type Series<'a> = BTreeMap<u32, &'a Outcome>;

/// A number, and its interval where it has one.
type Measured = (f64, Option<[f64; 2]>);

/// None where all cells have as many words.
pub(super) fn localisations(settings: &[Setting<'_>], tones: &Tones) -> Option<Figure> {
    let mut series: BTreeMap<(String, String), Series<'_>> = BTreeMap::new();
    let mut doubled = false;
    for (row, column, cell) in settings.iter().flat_map(Setting::places) {
        let of = series.entry((row.label.clone(), column.label.clone())).or_default();
        doubled |= of.insert(cell.outcome.codebook_words, &cell.outcome).is_some();
    }
    series.retain(|_, outcomes| outcomes.len() > 1);
    // Where settings differ in something else as well, words alone do not tell cells apart.
    if series.is_empty() || doubled {
        return None;
    }
    let mut data = Data::new(&["cell", "live", "experience", "words", "good", "low", "high", "percent_good"]);
    for ((live, experience), outcomes) in &series {
        for (words, outcome) in outcomes {
            let (cell, e) = (outcome.key.short(), &outcome.evaluation);
            let (live, experience) = (live.as_str().into(), experience.as_str().into());
            let [low, high] = e.good_interval.map(Value::from);
            data.push(vec![
                cell.into(),
                live,
                experience,
                (*words).into(),
                e.good.into(),
                low,
                high,
                e.percent_good.into(),
            ]);
        }
    }
    let good = |outcome: &Outcome| {
        let e = &outcome.evaluation;
        Some((f64::from(e.good), Some(e.good_interval.map(f64::from))))
    };
    let percent = |outcome: &Outcome| Some((outcome.evaluation.percent_good?, None));
    Some(Figure {
        id: "vocabulary-figure".to_owned(),
        title: "Vocabulary size".to_owned(),
        caption: "Good localisations, and how many in a hundred returned places are good, over the number of words: a line per live pass and \
            experience, from the outcomes of the settings that differ in nothing else. Counts of single passes; thin uprights are their 95 % intervals \
            of a moving-block bootstrap, which do not cover the difference between one drive and the next."
            .to_owned(),
        panels: vec![
            panel("vocabulary-good", "Good localisations by words", "good localisations (frames)", &series, tones, &good),
            panel("vocabulary-percent", "Share that is good by words", "good in a hundred returned places", &series, tones, &percent),
        ],
        more: Vec::new(),
        data,
    })
}

fn panel(
    id: &str,
    title: &str,
    y_label: &str,
    series: &BTreeMap<(String, String), Series<'_>>,
    tones: &Tones,
    value: &dyn Fn(&Outcome) -> Option<Measured>,
) -> Chart {
    let all = || series.values().flat_map(|outcomes| outcomes.iter());
    let most_words = all().map(|(words, _)| *words).max().unwrap_or(1);
    let height = |(value, interval): Measured| interval.map_or(value, |[_, high]| high.max(value));
    let top = all().filter_map(|(_, outcome)| value(outcome)).map(height).fold(0.0, f64::max);
    let (mut chart, x, y) = axes(id, title, (f64::from(most_words), "words"), (top, y_label));
    let (mut keys, mut told) = (Vec::new(), Vec::new());
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
            let mut title = format!("{name}, {words} words: {}", tick_text(value));
            if let Some([low, high]) = interval {
                title.push_str(&format!(" (95 % interval {} to {})", tick_text(low), tick_text(high)));
                chart.lines.push(Line {
                    d: format!("M{} {}V{}", x.px(f64::from(words)), y.px(low), y.px(high)),
                    tone: tone.clone(),
                    dash: "",
                    width: 1.1,
                    title: title.clone(),
                    series: Some(index),
                    data: vec![("cell", outcome.key.short()), ("low", low.to_string()), ("high", high.to_string())],
                });
            }
            chart.marks.push(Mark {
                d: mark_path(index, x.px(f64::from(words)), y.px(value), 4.2),
                tone: tone.clone(),
                filled: true,
                title: title.clone(),
                series: Some(index),
                data: vec![("cell", outcome.key.short()), ("words", words.to_string()), ("value", value.to_string())],
            });
            told.push(title);
        }
        keys.push(Key::new(&name, tone, Some(""), Some(index % 6), true).of(index));
    }
    chart.desc = format!("{}.", told.join("; "));
    chart.add_legend(keys);
    chart
}

/// None where fewer than two codebooks were trained on different numbers of images.
pub(super) fn training(trained: &[Training]) -> Option<Figure> {
    let images: BTreeSet<u32> = trained.iter().map(|training| training.images).collect();
    if images.len() < 2 {
        return None;
    }
    let mut data = Data::new(&["codebook", "trainer", "images", "words", "seconds"]);
    for t in trained {
        let trainer = wording::shown(&t.trainer);
        data.push(vec![t.codebook.as_str().into(), trainer.into(), t.images.into(), t.words.into(), t.seconds.into()]);
    }
    // Hours as in the thesis, or what people would say of less.
    let longest = trained.iter().filter_map(|training| training.seconds).fold(0.0, f64::max);
    let units = [(3600.0, "hours of training"), (60.0, "minutes of training"), (1.0, "seconds of training")];
    let (unit, of_training) = units.into_iter().find(|(unit, _)| longest >= *unit).unwrap_or(units[2]);
    let took = |training: &Training| training.seconds.map(|seconds| seconds / unit);
    let mut panels = vec![dots("training-words", "Words by images", "words", trained, &|t| Some(f64::from(t.words)))];
    let timed = trained.iter().any(|training| training.seconds.is_some());
    panels.extend(timed.then(|| dots("training-time", "Training by images", of_training, trained, &took)));
    let untimed = if timed { "" } else { " What training took is not known of these codebooks." };
    Some(Figure {
        id: "training-figure".to_owned(),
        title: "What a vocabulary takes".to_owned(),
        caption: format!(
            "Each dot is one codebook of this run: its words, and the wall clock of its training on the machine that did it, over the number \
             of vocabulary images. From the codebooks' records and the catalogue's timings; single trainings, without uncertainty.{untimed}"
        ),
        panels,
        more: Vec::new(),
        data,
    })
}

fn dots(id: &str, title: &str, y_label: &str, trained: &[Training], value: &dyn Fn(&Training) -> Option<f64>) -> Chart {
    let most = trained.iter().map(|training| training.images).max().unwrap_or(1);
    let top = trained.iter().filter_map(value).fold(0.0, f64::max);
    let (mut chart, x, y) = axes(id, title, (f64::from(most), "vocabulary images"), (top, y_label));
    let mut told = Vec::new();
    for (training, value) in trained.iter().filter_map(|training| Some((training, value(training)?))) {
        let title = format!("{} images, {} words: {} {y_label}", training.images, training.words, tick_text(value));
        chart.marks.push(Mark {
            d: mark_path(0, x.px(f64::from(training.images)), y.px(value), 4.2),
            tone: Tone::plain(),
            filled: true,
            title: title.clone(),
            series: None,
            data: vec![("images", training.images.to_string()), ("value", value.to_string())],
        });
        told.push(title);
    }
    chart.desc = format!("{}.", told.join("; "));
    chart
}

/// An empty chart with numbers from 0 on both axes.
pub(super) fn axes(
    id: &str,
    title: &str,
    (most_x, x_label): (f64, &str),
    (most_y, y_label): (f64, &str),
) -> (Chart, Scale, Scale) {
    let (x_ticks, y_ticks) = (ticks(most_x, 5), ticks(most_y, 5));
    let texts: Vec<String> = y_ticks.iter().map(|tick| tick_text(*tick)).collect();
    let widest: Vec<&str> = texts.iter().map(String::as_str).collect();
    let mut chart = Chart::new(id.to_owned(), title.to_owned(), &widest, WIDTH, 210.0);
    chart.leave_room_for(&x_ticks.last().map(|tick| tick_text(*tick)).unwrap_or_default());
    let x = chart.x_scale(x_ticks.last().copied().unwrap_or(1.0));
    let y = chart.y_scale(y_ticks.last().copied().unwrap_or(1.0));
    let tick = |at: f64, value: f64| Tick { at, text: tick_text(value), full: tick_text(value) };
    chart.x_ticks = x_ticks.into_iter().map(|value| tick(x.px(value), value)).collect();
    chart.y_ticks = y_ticks.into_iter().map(|value| tick(y.px(value), value)).collect();
    (chart.x_label, chart.y_label) = (x_label.to_owned(), y_label.to_owned());
    (chart, x, y)
}
