//! Files of descriptors that another program computed, one for each image, by the image's id. They are read and
//! checked; comparing them belongs to `stages/matching`.

mod npy;
mod places;

use crate::RunError;
use furrow_catalog::{digest, tables};
use furrow_localiser::external::ImageDescriptors;
use furrow_model::ObjectId;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The list of images, an id and a name a line, in a folder of images that furrow wrote for other programs.
pub(crate) const LIST: &str = "images.txt";

/// The descriptors of a file.
#[derive(Debug)]
pub(crate) struct DescriptorFile {
    path: PathBuf,
    /// Digest of the file, and of the list of images beside it where there is one.
    pub digest: ObjectId,
    dimensions: usize,
    numbers: Vec<f32>,
    /// Each image's row.
    rows: BTreeMap<ObjectId, usize>,
}

/// What a file must be, for errors.
const EXPECTED: &str = "expected Parquet with a column 'image' (ids) and a column of float32 or float64 per dimension, or NPY of images x dimensions \
                        (float32) beside a .txt with one image id per line";

impl DescriptorFile {
    /// Reads a file: `.parquet`, or `.npy` with the ids in a `.txt` of the same name. A folder stands for the arrays in
    /// it that a program saved for the images of folders beside them.
    ///
    /// # Errors
    /// [`RunError::Descriptors`] naming the file, what was expected and what was found.
    pub fn read(path: &Path) -> Result<Self, RunError> {
        if path.is_dir() {
            let (digest, ids, dimensions, numbers) = places::read(path)?;
            return Self::of(path, digest, ids, dimensions, numbers);
        }
        let bytes = file(path)?;
        let kind = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let (digest, ids, dimensions, numbers) = match kind.to_ascii_lowercase().as_str() {
            "parquet" => {
                let named = digest(&bytes);
                let (ids, dimensions, numbers) = from_parquet(path, bytes)?;
                (named, ids, dimensions, numbers)
            }
            "npy" => {
                let list = path.with_extension("txt");
                let text = file(&list)?;
                let named = digest(&[digest(&bytes).0, digest(&text).0].concat());
                let (dimensions, numbers) = npy::read(&bytes).map_err(|reason| wrong(path, &reason))?;
                (named, ids_of(&list, &text)?, dimensions, numbers)
            }
            _ => return Err(wrong(path, EXPECTED)),
        };
        Self::of(path, digest, ids, dimensions, numbers)
    }

    fn of(
        path: &Path,
        digest: ObjectId,
        ids: Vec<ObjectId>,
        dimensions: usize,
        numbers: Vec<f32>,
    ) -> Result<Self, RunError> {
        if dimensions == 0 || numbers.is_empty() {
            return Err(wrong(path, &format!("no numbers: {EXPECTED}")));
        }
        if ids.len().checked_mul(dimensions) != Some(numbers.len()) {
            let found = numbers.len() / dimensions;
            return Err(wrong(
                path,
                &format!("{found} descriptors and {} image ids: expected one id for each", ids.len()),
            ));
        }
        let mut rows: BTreeMap<ObjectId, usize> = BTreeMap::new();
        for (row, id) in ids.into_iter().enumerate() {
            if let Some(before) = rows.insert(id, row) {
                let reason =
                    format!("rows {before} and {row} are both of image {id}: expected one descriptor an image");
                return Err(wrong(path, &reason));
            }
        }
        Ok(Self { path: path.to_owned(), digest, dimensions, numbers, rows })
    }

    /// The descriptors of `images`, in their order.
    ///
    /// # Errors
    /// [`RunError::Descriptors`] where some image has none.
    pub fn of_images(&self, images: &[ObjectId], whose: &str) -> Result<ImageDescriptors, RunError> {
        if let Some(reason) = self.missing(images, whose) {
            return Err(self.wrong(&reason));
        }
        let row = |image: &ObjectId| &self.numbers[self.rows[image] * self.dimensions..][..self.dimensions];
        ImageDescriptors::new(self.dimensions, images.iter().flat_map(row).copied().collect())
            .map_err(|error| self.wrong(&error.to_string()))
    }

    /// What is missing for `images`, and what to do; `None` where each has a descriptor.
    pub fn missing(&self, images: &[ObjectId], whose: &str) -> Option<String> {
        let missing: Vec<&ObjectId> = images.iter().filter(|image| !self.rows.contains_key(image)).collect();
        missing.first().map(|first| {
            format!(
                "no descriptor for {} of {} images of {whose}, first {first}: compute them, under the ids that `b3sum` prints for the images \
                 as stored",
                missing.len(),
                images.len()
            )
        })
    }

    /// An error about this file.
    pub fn wrong(&self, reason: &str) -> RunError {
        wrong(&self.path, reason)
    }
}

fn wrong(path: &Path, reason: &str) -> RunError {
    RunError::Descriptors { path: path.to_owned(), reason: reason.to_owned() }
}

