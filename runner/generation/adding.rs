//! Generators of other programs enter the store: a `translator.json` becomes a generator for each direction.

use super::translator::{PluginKind, Translator};
use crate::RunError;
use furrow_catalog::Catalog;
use furrow_catalog::records::{GeneratorRecord, TrainingDomain};
use furrow_model::ObjectId;
use serde_json::json;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Enters the generators that a `translator.json` describes, one for each direction.
///
/// # Errors
/// [`RunError::Generator`] saying what is wrong with the file or its weights.
pub fn add(catalog: &Catalog, path: &Path) -> Result<Vec<(ObjectId, GeneratorRecord)>, RunError> {
    let shown = path.display().to_string();
    let wrong = |reason: String| RunError::generator(&shown, reason);
    let bytes = std::fs::read(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let mut translator: Translator = serde_json::from_slice(&bytes)
        .map_err(|error| wrong(format!("{error}; expected {{schema, name, kind: onnx|command, directions: [{{from, to}}], z_range, z_semantics: \"displacement_from_input\", …}}")))?;
    translator.check().map_err(wrong)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    translator.folder = folder.canonicalize().map_err(|error| wrong(format!("its folder cannot be found: {error}")))?;
    // Named once they are known to be files, so that their absence is noticed later.
    let arguments: Vec<PathBuf> = translator.arguments().map(Path::to_owned).collect();
    translator.files.extend(arguments.into_iter().filter(|_| translator.kind == PluginKind::Command));
    translator.own_files().map_err(wrong)?;
    let weights = match &translator.weights {
        Some(file) => {
            let file = folder.join(file);
            std::fs::read(&file)
                .map_err(|error| wrong(format!("its weights {} cannot be read: {error}", file.display())))?
        }
        None => bytes,
    };
    if let (Some(expected), Some(_)) = (&translator.weights_sha256, &translator.weights) {
        let found: String = Sha256::digest(&weights).iter().map(|byte| format!("{byte:02x}")).collect();
        if found != expected.to_lowercase() {
            return Err(wrong(format!(
                "its weights have the SHA-256 {found}, expected {expected}: is it the right file, and whole?"
            )));
        }
    }
    let weights = catalog.objects().write(&weights)?;
    let parameters = json!(translator);
    let domain =
        |slot, images: &[ObjectId]| Some(TrainingDomain { slot, traversals: Vec::new(), images: images.to_vec() });
    let mut added = Vec::new();
    for direction in &translator.directions {
        let training = &translator.training;
        let record = GeneratorRecord {
            name: format!("{}:{}>{}", translator.name, direction.from, direction.to),
            kind: translator.kind.name().to_owned(),
            algorithm: "plugin/1".to_owned(),
            source: domain(direction.from, &training.images_a),
            target: domain(direction.to, &training.images_b),
            parameters: parameters.clone(),
            weights,
        };
        added.push((catalog.enter_generator(&record)?, record));
    }
    Ok(added)
}
