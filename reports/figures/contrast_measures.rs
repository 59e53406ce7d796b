//! The measures of a contrast as a figure draws them, and its data.

use super::contrast_rows::{drawn, live};
use super::data::Data;
use crate::wording;
use furrow_model::{Contrast, Difference};

/// A measure as it is drawn.
pub(super) struct Measure {
    pub id: &'static str,
    pub title: &'static str,
    pub x_label: &'static str,
    /// The difference, and what it is multiplied by.
    difference: fn(&Contrast) -> Option<(Difference, f64)>,
}

/// Counts are drawn as percentages of the live frames, so that traversals of other lengths stand beside each other.
pub(super) const MEASURES: [Measure; 4] = [
    Measure {
        id: "right",
        title: "Right localisations: difference",
        x_label: "percentage points of live frames; right is better",
        difference: |contrast| Some((contrast.right?, 100.0 / f64::from(contrast.frames.max(1)))),
    },
    Measure {
        id: "good",
        title: "Good localisations: difference",
        x_label: "percentage points of live frames; right is better",
        difference: |contrast| Some((contrast.good, 100.0 / f64::from(contrast.frames.max(1)))),
    },
    Measure {
        id: "lost",
        title: "Lost: difference",
        x_label: "percentage points of the route; left is better",
        difference: |contrast| Some((contrast.lost_fraction, 100.0)),
    },
    Measure {
        id: "area",
        title: "Lost-distance area: difference",
        x_label: "metres; left is better",
        difference: |contrast| Some((contrast.area_m, 1.0)),
    },
];

/// All differences that the figure draws.
pub(super) fn data(contrasts: &[Contrast]) -> Data {
    let mut data = Data::new(&[
        "measure",
        "of",
        "over",
        "setting",
        "live",
        "frames",
        "difference",
        "low",
        "high",
        "verdict",
        "p",
        "p_holm",
    ]);
    for measure in &MEASURES {
        for (contrast, difference) in rows(measure, contrasts) {
            let [low, high] = difference.interval.map_or([None; 2], |interval| interval.map(Some));
            data.push(vec![
                measure.id.into(),
                wording::shown(&contrast.of).into(),
                wording::shown(&contrast.over).into(),
                wording::shown(&contrast.setting).into(),
                live(contrast, contrasts).into(),
                contrast.frames.into(),
                difference.difference.into(),
                low.into(),
                high.into(),
                difference.verdict.to_string().into(),
                difference.p.into(),
                difference.p_holm.into(),
            ]);
        }
    }
    data
}

/// The contrasts a panel draws, in its unit.
pub(super) fn rows<'c>(measure: &Measure, contrasts: &'c [Contrast]) -> Vec<(&'c Contrast, Difference)> {
    let row = |contrast| (measure.difference)(contrast).map(|(difference, unit)| (contrast, scaled(&difference, unit)));
    drawn(contrasts).filter_map(row).collect()
}

fn scaled(difference: &Difference, unit: f64) -> Difference {
    Difference {
        of: difference.of * unit,
        over: difference.over * unit,
        difference: difference.difference * unit,
        interval: difference.interval.map(|interval| interval.map(|bound| bound * unit)),
        error_within: difference.error_within.map(|error| error * unit),
        error_between: difference.error_between.map(|error| error * unit),
        ..*difference
    }
}
