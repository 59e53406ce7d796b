//! What every command is given.

use crate::ending::Failure;
use furrow_catalog::Catalog;
use std::path::PathBuf;

/// The options that every command has.
#[derive(Debug)]
pub struct Context {
    /// The store's folder, if the user named one.
    pub store: Option<PathBuf>,
    /// Whether stdout is for a program.
    pub json: bool,
}

impl Context {
    /// Opens the store: the one named, else the nearest upwards.
    pub fn catalog(&self) -> Result<Catalog, Failure> {
        Ok(Catalog::open(&self.root()?)?)
    }

    /// Finds its folder.
    pub fn root(&self) -> Result<PathBuf, Failure> {
        if let Some(root) = &self.store {
            return Ok(root.clone());
        }
        let here = std::env::current_dir().map_err(|error| Failure::new(format!("no current folder: {error}")))?;
        Ok(Catalog::find(&here)?)
    }
}
