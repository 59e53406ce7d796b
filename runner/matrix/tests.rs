use super::*;
use std::path::Path;

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

/// Two place recognisers with a key each, of which one must stand alone.
const METHODS: [Method; 2] = [
    Method { name: "by-words", keys: &[OwnKey { name: "motion", exclusive: true }], check: |_| Ok(()) },
    Method {
        name: "by-sequences",
        keys: &[OwnKey { name: "length", exclusive: false }],
        check: |spec| match spec.get::<u32>("length")? {
            Some(0) => Err(spec.fault("length", "a sequence of 0")),
            _ => Ok(()),
        },
    },
];

fn parse(text: &str) -> Result<Matrix, String> {
    Matrix::parse(Path::new("some/where/m.toml"), text, &METHODS.each_ref()).map_err(|error| error.to_string())
}

fn example() -> String {
    // TOML ends a key with its line; DESIGN separates three by semicolons for brevity.
    DESIGN_EXAMPLE.replace("; ", "\n")
}

#[test]
fn the_example_of_the_design_is_read() {
    let matrix = parse(&example()).unwrap();
    assert_eq!(matrix.axes.experience.len(), 5);
    assert!(matches!(matrix.axes.experience[4].get_ref(), ExperienceEntry::Generated(g) if g.domainness.len() == 3));
    assert_eq!(matrix.report.figures.len(), 4);
    let of = Selection::parse(matrix.collective[0].of.get_ref());
    let generated = Part::Generated { parent: Some("10:00".parse().unwrap()), by: None };
    assert_eq!(of.map(|selection| selection.parts), Ok(vec![generated]));
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
    check(
        "[axes]",
        &localiser("method = \"by-word\""),
        &["line 6, column 24", "by-sequences", "did you mean 'by-words'?"],
    );
    check("[axes]", &localiser("candidates = 0"), &["line 6", "candidates"]);
    check("[axes]", &localiser("candidats = 2"), &["line 6, column 15", "did you mean 'candidates'?"]);
    check("[axes]", &localiser("length = 0"), &["line 6, column 15", "a sequence of 0"]);
    check("[axes]", &localiser("length = \"long\""), &["line 6, column 15", "length: invalid type", "expected u32"]);
    check("[axes]", &localiser("method = \"by-sequences\", motion = 1"), &["line 6, column 40", "\"by-words\""]);
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
    check("[axes]", "[axes]\nmethod = [\"by-sequence\"]", &["line 7, column 11", "did you mean 'by-sequences'?"]);
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
        "[axes]\nwords = [300, 600, 300]\nimages = [50]\nmethod = [\"by-words\", \"by-sequences\"]\nseed = [1, 2]\n";
    let text = example()
        .replace("[axes]\n", axes)
        .replace("placebo = true", "")
        .replace("keyframes =", "localiser = { motion = 1 }\nkeyframes =");
    let settings = parse(&text).unwrap().settings();
    let read: Vec<(&str, u32, usize, &str, u64)> = (settings.iter())
        .map(|Setting { label, matrix }| {
            (label.as_str(), matrix.codebook.words, matrix.codebook.images, matrix.localiser.method(), matrix.seed)
        })
        .collect();
    assert_eq!(read.len(), 8);
    assert_eq!(read[0], ("300 words, by-words, seed 1", 300, 50, "by-words", 1));
    assert_eq!(read[3], ("300 words, by-sequences, seed 2", 300, 50, "by-sequences", 2));
    assert_eq!(read[7].0, "600 words, by-sequences, seed 2");
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
