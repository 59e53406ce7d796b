//! The figures of the thesis, from any run.

pub(crate) mod contrasts;
mod counts;
mod generators;
mod heat_map;
mod inliers;
mod lost_distance;
mod precision_recall;
mod route;
mod style;
mod tracks;
mod variants;
mod vocabulary;

use crate::arrange::Setting;
use crate::chart::Chart;
use crate::data::Data;
use crate::input::{ReportError, ReportInput};
use crate::palette::Tones;

/// A figure: one or more charts under one caption.
pub(crate) struct Figure {
    pub id: String,
    pub title: String,
    /// What is drawn, from what, with what uncertainty.
    pub caption: String,
    pub panels: Vec<Chart>,
    /// Further charts, behind a summary.
    pub more: Vec<(String, Vec<Chart>)>,
    /// The numbers drawn.
    pub data: Data,
}

/// What is compared across settings.
pub(crate) fn overview(input: &ReportInput, settings: &[Setting<'_>], tones: &Tones) -> Vec<Figure> {
    let figures = [vocabulary::localisations(settings, tones), vocabulary::training(&input.trained)];
    figures.into_iter().flatten().collect()
}

/// What numbers rest on: trajectories and generators.
pub(crate) fn across(input: &ReportInput) -> Vec<Figure> {
    [tracks::figure(&input.tracks), generators::figure(&input.generators)].into_iter().flatten().collect()
}

/// All figures of a page, in its order.
pub(crate) fn of_page(
    input: &ReportInput,
    settings: &[Setting<'_>],
    tones: &Tones,
) -> Result<Vec<Figure>, ReportError> {
    let mut all = overview(input, settings, tones);
    all.extend(contrasts::figure(&input.contrasts.found));
    for (i, setting) in settings.iter().enumerate() {
        all.extend(of_setting(setting, &format!("s{i}"), tones)?);
    }
    all.extend(across(input));
    Ok(all)
}

/// All figures of one setting; `name` is unique on the page.
pub(crate) fn of_setting(setting: &Setting<'_>, name: &str, tones: &Tones) -> Result<Vec<Figure>, ReportError> {
    // A cell that shares its page with other settings is one mark: tables say it better.
    let grid = setting.title.is_empty() || setting.cells().count() > 1;
    let counted = grid.then(|| [counts::figure(setting, name, tones), heat_map::figure(setting, name)]);
    let always = [
        lost_distance::figure(setting, name, tones),
        route::figure(setting, name, tones)?,
        inliers::figure(setting, name)?,
    ];
    Ok(counted.into_iter().flatten().chain(always).chain(precision_recall::figure(setting, name, tones)).collect())
}

/// The names behind something a setting's outcomes share or not: `a`, `a and b`, `a, b and c`.
fn listed(names: impl IntoIterator<Item = String>) -> String {
    let names: Vec<String> = names.into_iter().collect();
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

fn thresholds(setting: &Setting<'_>) -> String {
    listed(setting.distinct(|outcome| outcome.threshold_inliers).iter().map(u32::to_string))
}
