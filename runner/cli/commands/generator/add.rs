use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::views::generators::{generator_json, generator_line};
use furrow_runner::generation::adding;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Add a generator of another program: an ONNX model or a command, described by a translator.json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow generator add translator.json     where the file holds, for example:\n    \
{\"schema\": 1, \"name\": \"cut\", \"kind\": \"command\", \"command\": [\"python3\", \"translate.py\"],\n     \
\"directions\": [{\"from\": \"10:00\", \"to\": \"16:00\"}], \"z_range\": [0, 1],\n     \
\"z_semantics\": \"displacement_from_input\"}\n\n\
A command reads lines {\"id\",\"in\",\"out\",\"z\",\"dir\",\"seed\"} on stdin and answers each with a line\n\
{\"id\",\"ok\",\"ms\",\"err\"} on stdout. An ONNX model has the inputs image f32[1,3,H,W] and z f32[1,1] and the output\n\
image f32[1,3,H,W].\n\n\
Images that a command painted are kept under the digest of its arguments that are files, its weights, and the files\n\
that \"files\": [\"module.py\"] names: a changed script paints again.")]
pub struct AddGenerator {
    /// The file.
    #[arg(value_name = "translator.json")]
    file: PathBuf,
}

impl AddGenerator {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let added = adding::add(&context.catalog()?, &self.file)?;
        if context.json {
            let all: Vec<Value> = added.iter().map(|(id, record)| generator_json(*id, record)).collect();
            print_json(&json!({ "generators": all }))?;
        } else {
            print(&added.iter().map(|(id, record)| generator_line(*id, record)).collect::<String>())?;
        }
        Ok(Ending::Done)
    }
}
