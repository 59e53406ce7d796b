//! Reports that a user keeps in the store's folder.

use super::error::BrowseError;
use super::reply::Reply;
use super::store::Store;
use crate::wording::{self, bytes};
use furrow_catalog::{Catalog, CatalogError};
use serde::Serialize;
use std::fs;
use std::path::PathBuf;

/// Files that are listed.
const MOST: usize = 50;

/// A file of the folder.
#[derive(Serialize)]
pub(super) struct KeptReport {
    /// How it is called in an address.
    key: String,
    name: String,
    size: String,
}

/// The HTML files of the folder by name; links and folders are not among them.
fn files(catalog: &Catalog) -> Vec<(String, PathBuf, u64)> {
    let Ok(entries) = fs::read_dir(catalog.reports_folder()) else { return Vec::new() };
    let file = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().ok().filter(|name| name.ends_with(".html"))?;
        let about = fs::symlink_metadata(entry.path()).ok().filter(fs::Metadata::is_file)?;
        Some((name, entry.path(), about.len()))
    };
    let mut files: Vec<_> = entries.flatten().filter_map(file).collect();
    files.sort();
    files
}

pub(super) fn list(catalog: &Catalog) -> Vec<KeptReport> {
    let view = |(name, _, size): (String, PathBuf, u64)| KeptReport {
        key: furrow_catalog::digest(name.as_bytes()).short(),
        name: wording::shown(&name),
        size: bytes(size),
    };
    files(catalog).into_iter().take(MOST).map(view).collect()
}

/// A kept report, as it is.
pub(super) fn page(store: &Store, key: String) -> Result<Reply, BrowseError> {
    let found = files(&store.catalog()?);
    let found = found.into_iter().find(|(name, ..)| furrow_catalog::digest(name.as_bytes()).short() == key);
    let (_, path, _) = found.ok_or_else(|| BrowseError::not_here("kept report", &key))?;
    Ok(Reply::report(fs::read(&path).map_err(CatalogError::file("read", &path))?))
}
