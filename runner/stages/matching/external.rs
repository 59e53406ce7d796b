//! Descriptors of images that another program computed.

use super::table::{kept, of_ranked, remembered};
use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::descriptors::DescriptorFile;
use crate::inputs::key::{EXTERNAL, key_of};
use crate::inputs::recogniser::{Answering, Context, Recogniser, RecogniserEntry};
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::{Fault, LocaliserSpec, Method, OwnKey};
use furrow_localiser::external::{Metric, rank};
use furrow_model::ObjectId;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

const NAME: &str = "external";

pub(super) static EXTERNAL_DESCRIPTORS: RecogniserEntry = RecogniserEntry {
    method: Method {
        name: NAME,
        keys: &[OwnKey { name: "descriptors", exclusive: true }, OwnKey { name: "metric", exclusive: false }],
        check: |spec| {
            let (file, _) = settings(spec)?;
            match file {
                None if spec.method() == NAME => Err(without_file(spec)),
                _ => Ok(()),
            }
        },
    },
    open: |matrix| {
        let spec = &matrix.localiser;
        let (file, metric) = settings(spec)?;
        let file = DescriptorFile::read(&spec.folder.join(file.ok_or_else(|| without_file(spec))?))?;
        Ok(Arc::new(External { file, metric, verified: spec.candidates }))
    },
};

/// The file, relative to the matrix file, and how descriptors are compared.
fn settings(spec: &LocaliserSpec) -> Result<(Option<PathBuf>, Metric), Fault> {
    Ok((spec.get("descriptors")?, spec.get("metric")?.unwrap_or(Metric::Cosine)))
}

fn without_file(spec: &LocaliserSpec) -> Fault {
    let reason = "method \"external\" needs descriptors = \"FILE\": Parquet or NPY, a descriptor for every image";
    spec.fault("method", reason)
}

/// A file of descriptors.
struct External {
    file: DescriptorFile,
    metric: Metric,
    /// Of each answer so many can be verified.
    verified: u32,
}

impl Recogniser for External {
    fn cell_key_part(&self) -> Value {
        json!([NAME, EXTERNAL, self.file.digest, self.metric])
    }

    fn missing(&self, live: &LiveTraversal, contenders: &[&Contender]) -> Option<String> {
        let frames: Vec<ObjectId> = live.images().collect();
        let of_live = self.file.missing(&frames, &whose_live(live));
        let of_contender = |contender: &&Contender| {
            if contender.making.as_ref().is_some_and(|making| !making.made) {
                let reason = "its images are not painted yet: make it with `furrow generate`, describe its images, then run again";
                return Some(format!("{}: {reason}", contender.label));
            }
            let nodes: Vec<ObjectId> = contender.images().collect();
            self.file.missing(&nodes, &whose(contender))
        };
        let reason = of_live.or_else(|| contenders.iter().find_map(of_contender))?;
        Some(self.file.wrong(&reason).to_string())
    }

    fn look_at<'a>(&'a self, context: &'a dyn Context, live: &'a LiveTraversal) -> Result<Answering<'a>, RunError> {
        let images: Vec<ObjectId> = live.images().collect();
        let seen = self.file.of_images(&images, &whose_live(live))?;
        let (kept, metric) = (kept(self.verified), self.metric);
        Ok(Box::new(move |contender| {
            let key = key_of(EXTERNAL, &(self.file.digest, metric, live.record.frames, contender.id, kept))?;
            remembered(context.objects(), key, || {
                let images: Vec<ObjectId> = contender.images().collect();
                let places = self.file.of_images(&images, &whose(contender))?;
                rank(&seen, &places, metric, kept).map(of_ranked).map_err(|error| self.file.wrong(&error.to_string()))
            })
        }))
    }
}

fn whose_live(live: &LiveTraversal) -> String {
    format!("the live traversal at {}", live.record.slot)
}

fn whose(contender: &Contender) -> String {
    format!("the experience {}", contender.label)
}
