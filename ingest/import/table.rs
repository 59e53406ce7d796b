//! Rows of numbers in texts: between commas, semicolons or blanks, with comments and a header of columns' names.

use super::error::ImportError;
use furrow_model::tum::words;
use std::fs;
use std::path::{Path, PathBuf};

/// The largest text that is read whole: an hour of 1 kHz in a hundred columns.
const MOST_BYTES: u64 = 1 << 30;

/// A text of rows.
#[derive(Debug)]
pub(super) struct Table {
    path: PathBuf,
    header: Vec<String>,
    text: String,
}

/// A column: where it stands, and whether its sign is turned.
#[derive(Debug, Clone, Copy)]
pub(super) struct Column {
    place: usize,
    sign: f64,
}

/// A row with its number.
pub(super) struct Row<'a> {
    path: &'a Path,
    /// From 1.
    pub(super) line: usize,
    words: Vec<&'a str>,
}

impl Table {
    /// Reads a file.
    pub(super) fn read(path: &Path) -> Result<Self, ImportError> {
        let text = read_text(path)?;
        let names = text.lines().take_while(|line| is_no_row(line)).filter(|line| !line.trim().is_empty()).last();
        let header = names.map_or_else(Vec::new, |line| words(line.trim_start_matches(['#', '%', ' '])));
        let header = header.into_iter().map(plain_name).collect();
        Ok(Self { path: path.to_owned(), header, text })
    }

    /// The column that a profile names.
    pub(super) fn column(&self, named: &str) -> Result<Column, ImportError> {
        let (sign, name) = named.strip_prefix('-').map_or((1.0, named), |name| (-1.0, name));
        let place = match name.parse::<usize>() {
            Ok(number) => number.checked_sub(1),
            Err(_) => self.header.iter().position(|column| *column == plain_name(name)),
        };
        place.map(|place| Column { place, sign }).ok_or_else(|| {
            let header = if self.header.is_empty() { "no header".to_owned() } else { self.header.join(", ") };
            ImportError::file(&self.path, format!("expected a column '{name}' as the profile says, found {header}"))
        })
    }

    /// Its rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let lines = self.text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let lines = lines.skip_while(|(_, line)| is_no_row(line));
        let lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with(['#', '%']));
        lines.map(|(line, text)| Row { path: &self.path, line, words: words(text.trim()) })
    }
}

impl<'a> Row<'a> {
    /// What stands in a column.
    pub(super) fn word(&self, column: Column) -> Result<&'a str, ImportError> {
        let found = || format!("{} columns", self.words.len());
        self.words
            .get(column.place)
            .copied()
            .ok_or_else(|| self.wrong(&format!("column {}", column.place + 1), found()))
    }

    /// The finite number in a column.
    pub(super) fn number(&self, column: Column) -> Result<f64, ImportError> {
        let word = self.word(column)?;
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let wrong = || self.wrong(&format!("a number in column {}", column.place + 1), format!("'{}'", cut(word)));
        Ok(column.sign * number.ok_or_else(wrong)?)
    }

    /// The numbers in columns.
    pub(super) fn numbers<const COUNT: usize>(&self, columns: &[Column; COUNT]) -> Result<[f64; COUNT], ImportError> {
        let mut numbers = [0.0; COUNT];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(*column)?;
        }
        Ok(numbers)
    }

    /// The error of a row that does not fit.
    pub(super) fn wrong(&self, expected: &str, found: String) -> ImportError {
        ImportError::Line { path: self.path.to_owned(), line: self.line, expected: expected.to_owned(), found }
    }
}

/// The columns of several names.
pub(super) fn columns<const COUNT: usize>(
    table: &Table,
    named: &[String; COUNT],
) -> Result<[Column; COUNT], ImportError> {
    let mut columns = [Column { place: 0, sign: 1.0 }; COUNT];
    for (column, name) in columns.iter_mut().zip(named) {
        *column = table.column(name)?;
    }
    Ok(columns)
}

/// Reads a text, without the mark that Windows writes at the start.
pub(super) fn read_text(path: &Path) -> Result<String, ImportError> {
    let bytes = fs::metadata(path).map_err(ImportError::unreadable(path))?.len();
    if bytes > MOST_BYTES {
        return Err(ImportError::file(path, format!("it has {bytes} bytes, expected a text of at most {MOST_BYTES}")));
    }
    let text = fs::read_to_string(path).map_err(ImportError::unreadable(path))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The beginning of a text, for errors.
pub(super) fn cut(text: &str) -> String {
    text.chars().take(60).collect()
}

/// Whether a line before the first row is none: blank, a comment, or names of columns.
fn is_no_row(line: &str) -> bool {
    let line = line.trim();
    let begins = line.chars().next();
    begins.is_none_or(|first| !(first.is_ascii_digit() || matches!(first, '-' | '+' | '.')))
}

/// A column's name without its unit in brackets.
fn plain_name(name: &str) -> String {
    name.split(['[', '(']).next().unwrap_or_default().trim().to_lowercase()
}
