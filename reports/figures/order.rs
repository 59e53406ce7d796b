//! Which figures a page has, and in what order.

use super::arrange::Setting;
use super::figure::Figure;
use super::{
    contrasts as differences, counts, generators, heat_map, inliers, lost_distance, precision_recall, route, tracks,
    training, vocabulary,
};
use crate::chart::palette::Tones;
use crate::error::ReportError;
use crate::input::ReportInput;

/// What is compared across settings.
pub(crate) fn overview(input: &ReportInput, settings: &[Setting<'_>], tones: &Tones) -> Vec<Figure> {
    [vocabulary::figure(settings, tones), training::figure(&input.trained)].into_iter().flatten().collect()
}

/// Which contender beats which; none where the matrix asks for no contrast.
pub(crate) fn contrasts(input: &ReportInput) -> Option<Figure> {
    differences::figure(&input.contrasts.found)
}

/// What numbers rest on: trajectories and generators.
pub(crate) fn across(input: &ReportInput) -> Vec<Figure> {
    [tracks::figure(&input.tracks), generators::figure(&input.generators)].into_iter().flatten().collect()
}

/// All figures of one setting, which is the page's `index`th.
pub(crate) fn of_setting(setting: &Setting<'_>, index: usize, tones: &Tones) -> Result<Vec<Figure>, ReportError> {
    let name = &format!("s{index}");
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

/// All figures of a page.
pub(crate) fn of_page(
    input: &ReportInput,
    settings: &[Setting<'_>],
    tones: &Tones,
) -> Result<Vec<Figure>, ReportError> {
    let mut all = overview(input, settings, tones);
    all.extend(contrasts(input));
    for (index, setting) in settings.iter().enumerate() {
        all.extend(of_setting(setting, index, tones)?);
    }
    all.extend(across(input));
    Ok(all)
}
