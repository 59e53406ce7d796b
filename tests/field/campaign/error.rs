//! What is wrong with a campaign's file, and where.

use std::path::{Path, PathBuf};

/// What is wrong with a campaign's file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path}:{line}:{column}: found {found}, expected {expected}", path = path.display())]
pub struct CampaignError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The character of the line, from 1.
    pub column: usize,
    /// What stands there.
    pub found: String,
    /// What should.
    pub expected: String,
}

/// The text that is read, for places in it.
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    /// Line and column of a byte of the text.
    pub fn place(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(self.text);
        let line = before.rsplit('\n').next().unwrap_or_default();
        (before.matches('\n').count() + 1, line.chars().count() + 1)
    }

    /// An error at a byte of the text.
    pub fn wrong(&self, at: usize, found: impl Into<String>, expected: impl Into<String>) -> CampaignError {
        let (line, column) = self.place(at);
        CampaignError { path: self.path.to_owned(), line, column, found: found.into(), expected: expected.into() }
    }
}
