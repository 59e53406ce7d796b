//! The page's own script: `scripts/*.js`, inlined once. It only shows what is on the page, and sends nothing anywhere.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

const SOURCE: &str = concat!(
    "(() => {\n'use strict';\n",
    include_str!("scripts/base.js"),
    include_str!("scripts/tips.js"),
    include_str!("scripts/zoom.js"),
    include_str!("scripts/filter.js"),
    include_str!("scripts/frames.js"),
    "})();\n"
);

/// The script without indentation and comments.
pub(super) fn script() -> String {
    let kept = |line: &&str| !line.is_empty() && !line.starts_with("//");
    SOURCE.lines().map(str::trim_start).filter(kept).flat_map(|line| [line, "\n"]).collect()
}

/// The source of a script as the page's policy allows it, by its digest: no other script runs.
pub(super) fn source_of(script: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script)))
}
