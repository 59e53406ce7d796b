//! Generators of other programs, described by a `translator.json`: an ONNX model, or a command that is spoken to over
//! JSON lines.

use crate::RunError;
use furrow_catalog::records::GeneratorRecord;
use furrow_model::{ObjectId, TimeSlot};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The schema that this program reads.
const SCHEMA: u32 = 1;
const TIMEOUT_S: f64 = 60.0;

/// What a `translator.json` says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Translator {
    /// The version of this format: 1.
    pub schema: u32,
    /// What users call it.
    pub name: String,
    /// `onnx` or `command`.
    pub kind: PluginKind,
    /// The ways it goes; each becomes a generator of its own, `NAME:FROM>TO`.
    pub directions: Vec<Direction>,
    /// The domainnesses it paints, the least and the greatest.
    pub z_range: [f64; 2],
    /// What z means: displacement from the input is all that is understood.
    pub z_semantics: Semantics,
    /// The size of image it takes.
    #[serde(default)]
    pub size: Size,
    /// The range of its values.
    #[serde(default)]
    pub range: Range,
    /// The order of its channels.
    #[serde(default)]
    pub channels: Channels,
    /// Whether equal inputs give equal outputs without a seed.
    #[serde(default)]
    pub deterministic: bool,
    /// The weights' file, beside this one; a command may keep its own.
    #[serde(default)]
    pub weights: Option<PathBuf>,
    /// The SHA-256 of that file in hexadecimal digits.
    #[serde(default)]
    pub weights_sha256: Option<String>,
    /// What it was trained on.
    #[serde(default)]
    pub training: PluginTraining,
    /// The program and its arguments; it is run in the folder of this file.
    #[serde(default)]
    pub command: Vec<String>,
    /// Further files that determine what a command paints: modules that its script imports, its own weights. Arguments
    /// that are files need not be named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<PathBuf>,
    /// How long one image may take, in seconds.
    #[serde(default = "timeout")]
    pub timeout_s: f64,
    /// The folder of this file, filled in when it is added.
    #[serde(default)]
    pub folder: PathBuf,
}

fn timeout() -> f64 {
    TIMEOUT_S
}

/// What runs a plug-in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PluginKind {
    /// ONNX Runtime.
    Onnx,
    /// A program of its own.
    Command,
}

impl PluginKind {
    /// Every kind.
    pub const ALL: [Self; 2] = [Self::Onnx, Self::Command];

    /// Its name in `translator.json` and in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Onnx => "onnx",
            Self::Command => "command",
        }
    }
}

/// One way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Direction {
    /// The slot it moves images from.
    pub from: TimeSlot,
    /// The slot it moves them towards.
    pub to: TimeSlot,
}

/// What z means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Semantics {
    /// 0 is the input, 1 the target.
    DisplacementFromInput,
}

/// The size of image that a model takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// Columns; not looked at where the mode is `native`.
    #[serde(default)]
    pub w: usize,
    /// Rows.
    #[serde(default)]
    pub h: usize,
    /// How an image becomes one of that size.
    #[serde(default)]
    pub mode: SizeMode,
}

/// How an image becomes one of the model's size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SizeMode {
    /// It stays as it is.
    #[default]
    Native,
    /// It is scaled to the size, and back.
    Squash,
    /// Its last row and column go on until it has the size, and are cut off again.
    Pad,
}

/// The range of a model's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Range {
    /// Black is -1, white 1.
    #[default]
    #[serde(rename = "-1..1")]
    Signed,
    /// Black is 0, white 1.
    #[serde(rename = "0..1")]
    Unit,
}

/// The order of a model's channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Channels {
    /// Red first.
    #[default]
    Rgb,
    /// Blue first.
    Bgr,
}

/// What a plug-in was trained on, so that it is not judged on it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PluginTraining {
    /// Ids of stored images of the first domain.
    pub images_a: Vec<ObjectId>,
    /// Ids of stored images of the second.
    pub images_b: Vec<ObjectId>,
    /// The digest of the training's configuration.
    pub config_hash: Option<String>,
}

impl Translator {
    /// The digest of a command's own files as they are now: what its arguments, its weights and `files` name in its
    /// folder. Painted images are remembered with it, so that a changed script never serves what the old one painted.
    /// Programs that are found by PATH, such as an interpreter, are not among them. `None` of a model, whose weights
    /// lie in the store.
    ///
    /// # Errors
    /// What file cannot be read.
    pub(crate) fn own_files(&self) -> Result<Option<ObjectId>, String> {
        if self.kind != PluginKind::Command {
            return Ok(None);
        }
        let named: BTreeSet<&Path> =
            self.arguments().chain(self.files.iter().chain(&self.weights).map(PathBuf::as_path)).collect();
        let digest_of = |path: &&Path| {
            let path = self.folder.join(path);
            let bytes = std::fs::read(&path).map_err(|error| {
                format!(
                    "its file {} cannot be read: {error}; put it back, or add the generator again without it",
                    path.display()
                )
            })?;
            Ok(furrow_catalog::digest(&bytes))
        };
        let digests = named.iter().map(digest_of).collect::<Result<Vec<_>, String>>()?;
        Ok((!digests.is_empty()).then(|| furrow_catalog::digest(json!(digests).to_string().as_bytes())))
    }

    /// The arguments of a command that are files in its folder.
    pub(super) fn arguments(&self) -> impl Iterator<Item = &Path> {
        self.command.iter().map(Path::new).filter(|path| self.folder.join(path).is_file())
    }

    /// The translator of a plug-in's record; `None` of a generator that is built in.
    ///
    /// # Errors
    /// [`RunError::Generator`] where the record is damaged.
    pub(crate) fn of(record: &GeneratorRecord) -> Result<Option<Self>, RunError> {
        if !PluginKind::ALL.iter().any(|kind| kind.name() == record.kind) {
            return Ok(None);
        }
        let read = serde_json::from_value(record.parameters.clone());
        read.map(Some).map_err(|error| RunError::generator(&record.name, error))
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let [least, most] = self.z_range;
        if self.schema != SCHEMA {
            return Err(format!("schema {}: this furrow reads {SCHEMA}", self.schema));
        }
        if self.name.is_empty() || self.directions.is_empty() {
            return Err("it needs a name and at least one direction".to_owned());
        }
        if !(least <= most && (-4.0..=4.0).contains(&least) && (-4.0..=4.0).contains(&most)) {
            return Err(format!("z_range [{least}, {most}]: expected two numbers in rising order, as in [0, 1]"));
        }
        if !(self.timeout_s > 0.0 && self.timeout_s <= 86_400.0) {
            return Err(format!("timeout_s {}: expected seconds above 0, at most a day", self.timeout_s));
        }
        if self.size.mode != SizeMode::Native && (self.size.w == 0 || self.size.h == 0) {
            return Err("size: modes other than native need w and h above 0".to_owned());
        }
        match self.kind {
            PluginKind::Onnx if self.weights.is_none() => {
                Err("kind onnx needs weights = the model's file, beside this one".to_owned())
            }
            PluginKind::Command if self.command.is_empty() => {
                Err("kind command needs command = [\"PROGRAM\", \"ARGUMENT\", …]".to_owned())
            }
            _ => Ok(()),
        }
    }
}
