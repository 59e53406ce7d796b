//! The place recognisers. A new one is a file beside this one, copied from `sequences`, and a line here.

use super::external::EXTERNAL_DESCRIPTORS;
use super::fabmap::FABMAP;
use super::sequences::SEQSLAM;
use crate::RunError;
use crate::inputs::recogniser::{Recogniser, RecogniserEntry};
use crate::matrix::{Matrix, Method};
use std::path::Path;
use std::sync::Arc;

/// All of them; the first is the default.
const REGISTRY: &[&RecogniserEntry] = &[
    &FABMAP,
    &SEQSLAM,
    &EXTERNAL_DESCRIPTORS,
    #[cfg(test)]
    &super::toy::TOY,
];

/// Reads a matrix file's text.
///
/// # Errors
/// [`RunError::Matrix`] naming file, line and what is wrong.
pub fn read_matrix(path: &Path, text: &str) -> Result<Matrix, RunError> {
    let methods: Vec<&Method> = REGISTRY.iter().map(|entry| &entry.method).collect();
    Matrix::parse(path, text, &methods)
}

/// The recogniser of a matrix of one setting.
pub(crate) fn open(matrix: &Matrix) -> Result<Arc<dyn Recogniser>, RunError> {
    let name = matrix.localiser.method();
    match REGISTRY.iter().find(|entry| entry.method.name == name) {
        Some(entry) => (entry.open)(matrix),
        None => Err(RunError::Recogniser(format!("there is no place recogniser \"{name}\""))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: &str = r#"
name = "m"
site = "s"
codebook = { words = 6000, route = "vocabulary" }
localiser = {}
[axes]
live = ["08:00"]
experience = ["10:00"]
"#;

    fn parse(localiser: &str) -> Result<Matrix, String> {
        let text = MATRIX.replace("localiser = {}", localiser);
        read_matrix(Path::new("some/where/m.toml"), &text).map_err(|error| error.to_string())
    }

    #[test]
    fn what_a_recogniser_does_not_know_is_named_with_its_line() {
        let check = |localiser: &str, expected: &[&str]| {
            let error = parse(&format!("localiser = {{ {localiser} }}")).unwrap_err();
            for word in ["line 5, column "].iter().chain(expected) {
                assert!(error.contains(word), "expected '{word}' in: {error}");
            }
        };
        check("method = \"fabmap\"", &["fabmap2", "seqslam", "external", "did you mean 'fabmap2'?"]);
        check("method = \"external\"", &["descriptors", "NPY"]);
        check("descriptors = \"a.npy\"", &["\"external\"", "\"fabmap2\""]);
        check("motion = { leave = 2.0 }", &["chances"]);
        check("motion = { leve = 0.2 }", &["leve", "did you mean 'leave'?"]);
        check("method = \"seqslam\", motion = {}", &["\"fabmap2\""]);
        check("method = \"seqslam\", shift = 0.7", &["shift of 0.7", "0 to 0.5"]);
        check("sequence = 0", &["at least 1 image"]);
        check("metric = \"l3\"", &["metric: unknown variant", "`l2`"]);
    }

    #[test]
    fn methods_stand_side_by_side_each_with_its_own_keys() {
        let text = "localiser = { motion = {}, descriptors = \"a.npy\" }\naxes.method = [\"seqslam\", \"fabmap2\"]";
        let text = format!("{text}\naxes.live = [\"08:00\"]\naxes.experience = [\"10:00\"]");
        let text = MATRIX.split_once("localiser").unwrap().0.to_owned() + &text;
        let settings = read_matrix(Path::new("m.toml"), &text).unwrap().settings();
        let parts: Vec<_> = settings.iter().map(|setting| open(&setting.matrix).unwrap().cell_key_part()).collect();
        assert_eq!(parts[0][0], "seqslam");
        assert_eq!(parts[1], serde_json::json!(["fabmap2", furrow_localiser::fabmap::MotionModel::DEFAULT]));
    }

    #[test]
    fn descriptors_lie_beside_the_matrix() {
        let matrix = parse("localiser = { method = \"external\", descriptors = \"a.npy\" }").unwrap();
        let error = open(&matrix).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("some/where/a.npy"), "{error}");
    }

    #[test]
    fn fabmap_is_its_name_alone_in_keys_of_cells() {
        let part = open(&parse("localiser = {}").unwrap()).unwrap().cell_key_part();
        assert_eq!(part, serde_json::json!("fabmap2"));
    }
}
