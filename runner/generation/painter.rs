//! A generator ready to paint, whatever it is.

use super::command::CommandPainter;
use super::onnx::OnnxPainter;
use super::relighting::{Lights, Relight};
use super::translator::{PluginKind, Translator};
use crate::RunError;
use furrow_catalog::Catalog;
use furrow_catalog::records::{GeneratorRecord, TraversalRecord};
use furrow_generator::{DOMAINNESS, Generator, Seed, Shading, Workspace};
use furrow_model::{ColourImage, Experience, ObjectId};
use serde::Serialize;

/// All that determines a generated image beside the image: with the image's digest, the key under which it is
/// remembered.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Brush {
    algorithm: String,
    weights: ObjectId,
    direction: String,
    /// Of a plug-in, how its model or program is run; a built-in model's weights say all.
    run: Option<serde_json::Value>,
    /// Of a command, the digest of its own files as they are now.
    #[serde(skip_serializing_if = "Option::is_none")]
    files: Option<ObjectId>,
}

impl Brush {
    fn of(record: &GeneratorRecord, translator: Option<&Translator>) -> Result<Self, RunError> {
        let files = translator
            .map(Translator::own_files)
            .transpose()
            .map_err(|reason| RunError::generator(&record.name, reason))?;
        let run = |t: &Translator| serde_json::json!([t.size, t.range, t.channels, t.command, t.weights_sha256]);
        let (algorithm, weights) = (record.algorithm.clone(), record.weights);
        let (direction, run) = (direction(record), translator.map(run));
        Ok(Self { algorithm, weights, direction, run, files: files.flatten() })
    }
}

/// From which slot to which, where it goes between slots.
fn direction(record: &GeneratorRecord) -> String {
    match (&record.source, &record.target) {
        (Some(source), Some(target)) => format!("{}>{}", source.slot, target.slot),
        _ => String::new(),
    }
}

/// Paints images.
pub struct Painter {
    record: GeneratorRecord,
    /// Of a generator that relights.
    relight: Option<Relight>,
    brush: Brush,
    tool: Tool,
    z_range: [f64; 2],
}

enum Tool {
    Builtin(Box<Generator>),
    Command(Box<CommandPainter>),
    Onnx(Box<OnnxPainter>),
}

impl Painter {
    /// Makes a generator ready.
    ///
    /// # Errors
    /// [`RunError::Generator`] where its model is damaged, or its program or library cannot be started.
    pub fn load(catalog: &Catalog, record: &GeneratorRecord) -> Result<Self, RunError> {
        let wrong = |error: &dyn std::fmt::Display| RunError::generator(&record.name, error);
        let (tool, z_range, brush) = match Translator::of(record)? {
            Some(translator) => {
                let weights = catalog.objects().read(record.weights)?;
                let tool = match translator.kind {
                    PluginKind::Command => {
                        let folder = catalog.unfinished_file("painting");
                        Tool::Command(Box::new(CommandPainter::new(&translator, &direction(record), folder)))
                    }
                    PluginKind::Onnx => Tool::Onnx(Box::new(OnnxPainter::load(&translator, &weights)?)),
                };
                (tool, translator.z_range, Brush::of(record, Some(&translator))?)
            }
            None => {
                // Models that need no training are stored when they are first used: their name says all.
                let generator = match Generator::named(&record.name) {
                    Some(generator) => generator.map_err(|error| wrong(&error))?,
                    None => serde_json::from_slice(&catalog.objects().read(record.weights)?)
                        .map_err(|error| wrong(&error))?,
                };
                (Tool::Builtin(Box::new(generator)), DOMAINNESS, Brush::of(record, None)?)
            }
        };
        let relight = match &tool {
            Tool::Builtin(generator) if generator.relights() => {
                let found = record.parameters.get("relight").cloned().unwrap_or_default();
                Some(serde_json::from_value(found).map_err(|error| wrong(&error))?)
            }
            _ => None,
        };
        Ok(Self { record: record.clone(), relight, brush, tool, z_range })
    }

    /// Of a command, the digest of its own files.
    pub fn files(&self) -> Option<ObjectId> {
        self.brush.files
    }

    /// What determines its images.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// What relights the images of an experience; none where this does not relight.
    ///
    /// # Errors
    /// [`RunError::Generator`] where its recording does not tell what that takes.
    pub(crate) fn lights(&self, catalog: &Catalog, of: &Experience) -> Result<Option<Lights>, RunError> {
        self.relight.map(|relight| Lights::of(catalog, &self.record, relight, of)).transpose()
    }

    /// The same for the images of a traversal.
    ///
    /// # Errors
    /// As [`Painter::lights`].
    pub(crate) fn lights_of_traversal(
        &self,
        catalog: &Catalog,
        of: &TraversalRecord,
    ) -> Result<Option<Lights>, RunError> {
        self.relight.map(|relight| Lights::of_traversal(catalog, &self.record, relight, of)).transpose()
    }

    /// `image` moved by `z`; the result has the same size. `shading` is what relights it, of a generator that does.
    ///
    /// # Errors
    /// [`RunError::Generator`] for a z that it does not paint, and where another program fails.
    pub fn paint(
        &self,
        image: &ColourImage,
        z: f64,
        seed: Seed,
        shading: Option<&Shading>,
        workspace: &mut Workspace,
    ) -> Result<ColourImage, RunError> {
        let wrong = |error: &dyn std::fmt::Display| RunError::generator(&self.record.name, error);
        if !(self.z_range[0]..=self.z_range[1]).contains(&z) {
            return Err(wrong(&format!("it paints z from {} to {}, not {z}", self.z_range[0], self.z_range[1])));
        }
        let painted = match &self.tool {
            Tool::Builtin(generator) => {
                generator.apply_lit(image, z, seed, shading, workspace).map_err(|error| wrong(&error))?
            }
            Tool::Command(command) => command.paint(image, z, seed)?,
            Tool::Onnx(model) => model.paint(image, z)?,
        };
        if (painted.width, painted.height) != (image.width, image.height) {
            let (w, h) = (painted.width, painted.height);
            return Err(wrong(&format!(
                "it made an image of {w} x {h} from one of {} x {}: the sizes must agree",
                image.width, image.height
            )));
        }
        Ok(painted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// One model in two ways of running it gives two images of one: neither may be taken for the other.
    #[test]
    fn models_run_in_another_way_are_remembered_apart() {
        let record = GeneratorRecord {
            name: "cut:10:00>16:00".to_owned(),
            kind: "onnx".to_owned(),
            algorithm: "plugin/1".to_owned(),
            source: None,
            target: None,
            parameters: json!({}),
            weights: furrow_catalog::digest(b"weights"),
        };
        let brush = |size: serde_json::Value, folder: &str| {
            let translator: Translator = serde_json::from_value(json!({
                "schema": 1, "name": "cut", "kind": "onnx", "directions": [{ "from": "10:00", "to": "16:00" }], "z_range": [0, 1],
                "z_semantics": "displacement_from_input", "size": size, "folder": folder,
            }))
            .unwrap();
            Brush::of(&record, Some(&translator)).unwrap()
        };
        let native = json!({ "mode": "native" });
        assert_ne!(brush(native.clone(), "a"), brush(json!({ "mode": "squash", "w": 320, "h": 192 }), "a"));
        assert_eq!(brush(native.clone(), "a"), brush(native, "b"), "wherever its folder lies");
    }
}
