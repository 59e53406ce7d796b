//! What a stored record is, and how it becomes bytes and is read back.

use crate::{CatalogError, Objects, digest, to_json};
use furrow_model::ObjectId;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A stored record: what names its kind and format.
pub trait Record: Serialize + DeserializeOwned {
    /// The kind, as written in the record.
    const KIND: &'static str;
    /// The version of the format. It changes whenever a field does.
    const VERSION: u32;

    /// Brings the body of an older version, 1 to the one before today's, to today's form.
    ///
    /// # Errors
    /// What the older version lacks, and what to do.
    fn upgrade(_version: u32, body: Value) -> Result<Value, String> {
        Ok(body)
    }
}

#[derive(Serialize)]
struct Written<'a, R> {
    kind: &'a str,
    version: u32,
    body: &'a R,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    kind: String,
    version: u32,
    body: Value,
}

/// A record's bytes, in today's version.
///
/// # Errors
/// As [`to_json`].
pub fn encode<R: Record>(record: &R) -> Result<Vec<u8>, CatalogError> {
    to_json(&Written { kind: R::KIND, version: R::VERSION, body: record })
}

/// The id that a record has or will have.
///
/// # Errors
/// As [`to_json`].
pub fn record_id<R: Record>(record: &R) -> Result<ObjectId, CatalogError> {
    Ok(digest(&encode(record)?))
}

/// Reads a record back from its bytes, of today's version or an older one.
///
/// # Errors
/// [`CatalogError::WrongRecord`] where the bytes are of another kind or form, or of a version that cannot be read.
pub fn decode<R: Record>(id: ObjectId, bytes: &[u8]) -> Result<R, CatalogError> {
    let expected = || format!("{} (format {})", R::KIND, R::VERSION);
    let wrong_record = |found: String| CatalogError::WrongRecord { id, expected: expected(), found };
    let head: Head = serde_json::from_slice(bytes).map_err(|error| wrong_record(format!("no record: {error}")))?;
    let of_format = |reason: &str| wrong_record(format!("{} (format {}){reason}", head.kind, head.version));
    if head.kind != R::KIND {
        return Err(of_format(""));
    }
    if !(1..=R::VERSION).contains(&head.version) {
        return Err(of_format(", which this furrow does not know: was it written by a newer one?"));
    }
    let body = if head.version == R::VERSION {
        head.body
    } else {
        R::upgrade(head.version, head.body).map_err(|reason| of_format(&format!(": {reason}")))?
    };
    serde_json::from_value(body).map_err(|error| wrong_record(format!("a damaged one: {error}")))
}

/// Reads a record from the store.
///
/// # Errors
/// As [`Objects::read`] and [`decode`].
pub fn read<R: Record>(objects: &Objects, id: ObjectId) -> Result<R, CatalogError> {
    decode(id, &objects.read(id)?)
}