fn file(path: &Path) -> Result<Vec<u8>, RunError> {
    std::fs::read(path).map_err(|error| wrong(path, &format!("cannot be read: {error}; {EXPECTED}")))
}

fn ids_of(list: &Path, text: &[u8]) -> Result<Vec<ObjectId>, RunError> {
    let text = String::from_utf8_lossy(text);
    let id = |(line, id): (usize, &str)| {
        // b3sum's own lines, `ID  FILE`, will do.
        let id = id.split_whitespace().next().unwrap_or_default();
        id.parse().map_err(|_| wrong(list, &format!("line {}: '{id}' is no image id of 64 hex digits", line + 1)))
    };
    text.lines().enumerate().map(id).collect()
}

fn from_parquet(path: &Path, bytes: Vec<u8>) -> Result<(Vec<ObjectId>, usize, Vec<f32>), RunError> {
    let because = |error: furrow_catalog::CatalogError| wrong(path, &format!("{error}; {EXPECTED}"));
    let table = tables::from_parquet("descriptors", bytes).map_err(because)?;
    let ids = tables::object_ids(&table, "image").map_err(because)?;
    let names: Vec<String> = table.get_column_names().iter().map(|name| name.to_string()).collect();
    let columns = names
        .iter()
        .filter(|name| *name != "image")
        .map(|name| match tables::f32s(&table, name) {
            Ok(column) => Ok(column),
            Err(_) => tables::f64s(&table, name).map(|column| column.into_iter().map(|number| number as f32).collect()),
        })
        .collect::<Result<Vec<Vec<f32>>, _>>()
        .map_err(because)?;
    let numbers = (0..table.height()).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
    Ok((ids, columns.len(), numbers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::table::{column, encode};

    fn id(name: &str) -> ObjectId {
        digest(name.as_bytes())
    }

    #[test]
    fn both_kinds_of_file_give_the_same_rows() {
        let folder = tempfile::tempdir().unwrap();
        let ids = ["a", "b", "c"].map(|name| id(name).to_string());
        let columns = vec![
            column("image", ids.clone()),
            column("d0", [1.0_f32, 2.0, 3.0]),
            column("d1", [0.5_f64, 0.25, -0.125]),
        ];
        let parquet = folder.path().join("all.parquet");
        std::fs::write(&parquet, encode("descriptors", 3, columns).unwrap()).unwrap();
        let npy = folder.path().join("all.npy");
        std::fs::write(&npy, npy::tests::file("<f4", "(3, 2)", &[1.0, 0.5, 2.0, 0.25, 3.0, -0.125])).unwrap();
        std::fs::write(npy.with_extension("txt"), ids.map(|id| format!("{id}  some.png\n")).concat()).unwrap();
        for path in [&parquet, &npy] {
            let file = DescriptorFile::read(path).unwrap();
            let rows = file.of_images(&[id("c"), id("a")], "a test").unwrap();
            assert_eq!(rows.rows().collect::<Vec<_>>(), [[3.0, -0.125], [1.0, 0.5]], "{}", path.display());
            let error = file.of_images(&[id("a"), id("d"), id("e")], "a test").unwrap_err().to_string();
            for word in ["2 of 3 images of a test", &id("d").to_string(), &path.display().to_string()] {
                assert!(error.contains(word), "expected '{word}' in: {error}");
            }
        }
        std::fs::write(npy.with_extension("txt"), format!("{}\nnothing\n", id("a"))).unwrap();
        let error = DescriptorFile::read(&npy).unwrap_err().to_string();
        assert!(error.contains("line 2") && error.contains("all.txt"), "{error}");
        std::fs::write(npy.with_extension("txt"), format!("{}\n", id("a"))).unwrap();
        let error = DescriptorFile::read(&npy).unwrap_err().to_string();
        assert!(error.contains("3 descriptors and 1 image ids"), "{error}");
        let twice = [id("a"), id("b"), id("a")].map(|id| format!("{id}\n")).concat();
        std::fs::write(npy.with_extension("txt"), twice).unwrap();
        let error = DescriptorFile::read(&npy).unwrap_err().to_string();
        assert!(error.contains("rows 0 and 2") && error.contains(&id("a").to_string()), "{error}");
        // Two ids times 2^63 dimensions are no numbers at all, where 64 bits wrap.
        std::fs::write(&npy, npy::tests::file("<f4", "(0, 9223372036854775808)", &[])).unwrap();
        std::fs::write(npy.with_extension("txt"), format!("{}\n{}\n", id("a"), id("b"))).unwrap();
        let error = DescriptorFile::read(&npy).unwrap_err().to_string();
        assert!(error.contains("no numbers"), "{error}");
        let error = DescriptorFile::read(&folder.path().join("none.npy")).unwrap_err().to_string();
        assert!(error.contains("cannot be read") && error.contains("NPY"), "{error}");
    }
}
