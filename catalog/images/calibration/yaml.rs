//! YAML as calibrations are written in it: by ROS, by OpenCV's `FileStorage`, by Kalibr.

use super::error::CalibrationFileError;
use serde::Deserialize;
use serde_norway::Value;

/// A document of a calibration file.
#[derive(Debug, Clone)]
pub struct Document {
    /// The file, and the part of it, for errors.
    pub what: String,
    /// Its keys and values.
    pub value: Value,
}

/// The documents of a text. OpenCV's own dialect, `%YAML:1.0` and `!!opencv-matrix`, is no YAML: it is taken away
/// first.
///
/// # Errors
/// Text that is no YAML.
pub fn documents(what: &str, text: &str) -> Result<Vec<Document>, CalibrationFileError> {
    let lines = text.trim_start_matches('\u{feff}').lines().filter(|line| !line.starts_with('%'));
    let plain: Vec<String> = lines.map(|line| line.replace("!!opencv-matrix", "")).collect();
    let mut documents = Vec::new();
    for document in serde_norway::Deserializer::from_str(&plain.join("\n")) {
        let value = Value::deserialize(document)
            .map_err(|source| CalibrationFileError::Yaml { what: what.to_owned(), source })?;
        if !value.is_null() {
            documents.push(Document { what: what.to_owned(), value });
        }
    }
    Ok(documents)
}

impl Document {
    /// The value under the first of `keys` that is there.
    pub fn get(&self, keys: &[&str]) -> Option<&Value> {
        keys.iter().find_map(|key| self.value.get(*key))
    }

    /// Whether there is a value under one of `keys`.
    pub fn has(&self, keys: &[&str]) -> bool {
        self.get(keys).is_some()
    }

    /// The part of it under `key`.
    pub fn part(&self, key: &str) -> Option<Document> {
        let value = self.value.get(key)?.clone();
        Some(Document { what: format!("{}, {key}", self.what), value })
    }

    /// A text under one of `keys`; empty where there is none.
    pub fn text(&self, keys: &[&str]) -> &str {
        self.get(keys).and_then(Value::as_str).unwrap_or_default().trim()
    }

    /// This document with another's keys, for what is written in two files.
    pub fn joined(mut self, other: &Document) -> Document {
        if let (Value::Mapping(keys), Value::Mapping(more)) = (&mut self.value, &other.value) {
            keys.extend(more.clone());
        }
        if self.what != other.what {
            self.what = format!("{}, {}", self.what, other.what);
        }
        self
    }

    /// The numbers under one of `keys`: a list, a list of rows, or `data` beside `rows` and `cols`; `None` where none
    /// of the keys is there.
    ///
    /// # Errors
    /// Anything but numbers, and a count that is not that of `rows` and `cols`.
    pub fn numbers(&self, keys: &[&str]) -> Result<Option<Vec<f64>>, CalibrationFileError> {
        let Some(value) = self.get(keys) else { return Ok(None) };
        let key = keys.iter().find(|key| self.value.get(**key).is_some()).copied().unwrap_or_default();
        let wrong = |expected: &str, found: String| self.wrong(key, expected, found);
        let data = value.get("data").unwrap_or(value);
        let mut numbers = Vec::new();
        if !collect(data, &mut numbers) {
            return Err(wrong("a list of numbers", shown(data)));
        }
        let side = |name: &str| value.get(name).and_then(Value::as_u64);
        if let (Some(rows), Some(cols)) = (side("rows"), side("cols"))
            && rows.checked_mul(cols) != Some(numbers.len() as u64)
        {
            let found = format!("rows {rows}, cols {cols} with {} numbers", numbers.len());
            return Err(wrong("as many numbers as rows times cols", found));
        }
        Ok(Some(numbers))
    }

    /// A matrix of `rows` x `cols` under one of `keys`; `None` where none of the keys is there.
    ///
    /// # Errors
    /// A matrix of another shape.
    pub fn matrix<const COUNT: usize>(
        &self,
        keys: &[&str],
        rows: u64,
        cols: u64,
    ) -> Result<Option<[f64; COUNT]>, CalibrationFileError> {
        let Some(numbers) = self.numbers(keys)? else { return Ok(None) };
        let count = numbers.len();
        let told = |name: &str| self.get(keys).and_then(|value| value.get(name)).and_then(Value::as_u64);
        let (told_rows, told_cols) = (told("rows").unwrap_or(rows), told("cols").unwrap_or(cols));
        let fits = (told_rows, told_cols) == (rows, cols);
        let array = <[f64; COUNT]>::try_from(numbers).ok().filter(|_| fits);
        array.map(Some).ok_or_else(|| {
            let found = format!("rows {told_rows}, cols {told_cols} with {count} numbers");
            self.wrong(keys.first().copied().unwrap_or_default(), &format!("rows {rows}, cols {cols}"), found)
        })
    }

    /// Columns and rows of an image under a key of each; `None` where neither is there, or both are 0.
    ///
    /// # Errors
    /// One without the other, or what is no number of pixels.
    pub fn size(&self, width: &[&str], height: &[&str]) -> Result<Option<[u32; 2]>, CalibrationFileError> {
        match (self.get(width), self.get(height)) {
            (None, None) => Ok(None),
            (w, h) => {
                let pixels = |value: Option<&Value>| value.and_then(whole_number);
                let found =
                    || format!("{} x {}", w.map_or("nothing".to_owned(), shown), h.map_or("nothing".to_owned(), shown));
                let size = pixels(w).zip(pixels(h)).map(|(w, h)| [w, h]);
                let size = size.ok_or_else(|| self.wrong("the image size", "whole columns and rows", found()))?;
                Ok(Some(size).filter(|size| *size != [0, 0]))
            }
        }
    }

    /// The error of a value that does not fit.
    pub fn wrong(&self, key: &str, expected: &str, found: String) -> CalibrationFileError {
        CalibrationFileError::Numbers {
            what: self.what.clone(),
            key: key.to_owned(),
            expected: expected.to_owned(),
            found,
        }
    }
}

fn whole_number(value: &Value) -> Option<u32> {
    let number = value.as_f64().filter(|number| number.fract() == 0.0 && (0.0..65_536.0).contains(number))?;
    Some(number as u32)
}

/// Appends the numbers of a list, or of a list of lists; false where something else is among them.
fn collect(value: &Value, numbers: &mut Vec<f64>) -> bool {
    match value {
        Value::Sequence(list) => list.iter().all(|item| collect(item, numbers)),
        Value::Number(number) => number.as_f64().is_some_and(|number| {
            numbers.push(number);
            true
        }),
        // `1e-3` is a number to every program but YAML's core schema.
        Value::String(text) => text.trim().parse().is_ok_and(|number| {
            numbers.push(number);
            true
        }),
        _ => false,
    }
}

/// A value for an error: its beginning.
fn shown(value: &Value) -> String {
    let text = serde_norway::to_string(value).unwrap_or_default();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if text.chars().count() > 60 { format!("{}…", text.chars().take(60).collect::<String>()) } else { text }
}
