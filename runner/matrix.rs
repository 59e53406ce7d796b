//! The matrix file: what a user declares. Unknown keys and wrong values are errors with their line.

mod axes;
mod check;
mod contrast;
mod localiser;
mod rules;
mod selection;
mod settings;

pub use axes::PassEntry;
pub(crate) use check::place_of;
pub use contrast::{ContrastSpec, Side};
pub use localiser::{LocaliserSpec, Method};
pub use rules::{Facts, Rule, wanted};
pub use selection::{Part, Selection};
pub use settings::{Setting, ThresholdEntry, Trainer};

use crate::RunError;
use furrow_localiser::hub::Policy;
use furrow_localiser::seqslam::SeqSlamParams;
use furrow_model::{Censored, Domainness, KeyframePolicy, TimeSlot};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;

/// A declared experiment: live passes x experiences, with one codebook.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matrix {
    /// Its name, shown on every page.
    pub name: String,
    /// The site whose outings it uses.
    pub site: String,
    /// The route of live passes and experiences; needed where the site has several.
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

/// The codebook to train.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodebookSpec {
    /// Words in the vocabulary; given here or on the axis `words`. A sequential trainer finds out.
    #[serde(default)]
    pub words: u32,
    /// How they are found.
    #[serde(default)]
    pub trainer: Trainer,
    /// Sequential: descriptors farther than this (Euclidean) from every word become a word.
    #[serde(default = "usual_radius")]
    pub radius: f64,
    /// The route of the vocabulary passes.
    pub route: String,
    /// At most so many images, evenly spread over the passes.
    #[serde(default = "codebook_images")]
    pub images: usize,
}

fn codebook_images() -> usize {
    1000
}

/// Usual for SURF.
fn usual_radius() -> f64 {
    0.45
}

/// SURF's parameters.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FeatureSpec {
    /// Smallest determinant of the Hessian.
    pub hessian: f64,
    /// Leave orientation upright: the camera of a ground robot is level.
    pub upright: bool,
}

impl Default for FeatureSpec {
    fn default() -> Self {
        Self { hessian: 400.0, upright: true }
    }
}

/// Verification by inliers.
#[derive(Debug, Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct VerificationSpec {
    /// Inliers to reach. Left out, it is calibrated on wrong places of the vocabulary route (SPEC 7).
    pub threshold: Option<u32>,
}

/// The axes: every live entry meets every experience entry, in every setting of the others.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axes {
    /// Evaluation passes.
    pub live: Vec<PassEntry>,
    /// What they localise against.
    #[serde(deserialize_with = "axes::experiences")]
    pub experience: Vec<Spanned<ExperienceEntry>>,
    /// Words of the codebook.
    pub words: Option<Vec<u32>>,
    /// Most images that the codebook is trained on.
    pub images: Option<Vec<usize>>,
    /// How experiences are sub-sampled.
    pub keyframes: Option<Vec<KeyframePolicy>>,
    /// Inliers to reach.
    pub threshold: Option<Vec<ThresholdEntry>>,
    /// Place recognisers.
    pub method: Option<Vec<Method>>,
    /// Policies of collectives that name none.
    pub policy: Option<Vec<Policy>>,
    /// Seeds: repeats of everything that is drawn at random.
    pub seed: Option<Vec<u64>>,
}

/// An entry of the experience axis.
#[derive(Debug, Clone, PartialEq)]
pub enum ExperienceEntry {
    /// Recorded.
    Recorded(PassEntry),
    /// Generated from a parent.
    Generated(GeneratedEntry),
}

/// Experiences generated from a recorded parent.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneratedEntry {
    /// The parent's slot.
    pub parent: TimeSlot,
    /// The generator's name.
    pub generator: String,
    /// How far to move the images, one experience each.
    pub domainness: Vec<Domainness>,
}

