//! Data frames as Parquet bytes.

use crate::CatalogError;
use polars::prelude::{Column, DataFrame};
use polars_io::SerReader;
use polars_io::parquet::read::ParquetReader;
use polars_io::parquet::write::{ParquetCompression, ParquetWriter};
use std::io::Cursor;

/// A data frame as Parquet bytes; equal frames give equal bytes.
///
/// # Errors
/// [`CatalogError::Table`] naming `what`.
pub fn to_parquet(what: &str, mut table: DataFrame) -> Result<Vec<u8>, CatalogError> {
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes)
        .with_compression(ParquetCompression::Zstd(None))
        .set_parallel(false)
        .finish(&mut table)
        .map_err(CatalogError::table(what))?;
    Ok(bytes)
}

/// Parquet bytes as a data frame.
///
/// # Errors
/// [`CatalogError::Table`] naming `what`.
pub fn from_parquet(what: &str, bytes: Vec<u8>) -> Result<DataFrame, CatalogError> {
    ParquetReader::new(Cursor::new(bytes)).finish().map_err(CatalogError::table(what))
}

/// A table of `stamp_ns` and columns of numbers, all of one length.
///
/// # Errors
/// [`CatalogError::Table`].
pub fn numbers_to_parquet(
    what: &str,
    stamps_ns: &[i64],
    names: &[&str],
    values: &[Vec<f64>],
) -> Result<Vec<u8>, CatalogError> {
    let mut columns = vec![Column::new("stamp_ns".into(), stamps_ns)];
    columns.extend(names.iter().zip(values).map(|(name, values)| Column::new((*name).into(), values.as_slice())));
    to_parquet(what, DataFrame::new(stamps_ns.len(), columns).map_err(CatalogError::table(what))?)
}
