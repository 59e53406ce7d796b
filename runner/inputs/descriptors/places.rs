//! What VPR-methods-evaluation saves of a run (`--save_descriptors`): `database_descriptors.npy` and
//! `queries_descriptors.npy`, a row for each image in the order of the sorted paths. The images are those of the
//! folders `database` and `queries` that `furrow export images` wrote; the list in each tells their ids.

use super::{LIST, file, ids_of, npy, wrong};
use crate::RunError;
use furrow_catalog::digest;
use furrow_model::ObjectId;
use std::path::Path;

/// The arrays, and the folders of the images that they describe.
const ARRAYS: [(&str, &str); 2] = [("database_descriptors.npy", "database"), ("queries_descriptors.npy", "queries")];

/// The digest of all that was read, the images' ids, the dimensions, and the numbers row by row.
pub(super) fn read(folder: &Path) -> Result<(ObjectId, Vec<ObjectId>, usize, Vec<f32>), RunError> {
    let (mut digests, mut ids, mut dimensions, mut numbers) = (Vec::new(), Vec::new(), None, Vec::new());
    for (array, images) in ARRAYS {
        let (path, list) = (folder.join(array), folder.join(images).join(LIST));
        let (bytes, text) = (file(&path)?, file(&list)?);
        let (columns, values) = npy::read(&bytes).map_err(|reason| wrong(&path, &reason))?;
        let own = ids_of(&list, &text)?;
        if own.len().checked_mul(columns) != Some(values.len()) {
            let rows = values.len() / columns.max(1);
            let reason =
                format!("{rows} descriptors, but {} images in {}: are they of one run?", own.len(), list.display());
            return Err(wrong(&path, &reason));
        }
        if *dimensions.get_or_insert(columns) != columns {
            let reason = format!("{columns} numbers an image, those of the database have others: expected one model's");
            return Err(wrong(&path, &reason));
        }
        digests.push([digest(&bytes).0, digest(&text).0].concat());
        ids.extend(own);
        numbers.extend(values);
    }
    Ok((digest(&digests.concat()), ids, dimensions.unwrap_or_default(), numbers))
}

#[cfg(test)]
mod tests {
    use super::super::DescriptorFile;
    use super::super::npy::tests::file as npy_file;
    use super::*;
    use std::fs;

    #[test]
    fn both_arrays_are_known_by_the_lists_of_their_folders() {
        let folder = tempfile::tempdir().unwrap();
        let id = |name: &str| digest(name.as_bytes());
        let list = |names: &[&str]| names.iter().map(|name| format!("{}  {name}.jpg\n", id(name))).collect::<String>();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        };
        write("database/images.txt", list(&["a", "b"]).as_bytes());
        write("queries/images.txt", list(&["c"]).as_bytes());
        write("database_descriptors.npy", &npy_file("<f4", "(2, 2)", &[1.0, 2.0, 3.0, 4.0]));
        write("queries_descriptors.npy", &npy_file("<f4", "(1, 2)", &[5.0, 6.0]));
        let found = DescriptorFile::read(folder.path()).unwrap();
        let rows = found.of_images(&[id("c"), id("a"), id("b")], "a test").unwrap();
        assert_eq!(rows.rows().collect::<Vec<_>>(), [[5.0, 6.0], [1.0, 2.0], [3.0, 4.0]]);
        let refused = |word: &str| {
            let error = DescriptorFile::read(folder.path()).unwrap_err().to_string();
            assert!(error.contains(word), "expected '{word}' in: {error}");
        };
        write("queries_descriptors.npy", &npy_file("<f4", "(1, 3)", &[5.0, 6.0, 7.0]));
        refused("one model's");
        write("queries_descriptors.npy", &npy_file("<f4", "(2, 2)", &[5.0, 6.0, 7.0, 8.0]));
        refused("2 descriptors, but 1 images");
        fs::remove_file(folder.path().join("queries/images.txt")).unwrap();
        refused("images.txt");
    }
}
