//! Images as sets for visual place recognition have them: a folder of `@UTM_east@UTM_north@…@.jpg`, beside a list of
//! the images' ids in the order of their names, by which descriptors of other programs find their way back.

pub use super::placed::PlacesOf;

use super::placed::Places;
use crate::RunError;
use crate::inputs::descriptors::LIST;
use furrow_catalog::{Catalog, CatalogError, write_file};
use furrow_model::ObjectId;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportedPlaces {
    /// Images.
    pub images: usize,
    /// Images that were encoded anew; the others are the stored files.
    pub encoded: usize,
    /// Images that were left out, since their moment has no true position and others have.
    pub without_position: usize,
    /// What the positions come from, one for each of what was asked for.
    pub positions: Vec<String>,
}

/// Writes the images of `wanted` into the new folder `folder`; all of it or nothing.
///
/// # Errors
/// A folder that is there already; where the store cannot be read or the disk refuses.
pub fn export_places(catalog: &Catalog, wanted: &[PlacesOf], folder: &Path) -> Result<ExportedPlaces, RunError> {
    if folder.exists() {
        let said = format!("{} is there already: name a new folder, or remove it", folder.display());
        return Err(RunError::Recording(said));
    }
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(CatalogError::file("make folder", parent))?;
    let staged = tempfile::tempdir_in(parent).map_err(CatalogError::file("make a folder in", parent))?;
    let within = staged.path().join("images");
    fs::create_dir(&within).map_err(CatalogError::file("make folder", &within))?;
    let mut done = ExportedPlaces { images: 0, encoded: 0, without_position: 0, positions: Vec::new() };
    let mut list: BTreeMap<String, ObjectId> = BTreeMap::new();
    for subject in wanted {
        let places = Places::load(catalog, *subject)?;
        done.positions.push(places.source.clone());
        for (stamp_ns, image) in &places.images {
            let Some(name) = places.name(*stamp_ns) else {
                done.without_position += 1;
                continue;
            };
            let (bytes, is_encoded) = places.jpeg(catalog, *image)?;
            let name = name.format(done.images, ".jpg");
            write_file(&within.join(&name), &bytes)?;
            list.insert(name, *image);
            done.images += 1;
            done.encoded += usize::from(is_encoded);
        }
    }
    let lines: String = list.iter().map(|(name, id)| format!("{id}  {name}\n")).collect();
    write_file(&within.join(LIST), lines.as_bytes())?;
    fs::rename(&within, folder).map_err(CatalogError::file("move into place", folder))?;
    Ok(done)
}