impl GeneratedEntry {
    fn check(&self) -> Result<(), String> {
        let [least, most] = furrow_generator::DOMAINNESS;
        if self.domainness.is_empty() {
            return Err("domainness is empty: name at least one, as in domainness = [0.33, 0.66, 1.0]".to_owned());
        }
        match self.domainness.iter().find(|z| !(least..=most).contains(&z.0)) {
            Some(z) => Err(format!(
                "domainness {}: expected numbers from {least} to {most}; 0 is the parent, 1 the target",
                z.0
            )),
            None => Ok(()),
        }
    }
}

/// A set of experiences behind one control hub.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collective {
    /// Its name, the label of its cells.
    pub name: String,
    /// Which entries of the experience axis: `recorded`, `generated`, `SLOT generated by GENERATOR`, slots separated by spaces, or several
    /// of these joined by `and`.
    pub of: Spanned<String>,
    /// How it chooses among its members: `"all"`, `{ slot = 2 }`, `{ similar = 2 }`, `{ agree = 2 }` or `"oracle"`.
    #[serde(default = "every_member")]
    pub policy: Spanned<Policy>,
    /// Whether the same collective with placebos in place of its generated members stands beside it.
    #[serde(default)]
    pub placebo: bool,
    /// Whether the same with the recorded parents in place of its generated members stands beside it.
    #[serde(default)]
    pub parents: bool,
    /// Whether its first two members, its first three and so on stand beside it: how many frames any of them localises.
    #[serde(default)]
    pub union: bool,
}

fn every_member() -> Spanned<Policy> {
    Spanned::new(0..0, Policy::All)
}

/// How cells are evaluated.
#[derive(Debug, Clone, Copy, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct EvaluationSpec {
    /// Lost stretches that the route's ends cut off: `"keep"` or `"drop"`.
    pub censored: Censored,
}

/// What to draw.
#[derive(Debug, Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct ReportSpec {
    /// Figures; all of them where left out.
    pub figures: Vec<Figure>,
}

/// A figure of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Figure {
    /// Good localisations by slot.
    Counts,
    /// Lost-distance curves.
    LostDistance,
    /// Where along the route.
    PointsOnRoute,
    /// Live and matched frames side by side.
    Tiles,
}

impl Figure {
    /// The name in the matrix file.
    pub fn name(self) -> &'static str {
        match self {
            Figure::Counts => "counts",
            Figure::LostDistance => "lost-distance",
            Figure::PointsOnRoute => "points-on-route",
            Figure::Tiles => "tiles",
        }
    }
}

impl Matrix {
    /// Reads a matrix.
    ///
    /// # Errors
    /// [`RunError::Matrix`] naming file, line and what is wrong.
    pub fn parse(path: &Path, text: &str) -> Result<Self, RunError> {
        let mut matrix: Matrix = toml::from_str(text).map_err(|error| RunError::Matrix {
            path: path.to_owned(),
            reason: check::with_hint(error.to_string().trim_end()),
        })?;
        matrix.check(path, text)?;
        if let (Some(file), Some(folder)) = (&mut matrix.localiser.descriptors, path.parent()) {
            *file = folder.join(&*file);
        }
        Ok(matrix)
    }

