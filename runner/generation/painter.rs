//! A generator ready to paint, whatever it is.

use super::command::CommandPainter;
use super::onnx::OnnxPainter;
use super::registry::wrong;
use super::translator::Translator;
use crate::RunError;
use furrow_catalog::Catalog;
use furrow_catalog::records::GeneratorRecord;
use furrow_generator::{DOMAINNESS, Generator, Seed, Workspace};
use furrow_model::{ColourImage, ObjectId};
use serde::Serialize;

/// All that determines a generated image beside the image: with the image's digest, the key under which it is remembered.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Brush {
    algorithm: String,
    weights: ObjectId,
    direction: String,
}

/// Paints images.
pub struct Painter {
    name: String,
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
        let of = |error: &dyn std::fmt::Display| wrong(&record.name, error);
        let direction = match (&record.source, &record.target) {
            (Some(source), Some(target)) => format!("{}>{}", source.slot, target.slot),
            _ => String::new(),
        };
        let (tool, z_range) = match record.kind.as_str() {
            "command" | "onnx" => {
                let translator: Translator =
                    serde_json::from_value(record.parameters.clone()).map_err(|error| of(&error))?;
                let weights = catalog.objects().read(record.weights)?;
                let z_range = translator.z_range;
                let tool = match record.kind.as_str() {
                    "command" => Tool::Command(Box::new(CommandPainter::new(
                        &translator,
                        &direction,
                        catalog.unfinished("painting"),
                    ))),
                    _ => Tool::Onnx(Box::new(OnnxPainter::load(&translator, &weights)?)),
                };
                (tool, z_range)
            }
            _ => {
                // Models that need no training are stored when they are first used: their name says all.
                let generator = match Generator::named(&record.name) {
                    Some(generator) => generator.map_err(|error| of(&error))?,
                    None => {
                        serde_json::from_slice(&catalog.objects().read(record.weights)?).map_err(|error| of(&error))?
                    }
                };
                (Tool::Builtin(Box::new(generator)), DOMAINNESS)
            }
        };
        let brush = Brush { algorithm: record.algorithm.clone(), weights: record.weights, direction };
        Ok(Self { name: record.name.clone(), brush, tool, z_range })
    }

    /// What determines its images.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// `image` moved by `z`; the result has the same size.
    ///
    /// # Errors
    /// [`RunError::Generator`] for a z that it does not paint, and where another program fails.
    pub fn paint(
        &self,
        image: &ColourImage,
        z: f64,
        seed: Seed,
        workspace: &mut Workspace,
    ) -> Result<ColourImage, RunError> {
        let of = |error: &dyn std::fmt::Display| wrong(&self.name, error);
        if !(self.z_range[0]..=self.z_range[1]).contains(&z) {
            return Err(of(&format!("it paints z from {} to {}, not {z}", self.z_range[0], self.z_range[1])));
        }
        let painted = match &self.tool {
            Tool::Builtin(generator) => generator.apply(image, z, seed, workspace).map_err(|error| of(&error))?,
            Tool::Command(command) => command.paint(image, z, seed)?,
            Tool::Onnx(model) => model.paint(image, z)?,
        };
        if (painted.width, painted.height) != (image.width, image.height) {
            let (w, h) = (painted.width, painted.height);
            return Err(of(&format!(
                "it made an image of {w} x {h} from one of {} x {}: the sizes must agree",
                image.width, image.height
            )));
        }
        Ok(painted)
    }
}
