//! Columns of a table as vectors, checked for their type and for gaps.

use crate::CatalogError;
use furrow_model::ObjectId;
use polars::prelude::DataFrame;

/// A column of numbers without gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing, of another type, or has gaps.
pub fn i64s(table: &DataFrame, name: &str) -> Result<Vec<i64>, CatalogError> {
    let column = table.column(name).and_then(|column| column.i64()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of numbers without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn f64s(table: &DataFrame, name: &str) -> Result<Vec<f64>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f64()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of counts without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn u32s(table: &DataFrame, name: &str) -> Result<Vec<u32>, CatalogError> {
    let column = table.column(name).and_then(|column| column.u32()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of single-precision numbers without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn f32s(table: &DataFrame, name: &str) -> Result<Vec<f32>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f32()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of counts that may have gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing or of another type.
pub fn optional_u32s(table: &DataFrame, name: &str) -> Result<Vec<Option<u32>>, CatalogError> {
    let column = table.column(name).and_then(|column| column.u32()).map_err(CatalogError::table(name))?;
    Ok(column.iter().collect())
}

/// A column of numbers that may have gaps.
///
/// # Errors
/// [`CatalogError::Table`] where the column is missing or of another type.
pub fn optional_f64s(table: &DataFrame, name: &str) -> Result<Vec<Option<f64>>, CatalogError> {
    let column = table.column(name).and_then(|column| column.f64()).map_err(CatalogError::table(name))?;
    Ok(column.iter().collect())
}

/// A column of truths without gaps.
///
/// # Errors
/// As [`i64s`].
pub fn bools(table: &DataFrame, name: &str) -> Result<Vec<bool>, CatalogError> {
    let column = table.column(name).and_then(|column| column.bool()).map_err(CatalogError::table(name))?;
    column.iter().collect::<Option<_>>().ok_or_else(|| gap(name))
}

/// A column of object ids without gaps.
///
/// # Errors
/// As [`i64s`], also where a text is no id.
pub fn object_ids(table: &DataFrame, name: &str) -> Result<Vec<ObjectId>, CatalogError> {
    let column = table.column(name).and_then(|column| column.str()).map_err(CatalogError::table(name))?;
    column.iter().map(|text| text.and_then(|text| text.parse().ok())).collect::<Option<_>>().ok_or_else(|| gap(name))
}

fn gap(name: &str) -> CatalogError {
    CatalogError::Table { what: name.to_owned(), reason: "expected a value in every row, found a gap".to_owned() }
}
