//! Small tables of numbers between stages.

use furrow_catalog::{CatalogError, tables};
use polars::prelude::{Column, DataFrame};

/// Columns of one length as Parquet bytes.
pub(crate) fn encode(what: &str, rows: usize, columns: Vec<Column>) -> Result<Vec<u8>, CatalogError> {
    tables::to_parquet(what, DataFrame::new(rows, columns).map_err(CatalogError::table(what))?)
}

/// A column from values.
pub(crate) fn column<'a, T: 'a, I>(name: &str, values: I) -> Column
where
    I: IntoIterator<Item = T>,
    Vec<T>: IntoColumn,
{
    values.into_iter().collect::<Vec<T>>().into_column(name)
}

/// Vectors that become columns.
pub(crate) trait IntoColumn {
    /// The column of this name.
    fn into_column(self, name: &str) -> Column;
}

macro_rules! into_column {
    ($($kind:ty),*) => {
        $(impl IntoColumn for Vec<$kind> {
            fn into_column(self, name: &str) -> Column {
                Column::new(name.into(), self)
            }
        })*
    };
}

into_column!(u32, i64, f64, f32, bool, String, Option<u32>, Option<i64>, Option<f64>, Option<bool>, Option<String>);

/// A column of texts without gaps.
pub(crate) fn strings(table: &DataFrame, name: &str) -> Result<Vec<String>, CatalogError> {
    let column = table.column(name).and_then(|column| column.str()).map_err(CatalogError::table(name))?;
    let all = column.iter().map(|text| text.map(str::to_owned)).collect::<Option<Vec<String>>>();
    all.ok_or_else(|| CatalogError::Table {
        what: name.to_owned(),
        reason: "expected a value in every row, found a gap".to_owned(),
    })
}
