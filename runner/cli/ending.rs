//! How a command ends, and its exit code.

use furrow_ingest::traversal::IngestError;
use std::fmt;
use std::process::ExitCode;

/// How a command ended that did its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// All was done: exit code 0.
    Done,
    /// Finished, with faults found or cells that could not run: exit code 3.
    WithFaults,
}

impl Ending {
    /// [`Ending::WithFaults`] if there are any.
    pub fn with_faults_if(faulty: bool) -> Self {
        if faulty { Self::WithFaults } else { Self::Done }
    }

    /// The process' exit code.
    pub fn code(self) -> ExitCode {
        match self {
            Self::Done => ExitCode::SUCCESS,
            Self::WithFaults => ExitCode::from(3),
        }
    }
}

/// A command that failed.
#[derive(Debug)]
pub struct Failure {
    text: String,
    code: u8,
}

impl Failure {
    /// The work failed: exit code 1.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: 1 }
    }

    /// The command line is wrong: exit code 2.
    pub fn usage(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: 2 }
    }

    /// The work was done and found a fault that keeps its result out: exit code 3.
    pub fn with_faults(text: impl Into<String>) -> Self {
        Self { text: text.into(), code: 3 }
    }

    /// Stdout was closed or full.
    pub fn stdout(error: std::io::Error) -> Self {
        Self::new(format!("cannot write to stdout: {error}"))
    }

    /// The process' exit code.
    pub fn code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl From<IngestError> for Failure {
    fn from(error: IngestError) -> Self {
        match error {
            IngestError::Doubtful { .. } => Self::with_faults(error.to_string()),
            _ => Self::new(error.to_string()),
        }
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
    furrow_ingest::import::ImportError,
    furrow_reports::ReportError,
    furrow_reports::browse::BrowseError,
    furrow_runner::RunError,
);
