//! Text columns as values of the model.

use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::str::FromStr;

/// Reads a column's text as a value of the model.
pub(super) fn parsed<T: FromStr<Err: std::fmt::Display>>(row: &SqliteRow, column: &str) -> Result<T, sqlx::Error> {
    let text: String = row.try_get(column)?;
    text.parse().map_err(|error: T::Err| sqlx::Error::ColumnDecode {
        index: column.to_owned(),
        source: error.to_string().into(),
    })
}

/// As [`parsed`], of a column that may be null.
pub(super) fn parsed_optional<T: FromStr<Err: std::fmt::Display>>(
    row: &SqliteRow,
    column: &str,
) -> Result<Option<T>, sqlx::Error> {
    let text: Option<String> = row.try_get(column)?;
    text.map(|_| parsed(row, column)).transpose()
}
