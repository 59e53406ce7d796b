//! Why there is no page.

use furrow_catalog::images::ImageError;
use furrow_catalog::{CatalogError, ViewError};
use furrow_model::ObjectId;

/// What went wrong while looking around in a store.
#[derive(Debug, thiserror::Error)]
pub enum BrowseError {
    /// The port cannot be had.
    #[error(
        "cannot listen on 127.0.0.1:{port}: {source}; choose another --port, or leave out --port to take any free one"
    )]
    Listen {
        /// The port asked for; 0 for any.
        port: u16,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The server stopped.
    #[error("serving the catalogue's pages: {0}")]
    Serve(std::io::Error),
    /// The store has nothing of this name.
    #[error("{0}")]
    NotHere(String),
    /// The store.
    #[error(transparent)]
    Catalog(#[from] CatalogError),
    /// A stored image gives no view.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A view cannot be encoded as JPEG.
    #[error("image {image}: {source}")]
    Picture {
        /// The stored image.
        image: ObjectId,
        /// Why.
        source: ImageError,
    },
    /// What computes for the pages failed.
    #[error("{0}")]
    Insight(String),
    /// A bug in a template of the crate itself.
    #[error("rendering the page: {0:#}; this is a bug in furrow: please report it")]
    Template(#[from] minijinja::Error),
}

impl BrowseError {
    /// The store has no `what` of this name, as the page says it.
    pub(super) fn not_here(what: &str, name: &str) -> Self {
        let name: String = crate::wording::shown(name).chars().take(80).collect();
        Self::NotHere(format!("This store has no {what} ‘{name}’."))
    }

    /// Whether there is simply no such thing.
    pub(super) fn is_not_here(&self) -> bool {
        matches!(self, Self::NotHere(_))
    }
}
