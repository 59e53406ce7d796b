//! What a report is made from.

use furrow_model::{Contrast, Outcome, RunId};
use polars::prelude::DataFrame;

/// Everything one page shows.
#[derive(Debug, Clone)]
pub struct ReportInput {
    /// The run.
    pub run: RunId,
    /// The matrix' name; shown as it is, whatever it holds.
    pub matrix_name: String,
    /// The matrix as written: TOML.
    pub matrix_source: String,
    /// The site.
    pub site: String,
    /// The command that makes this page again.
    pub command: String,
    /// The version of furrow that made it.
    pub furrow_version: String,
    /// The finished cells, in the matrix' order.
    pub cells: Vec<CellInput>,
    /// The cells that failed or were blocked.
    pub missing: Vec<MissingCell>,
    /// Which contenders beat which.
    pub contrasts: ContrastInput,
    /// The live traversals that have a ground truth.
    pub tracks: Vec<TrackInput>,
    /// The codebooks of the run's cells.
    pub trained: Vec<Training>,
    /// The generators that the run names.
    pub generators: Vec<GeneratorInput>,
}

/// A traversal's odometry beside its ground truth, aligned with it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackInput {
    /// The traversal, as a person names it.
    pub name: String,
    /// What the truth comes from.
    pub source: String,
    /// True positions, east and north in metres.
    pub truth_m: Vec<[f64; 2]>,
    /// Odometry's positions of the same frames, in the same frame of reference.
    pub odometry_m: Vec<[f64; 2]>,
    /// Root mean square of their distance, metres.
    pub rms_m: f64,
    /// The length by odometry, metres.
    pub length_m: f64,
}

/// What a codebook was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Training {
    /// The codebook's id, shortened.
    pub codebook: String,
    /// How its vocabulary was clustered.
    pub trainer: String,
    /// Vocabulary images.
    pub images: u32,
    /// Words.
    pub words: u32,
    /// Wall-clock time of the clustering, where the store knows it.
    pub seconds: Option<f64>,
}

/// What is known of a generator.
#[derive(Debug, Clone, Default)]
pub struct GeneratorInput {
    /// Its name.
    pub name: String,
    /// What the quality gate measured, an entry per experience.
    pub curves: Vec<GateCurve>,
    /// Images as it changes them, JPEG, and what the rows of that sheet are.
    pub sheet: Option<(Vec<u8>, String)>,
}

/// What the quality gate measured on one experience, in rising domainness.
#[derive(Debug, Clone)]
pub struct GateCurve {
    /// The experience, as a person names it.
    pub parent: String,
    /// The measures.
    pub points: Vec<GatePoint>,
}

/// Matches between images and their generated versions; means per image.
#[derive(Debug, Clone, Copy)]
pub struct GatePoint {
    /// The domainness.
    pub z: f64,
    /// Matches with a descriptor distance below half that of the second nearest.
    pub good_matches: f64,
    /// Descriptors that could have been matched.
    pub matchable: f64,
}

/// The contrasts that the matrix asks for.
#[derive(Debug, Clone, Default)]
pub struct ContrastInput {
    /// In the matrix' order.
    pub found: Vec<Contrast>,
    /// What must stand beside them: claims without a placebo, contrasts that could not be made.
    pub notes: Vec<String>,
}

/// One finished cell.
#[derive(Debug, Clone)]
pub struct CellInput {
    /// The numbers.
    pub outcome: Outcome,
    /// The events behind them, columns as in [`furrow_model::outcome::event`].
    pub events: DataFrame,
    /// Frames to show in the gallery, few; [`choose_tiles`](crate::choose_tiles) picks them.
    pub tiles: Vec<Tile>,
}

/// A cell without an outcome.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingCell {
    /// Which: live slot, experience, and what else tells it apart.
    pub label: String,
    /// Why, in words.
    pub reason: String,
}

/// A live frame beside the place it was matched to.
#[derive(Debug, Clone)]
pub struct Tile {
    /// What is written below.
    pub caption: TileCaption,
    /// The live left frame, a JPEG file's bytes.
    pub live_jpeg: Vec<u8>,
    /// The candidate's left frame; `None` for "new place".
    pub match_jpeg: Option<Vec<u8>>,
    /// Whether it is one of those that compare the same live frame against every experience.
    pub compared: bool,
    /// Inliers: a point of the live frame and its partner in the candidate's; x and y as fractions (0 to 1) of width
    /// and height.
    pub inlier_lines: Vec<([f32; 2], [f32; 2])>,
}

/// The facts of a tile, from a row of the events table.
#[derive(Debug, Clone, PartialEq)]
pub struct TileCaption {
    /// The live frame's header stamp.
    pub live_stamp_ns: i64,
    /// Distance the live traversal had covered, metres.
    pub travelled_m: f64,
    /// The experience that answered, as a person names it: its slot or label.
    pub experience: String,
    /// Inliers; `None` where the candidate was not verified.
    pub inliers: Option<u32>,
    /// The threshold of inliers.
    pub threshold_inliers: u32,
    /// One of the decisions of [`furrow_model::outcome::event`].
    pub decision: String,
    /// Whether the candidate is the right place; `None` without ground truth or candidate.
    pub correct: Option<bool>,
    /// Distance along the ground to the candidate, metres, where a ground truth tells.
    pub error_m: Option<f64>,
}
