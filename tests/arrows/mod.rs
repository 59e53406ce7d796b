//! Crates, the rooms inside them and their files depend on each other only in the directions of the design.

mod sources;

use serde_json::Value;
use sources::{Sources, circles};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// The design's arrows, from a crate to what it stands on. What lies below on the same line may be used too.
const ARROWS: [(&str, &[&str]); 10] = [
    ("furrow-model", &[]),
    ("furrow-odometry", &["furrow-model"]),
    ("furrow-catalog", &["furrow-model"]),
    ("furrow-ingest", &["furrow-odometry", "furrow-catalog"]),
    ("furrow-localiser", &["furrow-model"]),
    ("furrow-generator", &["furrow-model"]),
    ("furrow-runner", &["furrow-ingest", "furrow-localiser", "furrow-generator"]),
    ("furrow-reports", &["furrow-catalog"]),
    ("furrow-field", &["furrow-model"]),
    ("furrow", &["furrow-runner", "furrow-reports", "furrow-field"]),
];

/// Crates whose numbers must not depend on files, clocks or sockets, and crates that would bring those in.
const NUMERIC: [&str; 4] = ["furrow-model", "furrow-odometry", "furrow-localiser", "furrow-generator"];
const IMPURE: [&str; 6] = ["tokio", "sqlx", "opencv", "polars", "mcap", "png"];

fn below(krate: &str, arrows: &BTreeMap<&str, &[&str]>) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut todo = vec![krate.to_owned()];
    while let Some(name) = todo.pop() {
        for next in arrows.get(name.as_str()).copied().unwrap_or_default() {
            if found.insert((*next).to_owned()) {
                todo.push((*next).to_owned());
            }
        }
    }
    found
}

/// The workspace's crates with what they use outside of tests. cargo's own JSON is read as it is: the crate that wraps
/// it would have every build of the tests compile all that uses serde once more, for a feature of it that nothing else
/// asks for.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let asked = ["metadata", "--no-deps", "--format-version", "1", "--manifest-path", manifest];
    let output = Command::new(env!("CARGO")).args(asked).output().expect("cargo metadata");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo prints JSON");
    let name = |value: &Value| value["name"].as_str().expect("a name").to_owned();
    let normal = |package: &Value| {
        let used = package["dependencies"].as_array().expect("dependencies").iter();
        (name(package), used.filter(|used| used["kind"].is_null()).map(name).collect())
    };
    metadata["packages"].as_array().expect("packages").iter().map(normal).collect()
}

#[test]
fn crates_point_only_where_the_design_says() {
    let arrows: BTreeMap<&str, &[&str]> = ARROWS.into_iter().collect();
    let found = dependencies();
    let names: BTreeSet<&str> = found.keys().map(String::as_str).collect();
    assert_eq!(names, arrows.keys().copied().collect(), "crates of the workspace");
    for (krate, used) in &found {
        let allowed = below(krate, &arrows);
        let wrong: Vec<&String> = used.iter().filter(|d| d.starts_with("furrow") && !allowed.contains(*d)).collect();
        assert!(wrong.is_empty(), "{krate} must not depend on {wrong:?}");
    }
}

#[test]
fn numeric_crates_do_no_input_or_output() {
    let found = dependencies();
    for krate in NUMERIC {
        let impure: Vec<&&str> = IMPURE.iter().filter(|name| found[krate].contains(**name)).collect();
        assert!(impure.is_empty(), "{krate} must not depend on {impure:?}");
    }
}

#[test]
fn only_the_catalogue_and_the_db3_reader_know_sql() {
    let users: Vec<String> =
        dependencies().into_iter().filter(|(_, used)| used.contains("sqlx")).map(|(name, _)| name).collect();
    assert_eq!(users, ["furrow-catalog", "furrow-ingest"]);
}

/// The sources of a crate: its folder, and the folders in it that are crates of their own.
const CRATES: [(&str, &[&str]); 10] = [
    ("catalog/model", &[]),
    ("catalog", &["model", "migrations"]),
    ("ingest/odometry", &[]),
    ("ingest", &["odometry"]),
    ("runner/localiser", &[]),
    ("runner/generator", &[]),
    ("runner", &["localiser", "generator", "cli", "matrices"]),
    ("runner/cli", &[]),
    ("reports", &[]),
    ("tests/field", &[]),
];

/// The rooms of a crate, layer by layer: a room uses rooms of the layers before its own, and files at the crate's root
/// use none.
const ROOMS: [(&str, &[&[&str]]); 3] = [
    (
        "runner",
        &[
            &["matrix"],
            &["inputs"],
            &["evaluate"],
            &["generation"],
            &["plan"],
            &["stages"],
            &["study"],
            &["claims", "export", "live", "slurm"],
        ],
    ),
    (
        "ingest/odometry",
        &[&["compare", "params"], &["features"], &["matching"], &["motion"], &["chain", "verification"]],
    ),
    ("reports", &[&["chart"], &["figures"], &["page"], &["browse"]]),
];

/// Files that use each other for a reason; at most two circles.
const REASONED: [(&str, &[&str]); 0] = [];

fn arrows_of(krate: &str) -> BTreeMap<String, BTreeSet<String>> {
    let beside = CRATES.iter().find(|(name, _)| *name == krate).map_or(&[] as &[&str], |(_, beside)| beside);
    Sources::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(krate), beside).arrows()
}

#[test]
fn no_file_uses_another_in_a_circle() {
    let mut found = Vec::new();
    for (krate, _) in CRATES {
        let arrows = arrows_of(krate);
        assert!(!arrows.is_empty(), "{krate} has no sources");
        for circle in circles(&arrows) {
            let reasoned = REASONED.iter().any(|(home, files)| *home == krate && *files == circle);
            if !reasoned {
                found.push(format!("{krate}: {}", circle.join(", ")));
            }
        }
    }
    assert!(
        found.is_empty(),
        "circles between files: move what both need into a file of its own\n{}",
        found.join("\n")
    );
}

#[test]
fn rooms_use_only_those_before_them() {
    let mut wrong = Vec::new();
    for (krate, layers) in ROOMS {
        let layer = |file: &str| match file.split_once('/') {
            None => Some(0),
            Some((room, _)) => layers.iter().position(|rooms| rooms.contains(&room)).map(|layer| layer + 1),
        };
        for (file, used) in arrows_of(krate).iter().filter(|(file, _)| *file != "lib.rs") {
            let own = layer(file).unwrap_or_else(|| panic!("{krate}/{file} stands in no room of the design"));
            for other in used {
                let same_room = file.split('/').next() == other.split('/').next();
                if !same_room && layer(other).is_none_or(|other| other >= own) {
                    wrong.push(format!("{krate}: {file} uses {other}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "rooms that use those behind them:\n{}", wrong.join("\n"));
}
