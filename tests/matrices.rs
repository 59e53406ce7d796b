//! Matrices as a user declares them: axes, rules, what is computed twice and what is not, failures, reproduction and comparison.

use crate::command::{field, furrow, json, matrix, store, text};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Output;

/// A store with the field's outings.
fn ingested() -> tempfile::TempDir {
    let store = store();
    field().ingest(store.path());
    store
}

fn said(store: &Path, args: &[&str]) -> Output {
    furrow().arg("--store").arg(store).args(args).output().unwrap()
}

/// The matrix of [`matrix`], with some of its text replaced.
fn changed(store: &Path, changes: &[(&str, &str)]) -> PathBuf {
    let path = matrix(store);
    let mut toml = std::fs::read_to_string(&path).unwrap();
    for (from, to) in changes {
        assert!(toml.contains(from), "{from} in {toml}");
        toml = toml.replace(from, to);
    }
    std::fs::write(&path, toml).unwrap();
    path
}

fn list<'a>(value: &'a Value, key: &str) -> Vec<&'a str> {
    value["cells"].as_array().unwrap().iter().map(|cell| cell[key].as_str().unwrap()).collect()
}

/// Units that were computed, by kind of stage.
fn work(result: &Value) -> Vec<(String, u64)> {
    let work = result["work"].as_object().unwrap();
    work.iter().map(|(kind, work)| (kind.clone(), work["units"].as_u64().unwrap())).collect()
}

fn units(result: &Value, kind: &str) -> u64 {
    work(result).into_iter().find(|(name, _)| name == kind).map_or(0, |(_, units)| units)
}

/// How many frames, or nodes, of something `ls` lists under a slot.
fn listed(store: &Path, what: &str, slot: &str, pass: &str) -> u64 {
    let listing = json(store, &["ls"]);
    let all = listing[what].as_array().unwrap();
    match what {
        "experiences" => all.iter().find(|e| e["slot"] == slot).unwrap()["nodes"].as_u64().unwrap(),
        _ => all.iter().find(|t| t["slot"] == slot && t["pass"] == pass).unwrap()["counts"]["frames"].as_u64().unwrap(),
    }
}

/// At the distance of keyframes that `ls` counts, alone without the collective, against one slot.
const ALONE: (&str, &str) = ("[[collective]]\nname = \"both\"\nof = \"recorded\"\n", "");
const AS_LISTED: (&str, &str) = ("distance_m = 1.0", "distance_m = 2.0");
const ONE_SLOT: (&str, &str) = ("[\"08:00\", \"10:00\"]", "[\"08:00\"]");

#[test]
fn only_what_a_change_touches_is_computed_again() {
    let store = ingested();
    let live_frames = listed(store.path(), "traversals", "08:00", "evaluation");
    let nodes = |slot| listed(store.path(), "experiences", slot, "");

    // The first run computes everything once, as the plan said.
    let path = changed(store.path(), &[ALONE, AS_LISTED, ONE_SLOT]);
    let planned = json(store.path(), &["plan", text(&path)]);
    let first = json(store.path(), &["run", text(&path)]);
    assert_eq!(units(&first, "features of the vocabulary images"), 60);
    assert_eq!(units(&first, "words of"), live_frames + nodes("08:00"));
    assert_eq!((units(&first, "verifying"), units(&first, "cells")), (live_frames, 1));
    for stage in planned["estimate"].as_array().unwrap() {
        let kind = stage["stage"].as_str().unwrap();
        if kind != "training the vocabulary" {
            assert_eq!(stage["units"].as_u64().unwrap(), units(&first, kind), "{kind}");
        }
    }

    // Unchanged, nothing.
    let again = json(store.path(), &["run", text(&path)]);
    assert_eq!((&again["work"], &again["cells"][0]["cached"]), (&json!({}), &json!(true)));
    assert_eq!(json(store.path(), &["plan", text(&path)])["estimate"], json!([]));

    // Another threshold: one cell is decided anew; no feature, word, likelihood or inlier is computed.
    let path = changed(store.path(), &[ALONE, AS_LISTED, ONE_SLOT, ("threshold = 40", "threshold = 55")]);
    let estimate = json(store.path(), &["plan", text(&path)])["estimate"].clone();
    let stages: Vec<&str> = estimate.as_array().unwrap().iter().map(|stage| stage["stage"].as_str().unwrap()).collect();
    assert_eq!(stages, ["cells"]);
    assert!(estimate[0]["seconds"].as_f64().unwrap() > 0.0, "a past run told: {estimate}");
    assert_eq!(work(&json(store.path(), &["run", text(&path)])), [("cells".to_owned(), 1)]);

    // Another slot: the words of its nodes and its own inliers; those of the live pass stay.
    let path = changed(store.path(), &[ALONE, AS_LISTED]);
    let more = json(store.path(), &["run", text(&path)]);
    assert_eq!(more["cells"].as_array().unwrap().iter().filter(|cell| cell["cached"] == true).count(), 1);
    assert_eq!(units(&more, "words of"), nodes("10:00"));
    assert_eq!((units(&more, "features of the vocabulary images"), units(&more, "cells")), (0, 1));

    // What was finished for another matrix says where.
    let path = changed(store.path(), &[ALONE, AS_LISTED, ("name = \"small\"", "name = \"other\"")]);
    let planned = json(store.path(), &["plan", text(&path)]);
    assert!(planned["cells"][0]["from"].as_str().unwrap().contains("'small'"), "{}", planned["cells"][0]["from"]);
}

