//! What can go wrong between a matrix and its outcomes.

use std::path::PathBuf;

/// An error of the runner.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The matrix file is wrong.
    #[error("{}: {reason}", path.display())]
    Matrix {
        /// The file.
        path: PathBuf,
        /// Line, what is wrong, what was expected.
        reason: String,
    },
    /// The store failed.
    #[error(transparent)]
    Catalog(#[from] furrow_catalog::CatalogError),
    /// The store does not hold what a matrix asks of its site.
    #[error("{0}")]
    Site(String),
    /// A stored image cannot be used.
    #[error("image {image}: {reason}")]
    Image {
        /// The object.
        image: furrow_model::ObjectId,
        /// Why.
        reason: String,
    },
    /// A stored image gives no view.
    #[error(transparent)]
    View(#[from] furrow_catalog::ViewError),
    /// A ground truth cannot be used.
    #[error("ground truth: {0}")]
    GroundTruth(String),
    /// The codebook cannot be trained.
    #[error("codebook: {0}")]
    Codebook(String),
    /// A file of image descriptors cannot be used.
    #[error("descriptors {}: {reason}", path.display())]
    Descriptors {
        /// The file.
        path: PathBuf,
        /// What was expected, what was found, what to do.
        reason: String,
    },
    /// A generator cannot be trained, found or used.
    #[error("generator '{name}': {reason}")]
    Generator {
        /// Its name, as far as it is known.
        name: String,
        /// What was expected, what was found, what to do.
        reason: String,
    },
    /// A recording cannot be written.
    #[error("recording for players: {0}")]
    Recording(String),
    /// The cluster refuses, or a task on it failed.
    #[error("{0}")]
    Slurm(String),
    /// The work of one live frame does not fit into memory.
    #[error(
        "verification cannot stay within {} MB: the {nodes} places that one live frame is verified against, on {threads} threads, need {} MB: \
         give --memory more, or fewer threads, experiences or candidates", bytes.div_ceil(1_000_000), least.div_ceil(1_000_000)
    )]
    Memory {
        /// What there is.
        bytes: u64,
        /// What is needed.
        least: u64,
        /// Places.
        nodes: usize,
        /// Threads.
        threads: usize,
    },
    /// A plan cannot be localised in live.
    #[error("{0}")]
    Live(String),
    /// A recording cannot be ingested again.
    #[error("{0}")]
    Reingestion(String),
    /// Two cells cannot be set against each other.
    #[error("{0}")]
    Contrast(String),
    /// A place recogniser cannot be made, or cannot answer.
    #[error("{0}")]
    Recogniser(String),
    /// The plan cannot be made at all.
    #[error("{0}")]
    Plan(String),
}

impl RunError {
    /// An error about the generator of this name.
    pub(crate) fn generator(name: &str, reason: impl ToString) -> Self {
        Self::Generator { name: name.to_owned(), reason: reason.to_string() }
    }
}
