//! scripts/thesis.sh records, runs and judges the thesis' experiments, and goes on where it was after a kill -9.

use crate::support::store::Store;
use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};

/// The script at its small scale, in a process group of its own.
fn script(folder: &Path) -> Command {
    let mut command = Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/thesis.sh"));
    command.arg(env!("CARGO_BIN_EXE_furrow")).arg(folder).env("SCALE", "ci").process_group(0);
    command
}

/// What the script says until its end, which must be a success.
fn finished(folder: &Path) -> String {
    let output = script(folder).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{stderr}");
    stderr
}

/// Runs the script until it says `word`, then kills it and all that it started; what it said.
fn killed_at(folder: &Path, word: &str) -> String {
    let mut child = script(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stderr = String::new();
    for line in BufReader::new(child.stderr.take().unwrap()).lines() {
        let line = line.unwrap();
        stderr += &line;
        stderr.push('\n');
        if line.contains(word) {
            break;
        }
    }
    assert!(stderr.contains(word), "it ended before '{word}': {stderr}");
    std::thread::sleep(std::time::Duration::from_millis(300));
    let group = format!("-{}", child.id());
    assert!(Command::new("kill").args(["-9", "--", &group]).status().unwrap().success());
    child.wait().unwrap();
    stderr
}

#[test]
fn the_thesis_is_recorded_run_and_judged_by_one_script_that_may_be_killed() {
    let folder = tempfile::Builder::new().prefix("furrow thesis ").tempdir().unwrap();
    let thesis = folder.path().join("thesis");
    // In the middle of a recording, and of an experiment.
    let held = |stderr: &str| stderr.matches("is in the store already").count();
    killed_at(&thesis, "recording old-zoo-main-1000-evaluation");
    assert_eq!(held(&killed_at(&thesis, " X03")), 3, "three traversals were in the store");
    let stderr = finished(&thesis);
    assert_eq!(held(&stderr), 14, "{stderr}");
    let page = std::fs::read_to_string(thesis.join("thesis.html")).unwrap().replace("&#x2f;", "/");
    for experiment in ["X01", "X02", "X03", "X04", "X08", "X09", "X10", "X13", "X14"] {
        let report = format!("reports/{experiment}.html");
        assert!(thesis.join(&report).is_file() && page.contains(&format!("href=\"{report}\"")), "{experiment}");
    }
    let store = Store::at(thesis.join("field"));
    let judged = store.json("claims");
    let claims = judged["claims"].as_array().unwrap();
    let verdict = |id: &str| {
        assert!(page.contains(&format!("id=\"{}\"", id.replace(' ', "-"))), "{id}");
        claims.iter().find(|claim| claim["id"] == id).unwrap()["verdict"].as_str().unwrap().to_owned()
    };
    // What needs no recording holds on any machine.
    assert_eq!([verdict("C9"), verdict("C10"), verdict("C11")], ["holds"; 3]);
    // Traversals of 8 m have no interval, whatever their counts; and what was not recorded is not judged.
    for id in ["C1", "C2", "C4 parent", "C4 placebo", "C7 peak", "C8 count"] {
        assert_eq!(verdict(id), "not-separable", "{id}");
    }
    assert_eq!([verdict("C3"), verdict("C5"), verdict("C6")], ["not-measured"; 3]);
    assert!(["C7 growth", "C8 precision"].iter().all(|id| verdict(id) != "not-measured"));
    // Whoever reads it is told why.
    assert!(claims.iter().all(|claim| !claim["why"].as_str().unwrap().is_empty()), "{claims:?}");

    // The same script again computes nothing.
    let stderr = finished(&thesis);
    assert_eq!(held(&stderr), 14);
    for work in ["simulated field", "words of", "verifying", "painting", "training the vocabulary"] {
        assert!(!stderr.contains(work), "{work}: {stderr}");
    }
    store.assert_intact();
}
