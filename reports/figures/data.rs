//! The numbers behind a figure, as a table: exactly what is drawn, for those who want to draw it themselves.

use super::arrange::{Column, Row};
use crate::input::CellInput;
use polars::prelude::{Column as FrameColumn, DataFrame, NamedFrom, PolarsResult, Series};

/// One value of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Whole(i64),
    Real(f64),
    Missing,
}

/// A table: columns that are named once, and rows in the order drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Data {
    columns: Vec<&'static str>,
    rows: Vec<Vec<Value>>,
}

impl Data {
    pub fn new(columns: &[&'static str]) -> Self {
        Self { columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Adds a row, a value for each column.
    pub fn push(&mut self, row: Vec<Value>) {
        debug_assert_eq!(row.len(), self.columns.len());
        self.rows.push(row);
    }

    /// Adds a row about a cell: its key, its live traversal, its experience, then the rest.
    pub fn push_cell(&mut self, (row, column, cell): (&Row<'_>, &Column, &CellInput), rest: Vec<Value>) {
        let mut values: Vec<Value> =
            vec![cell.outcome.key.short().into(), row.label.clone().into(), column.label.clone().into()];
        values.extend(rest);
        self.push(values);
    }

    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// As CSV (RFC 4180, lines ended by `\n`); reals with all their digits, an empty field where there is no value.
    pub fn csv(&self) -> String {
        let mut csv = self.columns.join(",");
        csv.push('\n');
        for row in &self.rows {
            let fields: Vec<String> = row.iter().map(Value::field).collect();
            csv.push_str(&fields.join(","));
            csv.push('\n');
        }
        csv
    }

    /// As a frame: a column of text where any of its values is one, else of reals where any is real, else of whole
    /// numbers.
    pub fn frame(&self) -> PolarsResult<DataFrame> {
        let column = |(i, name): (usize, &&'static str)| -> FrameColumn {
            let values = || self.rows.iter().map(|row| &row[i]);
            if values().any(|value| matches!(value, Value::Text(_))) {
                Series::new((*name).into(), values().map(Value::text).collect::<Vec<_>>()).into()
            } else if values().any(|value| matches!(value, Value::Real(_))) {
                Series::new((*name).into(), values().map(Value::real).collect::<Vec<_>>()).into()
            } else {
                Series::new((*name).into(), values().map(Value::whole).collect::<Vec<_>>()).into()
            }
        };
        DataFrame::new(self.rows.len(), self.columns.iter().enumerate().map(column).collect())
    }
}

impl Value {
    fn field(&self) -> String {
        match self {
            Value::Text(text) if text.contains([',', '"', '\n', '\r']) => format!("\"{}\"", text.replace('"', "\"\"")),
            Value::Text(text) => text.clone(),
            Value::Whole(value) => value.to_string(),
            Value::Real(value) => value.to_string(),
            Value::Missing => String::new(),
        }
    }

    fn text(&self) -> Option<String> {
        (*self != Value::Missing).then(|| match self {
            Value::Text(text) => text.clone(),
            other => other.field(),
        })
    }

    fn real(&self) -> Option<f64> {
        match self {
            Value::Real(value) => Some(*value),
            Value::Whole(value) => Some(*value as f64),
            _ => None,
        }
    }

    fn whole(&self) -> Option<i64> {
        if let Value::Whole(value) = self { Some(*value) } else { None }
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Value::Text(text)
    }
}

impl From<u32> for Value {
    fn from(value: u32) -> Self {
        Value::Whole(value.into())
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Value::Real(value)
    }
}

impl<T: Into<Value>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Value::Missing, Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_quoted_where_they_must_be_and_numbers_keep_their_digits() {
        let mut data = Data::new(&["name", "n", "x"]);
        data.push(vec!["a,\"b\"".into(), 3_u32.into(), 0.1.into()]);
        data.push(vec!["c".into(), Value::Missing, None::<f64>.into()]);
        assert_eq!(data.csv(), "name,n,x\n\"a,\"\"b\"\"\",3,0.1\nc,,\n");
        let frame = data.frame().unwrap();
        assert_eq!(frame.shape(), (2, 3));
        assert_eq!(frame.column("n").unwrap().i64().unwrap().get(0), Some(3));
        assert_eq!(frame.column("x").unwrap().f64().unwrap().get(1), None);
    }
}
