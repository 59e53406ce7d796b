//! Where two records part.

use furrow_catalog::CatalogError;
use furrow_catalog::records::{Record, encode};
use serde::Serialize;
use serde_json::Value;

/// Something that came out otherwise.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// What: a traversal, a generator or a cell.
    pub subject: String,
    /// The field where both part, as in `body.evaluation.good`.
    pub place: String,
    /// What the first store has there.
    pub expected: String,
    /// What the fresh one has.
    pub found: String,
}

/// The first place where two records part; none where their ids are equal.
pub(super) fn difference<R: Record>(
    subject: String,
    expected: &R,
    found: &R,
) -> Result<Option<Difference>, CatalogError> {
    let (a, b) = (encode(expected)?, encode(found)?);
    if a == b {
        return Ok(None);
    }
    let value = |bytes: &[u8]| serde_json::from_slice::<Value>(bytes).map_err(CatalogError::Json);
    let (place, expected, found) = parting("", &value(&a)?, &value(&b)?).unwrap_or_default();
    Ok(Some(Difference { subject, place, expected, found }))
}

fn parting(place: &str, a: &Value, b: &Value) -> Option<(String, String, String)> {
    let below = |name: &str| if place.is_empty() { name.to_owned() } else { format!("{place}.{name}") };
    let none = Value::Null;
    match (a, b) {
        (Value::Object(fields), Value::Object(others)) => {
            let names = fields.keys().chain(others.keys().filter(|name| !fields.contains_key(*name)));
            names.into_iter().find_map(|name| {
                parting(&below(name), fields.get(name).unwrap_or(&none), others.get(name).unwrap_or(&none))
            })
        }
        (Value::Array(items), Value::Array(others)) if items.len() == others.len() => {
            items.iter().zip(others).enumerate().find_map(|(i, (a, b))| parting(&below(&i.to_string()), a, b))
        }
        _ if a == b => None,
        _ => Some((place.to_owned(), shortened(a), shortened(b))),
    }
}

fn shortened(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(120) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_place_where_two_values_part_is_named() {
        let parting = |a: Value, b: Value| parting("", &a, &b).map(|(place, ..)| place);
        assert_eq!(parting(json!({"a": [1, {"b": 2}]}), json!({"a": [1, {"b": 2}]})), None);
        assert_eq!(parting(json!({"a": [1, {"b": 2}]}), json!({"a": [1, {"b": 3}]})).as_deref(), Some("a.1.b"));
        assert_eq!(parting(json!({"a": [1]}), json!({"a": [1, 2]})).as_deref(), Some("a"));
        assert_eq!(parting(json!({}), json!({"new": 1})).as_deref(), Some("new"));
    }
}