#[test]
fn axes_cross_and_rules_choose() {
    let store = ingested();
    let axes = "[axes]\nthreshold = [30, 40]\nwords = [200, 300]\nkeyframes = [{ distance_m = 1.0, yaw_rad = 0.2536 }, { distance_m = 2.0, yaw_rad = 0.2536 }]\npolicy = [\"all\", { agree = 2 }]\n";
    let words = ("words = 600, ", "");
    let all = ("[\"08:00\", \"10:00\"]", "[\"recorded:*\"]");
    let path = changed(store.path(), &[("[axes]\n", axes), words, all]);
    let planned = json(store.path(), &["plan", text(&path)]);
    // 2 experiences and a collective by 2 policies, under 2 x 2 x 2 settings.
    assert_eq!(planned["cells"].as_array().unwrap().len(), 4 * 8, "{planned}");
    assert_eq!(planned["blocked"], json!([]));
    let settings: std::collections::BTreeSet<&str> = list(&planned, "setting").into_iter().collect();
    assert_eq!(settings.len(), 8);
    assert!(settings.contains("200 words, keyframes 2 m 0.2536 rad, threshold 30"), "{settings:?}");
    assert!(list(&planned, "experience").contains(&"both (agree 2)"));

    let rules = "[[exclude]]\nwords = 300\nthreshold = 30\n[[exclude]]\nexperience = \"both*\"\nkeyframes = [1.0]\n[[include]]\nexperience = [\"10:00\", \"both*\"]\n[axes]\n";
    let path = changed(store.path(), &[("[axes]\n", axes), words, all, ("[axes]\n", rules)]);
    let planned = json(store.path(), &["plan", text(&path)]);
    // Of the 8 settings 6 are left; 10:00 in all of them, the collective's two policies in the 3 with keyframes 2 m apart.
    assert_eq!(planned["cells"].as_array().unwrap().len(), 6 + 2 * 3);
    let few = json(
        store.path(),
        &["plan", text(&path), "--only", "words=200,experience=10:00", "--only", "experience=both (all)"],
    );
    assert_eq!(few["cells"].as_array().unwrap().len(), 4 + 3);
    assert_eq!(said(store.path(), &["plan", text(&path), "--only", "words=201"]).status.code(), Some(2));
    assert_eq!(planned["warnings"], json!([]), "every rule applies to some cell");

    // A rule that applies to nothing is pointed out; a filter leaves out what is blocked elsewhere.
    let misspelt = ("[axes]\n", "[[exclude]]\nexperience = \"08.00\"\n[axes]\n");
    let path = changed(store.path(), &[misspelt, ("[\"08:00\", \"10:00\"]", "[\"08:00\", \"10:00\", \"14:00\"]")]);
    let planned = json(store.path(), &["plan", text(&path)]);
    let warnings = planned["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w.as_str().unwrap().contains("experience=08.00")), "{warnings:?}");
    assert_eq!(planned["blocked"].as_array().unwrap().len(), 1);
    let filtered = json(store.path(), &["plan", text(&path), "--only", "experience=10:00"]);
    assert_eq!((filtered["cells"].as_array().unwrap().len(), &filtered["blocked"]), (1, &json!([])));

    // Passes by number and day; one that is not there is told from those that are.
    let entries =
        "[{ slot = \"08:00\", pass = 1 }, { slot = \"10:00\", date = \"2026-01-15\" }, { slot = \"08:00\", pass = 2 }]";
    let path = changed(store.path(), &[ALONE, (all.0, entries)]);
    let planned = json(store.path(), &["plan", text(&path)]);
    assert_eq!(list(&planned, "experience"), ["08:00 pass 1", "10:00 on 2026-01-15"]);
    let reason = planned["blocked"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("08:00 pass 2") && reason.contains("pass 1 on 2026-01-15"), "{reason}");
}

/// Contrasts stand in every setting of a matrix, say which, and are told once where two settings come to the same cells.
#[test]
fn contrasts_are_asked_in_every_setting() {
    let store = ingested();
    let store = store.path();
    let words = ("words = 600, ", "");
    let asked = "[[contrast]]\nof = \"both\"\nover = \"10:00\"\n[axes]\n";
    let pairs = |result: &Value| -> Vec<[String; 3]> {
        let word = |contrast: &Value, key: &str| contrast[key].as_str().unwrap_or_default().to_owned();
        let told = |contrast: &Value| ["of", "over", "setting"].map(|key| word(contrast, key));
        result["contrasts"].as_array().unwrap().iter().map(told).collect()
    };
    let pair = |of: &str, setting: &str| [of, "10:00", setting].map(str::to_owned);

    let path = changed(store, &[("[axes]\n", &format!("{asked}words = [200, 300]\n")), words]);
    let planned = json(store, &["plan", text(&path)]);
    assert_eq!(pairs(&planned), [pair("both", "200 words"), pair("both", "300 words")]);
    let ran = json(store, &["run", text(&path)]);
    assert_eq!(pairs(&ran), pairs(&planned));
    let cells = ran["cells"].as_array().unwrap();
    for contrast in ran["contrasts"].as_array().unwrap() {
        let good = |key: &str| {
            let is = |cell: &&Value| cell["experience"] == contrast[key] && cell["setting"] == contrast["setting"];
            cells.iter().find(is).unwrap()["good"].as_f64().unwrap()
        };
        assert_eq!(contrast["good"]["difference"], good("of") - good("over"), "{contrast}");
    }
    let again = json(store, &["run", text(&path)]);
    assert_eq!((&again["run"], &again["contrasts"]), (&ran["run"], &ran["contrasts"]));
    let printed = String::from_utf8(said(store, &["run", text(&path)]).stdout).unwrap();
    assert!(printed.contains("both over 10:00 [300 words]"), "{printed}");
    let page = store.join("report.html");
    json(store, &["report", "latest", "-o", text(&page)]);
    assert!(std::fs::read_to_string(&page).unwrap().contains("<bdi>300 words</bdi>"));

    // Both policies of a collective; settings that come to the same cells; one setting, which needs no name.
    let policies = format!("{asked}policy = [\"all\", {{ agree = 2 }}]\n");
    let planned = json(store, &["plan", text(&changed(store, &[("[axes]\n", &policies)]))]);
    assert_eq!(pairs(&planned), [pair("both (all)", ""), pair("both (agree 2)", "")]);
    let images = format!("{asked}images = [5000, 6000]\n");
    let planned = json(store, &["plan", text(&changed(store, &[("[axes]\n", &images)]))]);
    assert_eq!(pairs(&planned), [pair("both", "5000 vocabulary images")]);

    let wrong = said(store, &["plan", text(&changed(store, &[("[axes]\n", &asked.replace("10:00", "10:01"))]))]);
    let error = String::from_utf8(wrong.stderr).unwrap();
    assert!(error.contains("line 8, column 8: contrast: nothing is called '10:01': did you mean '10:00'?"), "{error}");
}

/// The store's file that holds the left image of an experience's first node.
fn first_image(store: &Path, slot: &str) -> PathBuf {
    let listing = json(store, &["ls"]);
    let experience = listing["experiences"].as_array().unwrap().iter().find(|e| e["slot"] == slot).unwrap().clone();
    let file = store.join("objects");
    let record = experience["experience"].as_str().unwrap();
    let text = std::fs::read_to_string(file.join(&record[..2]).join(record)).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let left = record["body"]["nodes"][0]["left"].as_str().unwrap();
    file.join(&left[..2]).join(left)
}

#[test]
fn a_failing_cell_stops_only_itself_and_is_taken_up_again() {
    let store = ingested();
    let path = changed(store.path(), &[]);
    let image = first_image(store.path(), "10:00");
    let bytes = std::fs::read(&image).unwrap();
    std::fs::remove_file(&image).unwrap();
    std::fs::write(&image, b"damaged").unwrap();

    // Without the flag the run ends there, as a failure.
    assert_eq!(said(store.path(), &["run", text(&path)]).status.code(), Some(1));
    let ended = said(store.path(), &["run", text(&path), "--keep-going", "--json"]);
    assert_eq!(ended.status.code(), Some(3), "{}", String::from_utf8_lossy(&ended.stderr));
    let result: Value = serde_json::from_slice(&ended.stdout).unwrap();
    assert_eq!(list(&result, "experience"), ["08:00"]);
    let failed: Vec<&str> =
        result["failed"].as_array().unwrap().iter().map(|f| f["experience"].as_str().unwrap()).collect();
    assert_eq!(failed, ["10:00", "both"]);
    let name = image.file_name().unwrap().to_str().unwrap();
    assert!(result["failed"][0]["reason"].as_str().unwrap().contains(name), "{result}");
    assert_eq!(json(store.path(), &["status", "latest"])["runs"][0]["failed"].as_array().unwrap().len(), 2);

    // Repaired, only what failed is computed: nothing of the cell that was finished.
    std::fs::write(&image, bytes).unwrap();
    let result = json(store.path(), &["run", text(&path), "--failed"]);
    assert_eq!(list(&result, "experience"), ["08:00", "10:00", "both"]);
    assert_eq!((units(&result, "cells"), &result["failed"]), (2, &json!([])));
    assert_eq!(json(store.path(), &["status", "latest"])["runs"][0]["failed"], json!([]));
}

#[test]
fn a_run_comes_out_of_the_recordings_alone_again() {
    let store = ingested();
    let path = changed(store.path(), &[ALONE]);
    let run = json(store.path(), &["run", text(&path)]);
    let elsewhere = tempfile::tempdir().unwrap();
    let fresh = elsewhere.path().join("fresh");
    let done = json(store.path(), &["reproduce", "latest", "--into", text(&fresh)]);
    assert_eq!((&done["cells"], &done["passes"], &done["difference"]), (&json!(2), &json!(4), &Value::Null));
    // The fresh store has nothing of the first but bytes of the same names, and stands on its own.
    let again = json(&fresh, &["run", text(&path)]);
    assert_eq!(list(&again, "key"), list(&run, "key"));
    assert_eq!(json(&fresh, &["fsck"])["faults"], json!([]));

    // An outcome that was tampered with is found out, and where.
    let database = store.path().join("catalogue.db");
    let key = run["cells"][0]["key"].as_str().unwrap();
    let forged = forge(store.path(), key);
    assert!(database.is_file() && forged);
    let ended = said(store.path(), &["reproduce", "latest", "--json"]);
    assert_eq!(ended.status.code(), Some(3), "{}", String::from_utf8_lossy(&ended.stderr));
    let found: Value = serde_json::from_slice(&ended.stdout).unwrap();
    assert_eq!(found["difference"]["place"], "body.threshold_inliers", "{found}");
}

/// Puts another number into a cell's outcome, under a right name.
fn forge(store: &Path, cell: &str) -> bool {
    let catalog = furrow_catalog::Catalog::open(store).unwrap();
    let outcome = catalog.outcome(cell.parse().unwrap()).unwrap().unwrap();
    let forged = furrow_model::Outcome { threshold_inliers: outcome.threshold_inliers + 1, ..outcome };
    catalog.enter_outcome(&forged).is_ok()
}

#[test]
fn a_run_is_held_to_another() {
    let store = ingested();
    let run = |changes: &[(&str, &str)]| {
        let path = changed(store.path(), changes);
        json(store.path(), &["run", text(&path)])
    };
    let id = |run: &Value| run["run"].as_str().unwrap().to_owned();
    let (before, after) = (run(&[]), run(&[("threshold = 40", "threshold = 100000")]));
    let compared = json(store.path(), &["compare", &id(&before), &id(&after)]);
    let cells = compared["comparison"]["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 3);
    let own = &before["cells"][0];
    let share = 100.0 * own["good"].as_f64().unwrap() / own["frames"].as_f64().unwrap();
    assert!(share > 10.0, "the sibling pass is localised: {share}");
    assert!((cells[0]["change_points"].as_f64().unwrap() + share).abs() < 1e-9);
    let code =
        |a: &str, b: &str, points: &str| said(store.path(), &["compare", a, b, "--max-drop", points]).status.code();
    let (a, b) = (id(&before), id(&after));
    assert_eq!((code(&a, &b, "0"), code(&b, &a, "0")), (Some(3), Some(0)));
    assert_eq!((code(&a, &b, "100"), code(&a, &a, "0"), code(&a, &b, "nothing")), (Some(0), Some(0), Some(2)));
    // A cell that the second run lacks is no cell that held.
    let fewer = id(&run(&[ALONE]));
    assert_eq!((code(&a, &fewer, "100"), code(&fewer, &a, "0")), (Some(3), Some(0)));
}

/// The thesis' script at its small scale, in a process group of its own.
fn thesis_script(folder: &Path) -> std::process::Command {
    use std::os::unix::process::CommandExt;
    let mut command = std::process::Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/thesis.sh"));
    command.args([env!("CARGO_BIN_EXE_furrow"), text(folder)]).env("SCALE", "ci").process_group(0);
    command
}

/// Runs the script until it says `word`, then kills it and all that it started; what it said.
fn killed_at(folder: &Path, word: &str) -> String {
    use std::io::BufRead;
    use std::process::Stdio;
    let mut child = thesis_script(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = String::new();
    for line in std::io::BufReader::new(child.stderr.take().unwrap()).lines() {
        let line = line.unwrap();
        said += &line;
        said.push('\n');
        if line.contains(word) {
            break;
        }
    }
    assert!(said.contains(word), "it ended before '{word}': {said}");
    std::thread::sleep(std::time::Duration::from_millis(300));
    let group = format!("-{}", child.id());
    assert!(std::process::Command::new("kill").args(["-9", "--", &group]).status().unwrap().success());
    child.wait().unwrap();
    said
}

#[test]
fn the_thesis_is_recorded_run_and_judged_by_one_script_that_may_be_killed() {
    let folder = tempfile::tempdir().unwrap();
    let thesis = folder.path().join("thesis");
    let script = || {
        let output = thesis_script(&thesis).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        said
    };
    // In the middle of a recording, and of an experiment.
    let held = |said: &str| said.matches("is in the store already").count();
    killed_at(&thesis, "recording old-zoo-main-1000-evaluation");
    assert_eq!(held(&killed_at(&thesis, " X03")), 3, "three passes were in the store");
    let said = script();
    assert_eq!(held(&said), 14, "{said}");
    let page = std::fs::read_to_string(thesis.join("thesis.html")).unwrap().replace("&#x2f;", "/");
    for experiment in ["X01", "X02", "X03", "X04", "X08", "X09", "X10", "X13", "X14"] {
        let report = format!("reports/{experiment}.html");
        assert!(thesis.join(&report).is_file() && page.contains(&format!("href=\"{report}\"")), "{experiment}");
    }
    let judged = json(&thesis.join("field"), &["claims"]);
    let claims = judged["claims"].as_array().unwrap();
    let verdict = |id: &str| {
        assert!(page.contains(&format!("id=\"{}\"", id.replace(' ', "-"))), "{id}");
        claims.iter().find(|claim| claim["id"] == id).unwrap()["verdict"].as_str().unwrap().to_owned()
    };
    // What needs no drive holds on any machine.
    assert_eq!([verdict("C9"), verdict("C10"), verdict("C11")], ["holds"; 3]);
    // Passes of 8 m have no interval, whatever their counts; and what was not driven is not judged.
    for id in ["C1", "C2", "C4 parent", "C4 placebo", "C7 peak", "C8 count"] {
        assert_eq!(verdict(id), "not-separable", "{id}");
    }
    assert_eq!([verdict("C3"), verdict("C5"), verdict("C6")], ["not-measured"; 3]);
    assert!(["C7 growth", "C8 precision"].iter().all(|id| verdict(id) != "not-measured"));
    // Whoever reads it is told why.
    assert!(claims.iter().all(|claim| !claim["why"].as_str().unwrap().is_empty()), "{claims:?}");

    // The same script again computes nothing.
    let said = script();
    assert_eq!(held(&said), 14);
    for work in ["simulated field", "words of", "verifying", "painting", "training the vocabulary"] {
        assert!(!said.contains(work), "{work}: {said}");
    }
    assert_eq!(json(&thesis.join("field"), &["fsck"])["faults"], serde_json::json!([]));
}

#[test]
fn every_matrix_of_the_repository_can_be_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("runner/matrices");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let toml = std::fs::read_to_string(&path).unwrap();
        furrow_runner::Matrix::parse(&path, &toml).unwrap_or_else(|error| panic!("{error}"));
        read += 1;
    }
    assert!(read >= 12, "{read} matrices");
}
