//! The matrix file: what a user declares. Unknown keys and wrong values are errors with their line.

mod contrast;
mod localiser;
mod selection;

pub use contrast::{ContrastSpec, Side};
pub use localiser::{LocaliserSpec, Method};
pub use selection::{Part, Selection};

use crate::RunError;
use furrow_localiser::hub::Policy;
use furrow_localiser::seqslam::SeqSlamParams;
use furrow_model::{Censored, Domainness, KeyframePolicy, TimeSlot};
use serde::Deserialize;
use serde::de::IntoDeserializer;
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
    /// Words in the vocabulary.
    pub words: u32,
    /// The route of the vocabulary passes.
    pub route: String,
    /// At most so many images, evenly spread over the passes.
    #[serde(default = "codebook_images")]
    pub images: usize,
}

fn codebook_images() -> usize {
    1000
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

/// The axes: every live entry meets every experience entry.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axes {
    /// Slots of evaluation passes.
    pub live: Vec<TimeSlot>,
    /// What they localise against.
    pub experience: Vec<Spanned<ExperienceEntry>>,
}

/// An entry of the experience axis.
#[derive(Debug, Clone, PartialEq)]
pub enum ExperienceEntry {
    /// Recorded at this slot.
    Recorded(TimeSlot),
    /// Every recorded slot of the site: `"recorded:*"`.
    AllRecorded,
    /// Generated from a parent.
    Generated(GeneratedEntry),
}

/// Experiences generated from a recorded parent.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
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

impl<'de> Deserialize<'de> for ExperienceEntry {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let wrong = serde::de::Error::custom::<String>;
        match toml::Value::deserialize(deserializer)? {
            toml::Value::String(text) if text == "recorded:*" => Ok(Self::AllRecorded),
            toml::Value::String(text) => {
                text.parse().map(Self::Recorded).map_err(|error| wrong(format!("{error}, or \"recorded:*\"")))
            }
            toml::Value::Table(table) => GeneratedEntry::deserialize(table.into_deserializer())
                .map(Self::Generated)
                .map_err(|error| wrong(error.message().to_owned())),
            other => Err(wrong(format!(
                "expected a slot as in \"10:00\", \"recorded:*\" or a table {{ parent, generator, domainness }}, found {}",
                other.type_str()
            ))),
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
    /// Whether an equal-sized collective of placebos stands beside it.
    #[serde(default)]
    pub placebo: bool,
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
            reason: error.to_string().trim_end().to_owned(),
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

    fn check(&self, path: &Path, text: &str) -> Result<(), RunError> {
        let wrong = |line: usize, reason: String| {
            let place = if line > 0 { format!("line {line}: ") } else { String::new() };
            Err(RunError::Matrix { path: path.to_owned(), reason: format!("{place}{reason}") })
        };
        let line_of = |key: &str| text.lines().position(|line| line.trim_start().starts_with(key)).map_or(0, |i| i + 1);
        if self.axes.live.is_empty() {
            return wrong(
                line_of("live"),
                "the axis 'live' is empty: name at least one slot, as in live = [\"08:00\"]".into(),
            );
        }
        if self.axes.experience.is_empty() {
            return wrong(line_of("experience"), "the axis 'experience' is empty: name at least one slot".into());
        }
        if let Err((key, reason)) = self.localiser.check() {
            return wrong(line_of("localiser").max(line_of(key)), reason);
        }
        if self.codebook.words < 2 {
            return wrong(
                line_of("codebook"),
                format!("a codebook needs at least 2 words, not {}", self.codebook.words),
            );
        }
        if !(self.keyframes.distance_m > 0.0 && self.keyframes.yaw_rad > 0.0) {
            return wrong(line_of("keyframes"), "distance_m and yaw_rad must be greater than 0".into());
        }
        if !(self.features.hessian > 0.0 && self.features.hessian.is_finite()) {
            return wrong(line_of("features"), "hessian must be greater than 0".into());
        }
        let line_at = |span: std::ops::Range<usize>| text[..span.start].matches('\n').count() + 1;
        for entry in &self.axes.experience {
            if let ExperienceEntry::Generated(generated) = entry.get_ref()
                && let Err(reason) = generated.check()
            {
                return wrong(text[..entry.span().start].matches('\n').count() + 1, reason);
            }
        }
        for collective in &self.collective {
            if let Err(reason) = Selection::parse(collective.of.get_ref()) {
                return wrong(line_at(collective.of.span()), reason);
            }
            if collective.policy.get_ref().count() == Some(0) {
                let reason = "a policy of 0 experiences asks none: expected at least 1".to_owned();
                return wrong(line_at(collective.policy.span()), reason);
            }
            if !self.contrast.is_empty() && contrast::WORDS.contains(&collective.name.as_str()) {
                let reason = format!(
                    "a collective called '{}' cannot be told from the word of contrasts: call it otherwise",
                    collective.name
                );
                return wrong(line_at(collective.of.span()), reason);
            }
        }
        for contrast in &self.contrast {
            let read = [(&contrast.of, Side::of as fn(&str) -> _), (&contrast.over, Side::over)];
            if let Some((side, reason)) = read.iter().find_map(|(side, read)| Some((side, read(side.get_ref()).err()?)))
            {
                return wrong(line_at(side.span()), reason);
            }
        }
        Ok(())
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
}
