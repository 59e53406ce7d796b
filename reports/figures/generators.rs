//! What generators do to features: good matches with the source over domainness (thesis Fig 5.5; experiment X4).

use super::data::Data;
use super::figure::Figure;
use crate::chart::Chart;
use crate::chart::elements::{Key, Line, Mark};
use crate::chart::palette::Tone;
use crate::chart::scale::tick_text;
use crate::chart::shape::{mark_path, polyline};
use crate::chart::text::fitted;
use crate::input::GeneratorInput;
use crate::wording;

const DASHES: [&str; 4] = ["", "9 3 2 3", "2 3", "12 4"];

/// None where the quality gate has measured nothing.
pub(super) fn figure(generators: &[GeneratorInput]) -> Option<Figure> {
    let measured: Vec<&GeneratorInput> = generators.iter().filter(|generator| !generator.curves.is_empty()).collect();
    if measured.is_empty() {
        return None;
    }
    let mut data = Data::new(&["generator", "parent", "z", "good_matches", "matchable"]);
    for generator in &measured {
        for curve in &generator.curves {
            for point in &curve.points {
                let names = [&generator.name, &curve.parent].map(|name| wording::shown(name).into());
                let [name, parent] = names;
                data.push(vec![name, parent, point.z.into(), point.good_matches.into(), point.matchable.into()]);
            }
        }
    }
    Some(Figure {
        id: "generators-figure".to_owned(),
        title: "Features that generators preserve".to_owned(),
        caption: "Good matches (descriptor distance below half that of the second nearest) between an image and its \
            generated version at domainness z: one panel per generator, one line per experience that it was measured \
            on, from the records of the quality gate. Means over a few of the experience's images, without \
            uncertainty. A dip in the middle is a generator that switches between two appearances instead of changing \
            gradually."
            .to_owned(),
        panels: measured.iter().enumerate().map(|(i, generator)| panel(i, generator)).collect(),
        more: Vec::new(),
        data,
    })
}

fn panel(index: usize, generator: &GeneratorInput) -> Chart {
    let points = || generator.curves.iter().flat_map(|curve| &curve.points);
    let (far, top) = points().fold((0.0, 0.0), |(z, good), p| (p.z.max(z), p.good_matches.max(good)));
    let name = wording::shown(&generator.name);
    let id = format!("generators-{index}");
    let title = fitted(&format!("{name}: good matches"), 13.0, 460.0);
    let (mut chart, x, y) = Chart::from_zero(&id, &title, (far, "domainness z"), (top, "good matches per image"));
    let (mut keys, mut texts) = (Vec::new(), Vec::new());
    for (series, curve) in generator.curves.iter().enumerate() {
        let parent = format!("of {}", wording::shown(&curve.parent));
        let (tone, dash) = (Tone::plain(), DASHES[series % DASHES.len()]);
        chart.lines.push(Line {
            d: polyline(curve.points.iter().map(|p| (x.px(p.z), y.px(p.good_matches)))),
            tone: tone.clone(),
            dash,
            width: 2.0,
            title: parent.clone(),
            series: Some(series),
            data: Vec::new(),
        });
        for point in &curve.points {
            let (good, all) = (tick_text(point.good_matches), tick_text(point.matchable));
            let title = format!("{parent}, z = {}: {good} good matches of {all}", tick_text(point.z));
            chart.marks.push(Mark {
                d: mark_path(series, x.px(point.z), y.px(point.good_matches), 4.2),
                tone: tone.clone(),
                filled: true,
                title: title.clone(),
                series: Some(series),
                data: vec![("z", point.z.to_string()), ("good", point.good_matches.to_string())],
            });
            texts.push(title);
        }
        keys.push(Key::new(&parent, tone, Some(dash), Some(series % 6), true).switching(series));
    }
    chart.desc = format!("{}.", texts.join("; "));
    chart.add_legend(keys);
    chart
}
