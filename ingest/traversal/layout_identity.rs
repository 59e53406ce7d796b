//! What is understood of a dataset, as a part of its recording's identity.

use crate::folder::PairFiles;
use crate::import::{Layout, LayoutImages};
use crate::traversal::error::IngestError;
use furrow_catalog::digest;
use furrow_catalog::records::{ViewsRecord, encode};
use furrow_model::ObjectId;
use std::path::Path;

/// What a profile made of a dataset's files: equal files understood otherwise are another recording.
pub(crate) fn digest_layout(layout: &Layout) -> Result<ObjectId, IngestError> {
    let views = ViewsRecord {
        calibration: layout.cameras.clone(),
        left_bayer: layout.left.bayer,
        right_bayer: layout.right.bayer,
    };
    let tables = [layout.left.table.is_some(), layout.right.table.is_some()];
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let images: Vec<(i64, i64, String, String)> = match &layout.images {
        LayoutImages::Pairs(pairs, _) => {
            let moment = |pair: &PairFiles| (pair.stamp_ns, pair.right_stamp_ns, name(&pair.left), name(&pair.right));
            pairs.iter().map(moment).collect()
        }
        LayoutImages::Single(images) => {
            images.iter().map(|image| (image.stamp_ns, image.stamp_ns, name(&image.path), String::new())).collect()
        }
    };
    Ok(digest(&[encode(&views)?, serde_json::json!(["layout/1", tables, images]).to_string().into_bytes()].concat()))
}
