//! The check that numbers of descriptors and words are finite.

use super::dimensions::Descriptor;
use super::error::VocabularyError;

/// The largest magnitude of a descriptor's number: keeps squared distances far inside `f32`.
const LARGEST: f32 = 1e9;

/// Refuses numbers that are not finite or absurdly large.
pub(super) fn check_finite(what: &'static str, rows: &[Descriptor]) -> Result<(), VocabularyError> {
    for (index, row) in rows.iter().enumerate() {
        let is_bad = |value: f32| value.is_nan() || value.abs() > LARGEST;
        if let Some((position, &value)) = row.iter().enumerate().find(|(_, value)| is_bad(**value)) {
            return Err(VocabularyError::NotFinite { what, index, position, value });
        }
    }
    Ok(())
}
