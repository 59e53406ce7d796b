//! Contrasts as rows of figures and tables: their names, and which of them are pooled.

use crate::wording;
use furrow_model::Contrast;

/// `children over 10:00`, and the setting where there are several.
pub(super) fn title(contrast: &Contrast) -> String {
    let (of, over) = (wording::shown(&contrast.of), wording::shown(&contrast.over));
    match contrast.setting.as_str() {
        "" => format!("{of} over {over}"),
        setting => format!("{of} over {over} [{}]", wording::shown(setting)),
    }
}

/// Whether the same two contenders are also compared over several traversals.
fn is_pooled(contrast: &Contrast, contrasts: &[Contrast]) -> bool {
    let what = |contrast: &Contrast| [&contrast.of, &contrast.over, &contrast.setting].map(String::clone);
    contrasts.iter().any(|other| other.live.len() > 1 && what(other) == what(contrast))
}

/// Those that a figure draws: one traversal alone only where it is not pooled with others.
pub(super) fn drawn(contrasts: &[Contrast]) -> impl Iterator<Item = &Contrast> {
    contrasts.iter().filter(|contrast| contrast.live.len() > 1 || !is_pooled(contrast, contrasts))
}

/// The live traversal as people name it; its id beside its slot where traversals are pooled, since two may be of one
/// slot.
pub(crate) fn live(contrast: &Contrast, contrasts: &[Contrast]) -> String {
    match contrast.live.as_slice() {
        [one] if is_pooled(contrast, contrasts) => format!("{} ({})", one.slot, one.traversal.short()),
        [one] => one.slot.to_string(),
        several => format!("{} traversals pooled", several.len()),
    }
}
