//! What training a vocabulary takes: words and hours over vocabulary images (thesis Fig 3.3; experiment X1).

use super::data::Data;
use super::figure::Figure;
use crate::chart::Chart;
use crate::chart::elements::Mark;
use crate::chart::palette::Tone;
use crate::chart::scale::tick_text;
use crate::chart::shape::mark_path;
use crate::input::Training;
use crate::wording;
use std::collections::BTreeSet;

/// None where fewer than two codebooks were trained on different numbers of images.
pub(super) fn figure(trained: &[Training]) -> Option<Figure> {
    let images: BTreeSet<u32> = trained.iter().map(|training| training.images).collect();
    if images.len() < 2 {
        return None;
    }
    // Hours as in the thesis, or a smaller unit for shorter trainings.
    let longest = trained.iter().filter_map(|training| training.seconds).fold(0.0, f64::max);
    let units = [(3600.0, "hours of training"), (60.0, "minutes of training"), (1.0, "seconds of training")];
    let (unit, of_training) = units.into_iter().find(|(unit, _)| longest >= *unit).unwrap_or(units[2]);
    let took = |training: &Training| training.seconds.map(|seconds| seconds / unit);
    let mut panels = vec![dots("training-words", "Words by images", "words", trained, &|t| Some(f64::from(t.words)))];
    let timed = trained.iter().any(|training| training.seconds.is_some());
    panels.extend(timed.then(|| dots("training-time", "Training by images", of_training, trained, &took)));
    let untimed = if timed { "" } else { " How long training took is not known for these codebooks." };
    Some(Figure {
        id: "training-figure".to_owned(),
        title: "Training a vocabulary".to_owned(),
        caption: format!(
            "Each dot is one codebook of this run: its words, and the wall-clock time of its training on the machine \
             that did it, over the number of vocabulary images. From the codebooks' records and the catalogue's \
             timings; single trainings, without uncertainty.{untimed}"
        ),
        panels,
        more: Vec::new(),
        data: data(trained),
    })
}

fn data(trained: &[Training]) -> Data {
    let mut data = Data::new(&["codebook", "trainer", "images", "words", "seconds"]);
    for t in trained {
        let trainer = wording::shown(&t.trainer);
        data.push(vec![t.codebook.as_str().into(), trainer.into(), t.images.into(), t.words.into(), t.seconds.into()]);
    }
    data
}

fn dots(id: &str, title: &str, y_label: &str, trained: &[Training], value: &dyn Fn(&Training) -> Option<f64>) -> Chart {
    let most = trained.iter().map(|training| training.images).max().unwrap_or(1);
    let top = trained.iter().filter_map(value).fold(0.0, f64::max);
    let (mut chart, x, y) = Chart::from_zero(id, title, (f64::from(most), "vocabulary images"), (top, y_label));
    let mut texts = Vec::new();
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
        texts.push(title);
    }
    chart.desc = format!("{}.", texts.join("; "));
    chart
}