    /// SeqSLAM as the matrix asks for it: sequences of images as far apart as keyframes.
    pub fn seqslam(&self) -> SeqSlamParams {
        let LocaliserSpec { sequence, shift, .. } = self.localiser;
        SeqSlamParams { images: sequence, shift, ..SeqSlamParams::at_spacing(self.keyframes.distance_m) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_localiser::external::Metric;

    const DESIGN_EXAMPLE: &str = r#"
name = "old-zoo-afternoon"
site = "old-zoo"
codebook = { words = 6000, route = "vocabulary" }
keyframes = { distance_m = 2.0, yaw_rad = 0.2536 }
[axes]
live = ["08:00"]
experience = ["10:00", "12:00", "14:00", "16:00",
              { parent = "10:00", generator = "otf:10:00>16:00", domainness = [0.33, 0.66, 1.0] }]
[[collective]]
name = "generated"; of = "10:00 generated"; placebo = true
[report]
figures = ["counts", "lost-distance", "points-on-route", "tiles"]
"#;

    fn parse(text: &str) -> Result<Matrix, String> {
        Matrix::parse(Path::new("m.toml"), text).map_err(|error| error.to_string())
    }

    fn example() -> String {
        // TOML ends a key with its line; DESIGN separates three by semicolons for brevity.
        DESIGN_EXAMPLE.replace("; ", "\n")
    }

    #[test]
    fn the_example_of_the_design_is_read() {
        let matrix = parse(&example()).unwrap();
        assert_eq!(matrix.axes.experience.len(), 5);
        assert!(
            matches!(matrix.axes.experience[4].get_ref(), ExperienceEntry::Generated(g) if g.domainness.len() == 3)
        );
        assert_eq!(matrix.report.figures.len(), 4);
        let of = Selection::parse(matrix.collective[0].of.get_ref());
        let generated = Part::Generated { parent: Some("10:00".parse().unwrap()), by: None };
        assert_eq!(of.map(|selection| selection.parts), Ok(vec![generated]));
    }

    #[test]
    fn descriptors_lie_beside_the_matrix() {
        let text = example().replace(
            "[axes]",
            "localiser = { method = \"external\", descriptors = \"a.npy\", metric = \"l2\" }\n[axes]",
        );
        let localiser = Matrix::parse(Path::new("some/where/m.toml"), &text).unwrap().localiser;
        assert_eq!((localiser.method, localiser.metric), (Method::External, Metric::L2));
        assert_eq!(localiser.descriptors.unwrap(), Path::new("some/where/a.npy"));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let check = |from: &str, to: &str, expected: &[&str]| {
            let error = parse(&example().replace(from, to)).unwrap_err();
            for word in expected {
                assert!(error.contains(word), "expected '{word}' in: {error}");
            }
        };
        check("keyframes =", "keyframs =", &["line 5", "keyframs"]);
        check("live = [\"08:00\"]", "live = []", &["line 7", "'live' is empty"]);
        check("live = [\"08:00\"]", "live = [\"8am\"]", &["line 7", "8am", "HH:MM"]);
        check("\"12:00\",", "\"noon\",", &["line 8", "noon", "HH:MM"]);
        check("10:00 generated", "something", &["line 12", "something", "recorded"]);
        check("words = 6000", "words = -6", &["line 4"]);
        check("\"tiles\"", "\"tils\"", &["tils", "tiles"]);
        check("parent =", "parrent =", &["parrent"]);
        check("placebo = true", "policy = { agree = 0 }", &["line 13", "at least 1"]);
        check("placebo = true", "policy = { agre = 2 }", &["line 13", "agre", "similar"]);
        check("[axes]", "evaluation = { censored = \"cut\" }\n[axes]", &["line 6", "keep", "drop"]);
        let contrast = |of: &str| format!("[[contrast]]\nof = \"{of}\"\nover = \"parent\"\n[report]");
        check("[report]", &contrast("parent"), &["line 15", "into over"]);
        check("[report]", &contrast("each thing"), &["line 15", "thing", "recorded"]);
        check("[report]", &contrast("generated").replace("over", "ofer"), &["line 16", "ofer"]);
        let reserved = example().replace("name = \"generated\"", "name = \"parent\"");
        let error = parse(&reserved.replace("[report]", &contrast("each generated"))).unwrap_err();
        assert!(error.contains("line 12") && error.contains("call it otherwise"), "{error}");
        check("0.66, 1.0", "0.66, 2.5", &["line 9", "2.5", "-0.5 to 2"]);
        check("[0.33, 0.66, 1.0]", "[]", &["line 9", "domainness"]);
        let localiser = |text: &str| format!("localiser = {{ {text} }}\n[axes]");
        check("[axes]", &localiser("method = \"fabmap\""), &["line 6", "fabmap", "seqslam", "external"]);
        check("[axes]", &localiser("method = \"external\""), &["line 6", "descriptors", "NPY"]);
        check("[axes]", &localiser("descriptors = \"a.npy\""), &["line 6", "external", "fabmap2"]);
        check("[axes]", &localiser("motion = { leave = 2.0 }"), &["line 6", "chances"]);
        check("[axes]", &localiser("method = \"seqslam\", motion = {}"), &["line 6", "fabmap2"]);
        check("[axes]", &localiser("candidates = 0"), &["line 6", "candidates"]);
        check("[axes]", &localiser("method = \"seqslam\", shift = 0.7"), &["line 6", "shift of 0.7", "0 to 0.5"]);
    }

    #[test]
    fn axes_and_rules_are_checked_with_their_place() {
        let check = |from: &str, to: &str, expected: &[&str]| {
            let error = parse(&example().replace(from, to)).unwrap_err();
            for word in expected {
                assert!(error.contains(word), "expected '{word}' in: {error}");
            }
        };
        check("keyframes =", "keyframs =", &["line 5, column 1", "did you mean 'keyframes'?"]);
        check("[axes]", "[axes]\n  words = []", &["line 7, column 3", "'words' is empty"]);
        check("[axes]", "[axes]\nthreshold = [-1]", &["line 7, column", "-1", "\"calibrated\""]);
        check("[axes]", "[axes]\nmethod = [\"seqslm\"]", &["line 7", "did you mean 'seqslam'?"]);
        check("words = 6000, ", "", &["line 4, column 1", "at least 2 words"]);
        check("words = 6000", "trainer = \"sequential\", words = 6000", &["line 4", "leave words out"]);
        check("words = 6000", "trainer = \"sequential\", radius = 0.0", &["line 4", "radius"]);
        check("[axes]", "[[exclude]]\nexperiense = \"10:00\"\n[axes]", &["line ", "did you mean 'experience'?"]);
        check("[axes]", "[[include]]\nlive = []\n[axes]", &["'live' of a rule is empty"]);
        check("\"12:00\",", "{ slot = \"12:00\", pass = 0 },", &["line 8", "counted from 1"]);
        check("\"12:00\",", "{ slot = \"12:00\", date = \"2026-02-30\" },", &["line 8", "2026-02-30", "YYYY-MM-DD"]);
        check("\"12:00\",", "{ slt = \"12:00\" },", &["line 8", "slt"]);
    }

    #[test]
    fn settings_are_every_combination_in_order() {
        let axes =
            "[axes]\nwords = [300, 600, 300]\nimages = [50]\nmethod = [\"fabmap2\", \"seqslam\"]\nseed = [1, 2]\n";
        let text = example()
            .replace("[axes]\n", axes)
            .replace("placebo = true", "")
            .replace("keyframes =", "localiser = { motion = {} }\nkeyframes =");
        let settings = parse(&text).unwrap().settings();
        let told: Vec<(&str, u32, usize, Method, u64)> = (settings.iter())
            .map(|Setting { label, matrix }| {
                (label.as_str(), matrix.codebook.words, matrix.codebook.images, matrix.localiser.method, matrix.seed)
            })
            .collect();
        assert_eq!(told.len(), 8);
        assert_eq!(told[0], ("300 words, fabmap2, seed 1", 300, 50, Method::Fabmap2, 1));
        assert_eq!(told[3], ("300 words, seqslam, seed 2", 300, 50, Method::Seqslam, 2));
        assert_eq!(told[7].0, "600 words, seqslam, seed 2");
        // A motion model belongs to FAB-MAP and is left aside elsewhere.
        assert!(settings[0].matrix.localiser.motion.is_some() && settings[2].matrix.localiser.motion.is_none());
        assert_eq!(parse(&example()).unwrap().settings().len(), 1);
        assert_eq!(parse(&example()).unwrap().settings()[0].label, "");
    }

    #[test]
    fn several_generators_of_an_entry_are_several_entries() {
        let text = example().replace("generator = \"otf:10:00>16:00\"", "generator = [\"a\", \"b\"]");
        let matrix = parse(&text).unwrap();
        let generators: Vec<&str> = (matrix.axes.experience.iter())
            .filter_map(|entry| match entry.get_ref() {
                ExperienceEntry::Generated(generated) => Some(generated.generator.as_str()),
                ExperienceEntry::Recorded(_) => None,
            })
            .collect();
        assert_eq!(generators, ["a", "b"]);
    }
}
