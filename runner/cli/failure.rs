//! Failures and their exit codes.

use std::fmt;

/// A command that failed.
#[derive(Debug)]
pub struct Failure {
    text: String,
    code: u8,
}

impl Failure {
    /// Something went wrong: exit code 1.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: 1 }
    }

    /// What was asked makes no sense: exit code 2.
    pub fn usage(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: 2 }
    }

    /// Stdout was closed or full.
    pub fn stdout(error: std::io::Error) -> Self {
        Self::new(format!("cannot write to stdout: {error}"))
    }

    /// The process' exit code.
    pub fn code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

macro_rules! fails {
    ($($error:ty),* $(,)?) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::new(error.to_string())
            }
        })*
    };
}

fails!(
    furrow_catalog::CatalogError,
    furrow_catalog::ViewError,
    furrow_ingest::outing::IngestError,
    furrow_reports::ReportError,
    furrow_reports::browse::BrowseError,
    furrow_runner::RunError,
);
