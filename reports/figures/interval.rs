//! The interval of a cell's number.

use crate::chart::elements::Line;
use crate::chart::palette::Tone;
use crate::chart::scale::Scale;

/// An upright line at `x` from the low bound to the high one.
pub(super) fn upright(
    (x, y): (f64, Scale),
    [low, high]: [f64; 2],
    tone: &Tone,
    title: &str,
    (series, cell): (usize, String),
) -> Line {
    Line {
        d: format!("M{x} {}V{}", y.px(low), y.px(high)),
        tone: tone.clone(),
        dash: "",
        width: 1.1,
        title: title.to_owned(),
        series: Some(series),
        data: vec![("cell", cell), ("low", low.to_string()), ("high", high.to_string())],
    }
}
