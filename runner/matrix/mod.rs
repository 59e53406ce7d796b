//! The matrix file: what a user declares. Unknown keys and wrong values are errors with their line.
//!
//! In the order of the data:
//! - `parse`: the file's text into a [`Matrix`], `axes` and `entries` its axes, `recognition`, `collective`,
//!   `contrast`, `localiser` and `report` its tables;
//! - `check`: rules between keys, which the form alone does not enforce, with line and column;
//! - `settings`: lists on the axes into one matrix per combination;
//! - `rules`, `selection`: which cells belong to it, and which experiences a name means.

mod axes;
mod check;
mod collective;
mod contrast;
mod entries;
mod localiser;
mod parse;
mod recognition;
mod report;
mod rules;
mod selection;
mod settings;
#[cfg(test)]
mod tests;

pub use axes::Axes;
pub(crate) use check::place_of;
pub use collective::Collective;
pub use contrast::{ContrastSpec, Side};
pub use entries::{ExperienceEntry, GeneratedEntry, TraversalEntry};
pub use localiser::{Fault, LocaliserSpec, Method, OwnKey};
pub use recognition::{CodebookSpec, FeatureSpec, VerificationSpec};
pub use report::{EvaluationSpec, Figure, ReportSpec};
pub use rules::{Facts, Rule, wanted};
pub use selection::{Part, Selection};
pub use settings::{Setting, ThresholdEntry, Trainer};

use furrow_model::KeyframePolicy;
use serde::Deserialize;

/// A declared experiment: live traversals x experiences, with one codebook.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matrix {
    /// Its name, shown on every page.
    pub name: String,
    /// The site whose traversals it uses.
    pub site: String,
    /// The route of live traversals and experiences; needed where the site has several.
    pub route: Option<String>,
    /// The codebook to train or find.
    pub codebook: CodebookSpec,
    /// How experiences are sub-sampled.
    #[serde(default = "thesis_keyframes")]
    pub keyframes: KeyframePolicy,
    /// How features are found.
    #[serde(default)]
    pub features: FeatureSpec,
    /// How places are recognised.
    #[serde(default)]
    pub localiser: LocaliserSpec,
    /// How answers are verified.
    #[serde(default)]
    pub verification: VerificationSpec,
    /// How cells are evaluated.
    #[serde(default)]
    pub evaluation: EvaluationSpec,
    /// Seeds everything that is drawn at random.
    #[serde(default)]
    pub seed: u64,
    /// The axes.
    pub axes: Axes,
    /// Rules by which cells belong to the matrix; all do where there is none.
    #[serde(default)]
    pub include: Vec<Rule>,
    /// Rules by which cells do not.
    #[serde(default)]
    pub exclude: Vec<Rule>,
    /// Experiences that answer together through the control hub.
    #[serde(default)]
    pub collective: Vec<Collective>,
    /// Contenders that are set against each other.
    #[serde(default)]
    pub contrast: Vec<ContrastSpec>,
    /// What to draw.
    #[serde(default)]
    pub report: ReportSpec,
}

fn thesis_keyframes() -> KeyframePolicy {
    KeyframePolicy::THESIS
}
