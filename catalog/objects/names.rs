//! The names of objects: digests of bytes, and of values as JSON.

use crate::CatalogError;
use furrow_model::ObjectId;
use serde::Serialize;

/// The name of some bytes.
pub fn digest(bytes: &[u8]) -> ObjectId {
    ObjectId(*blake3::hash(bytes).as_bytes())
}

/// A value's bytes as JSON: keys stand in the order of the fields, so equal values give equal bytes.
///
/// # Errors
/// [`CatalogError::Json`] where JSON cannot hold the value, such as a map whose keys are no texts.
pub fn to_json(value: &impl Serialize) -> Result<Vec<u8>, CatalogError> {
    serde_json::to_vec(value).map_err(CatalogError::Json)
}

/// The name of a value: the digest of its JSON.
///
/// # Errors
/// As [`to_json`].
pub fn digest_of(value: &impl Serialize) -> Result<ObjectId, CatalogError> {
    Ok(digest(&to_json(value)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn what_json_cannot_hold_has_no_name() {
        assert_eq!(digest_of(&("cell/2", 1.5)).unwrap(), digest(br#"["cell/2",1.5]"#));
        let unnamed = BTreeMap::from([([1, 2], "keys of JSON are texts")]);
        assert!(matches!(digest_of(&unnamed), Err(CatalogError::Json(_))));
    }
}
