//! Names for derivations: the digest of all that determines a result.

use furrow_catalog::{CatalogError, digest_of};
use furrow_model::ObjectId;
use serde::Serialize;

/// Versions of the algorithms behind each stage. A change of results needs a new version, so that nothing stale is
/// found.
pub(crate) const CODEBOOK: &str = "codebook/2";
pub(crate) const WORDS: &str = "words/2";
pub(crate) const MATCHES: &str = "matches/1";
pub(crate) const SEQUENCES: &str = "seqslam/1";
pub(crate) const EXTERNAL: &str = "external/1";
pub(crate) const VERIFICATION: &str = "verification/1";
pub(crate) const TWO_VIEW: &str = "two-view/1";
pub(crate) const THRESHOLD: &str = "threshold/1";
pub(crate) const PAINTED: &str = "painted/1";
pub(crate) const GENERATED: &str = "generated/1";
pub(crate) const GATE: &str = "gate/2";
pub(crate) const TRAINED: &str = "trained/1";
/// The definitions of the numbers of a cell.
pub(crate) const EVALUATION: &str = "evaluate/4";
pub(crate) const CELL: &str = "cell/2";

/// The versions of everything between a cell's inputs and its outcome.
pub(crate) fn versions() -> (u32, [&'static str; 5]) {
    (furrow_ingest::odometry::ALGORITHM_VERSION, [WORDS, MATCHES, VERIFICATION, THRESHOLD, EVALUATION])
}

/// The key of a derivation by `algorithm` from `inputs`.
pub(crate) fn key_of(algorithm: &str, inputs: &impl Serialize) -> Result<ObjectId, CatalogError> {
    digest_of(&(algorithm, inputs))
}
