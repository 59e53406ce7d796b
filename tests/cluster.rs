//! The second executor: a real Slurm, started here, gives the same answer as this machine alone, whoever is killed on the way.

use crate::command::{field, furrow, json, matrix, store, text};
use crate::slurm::Slurm;
use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// `furrow run MATRIX --executor slurm` on a cluster, with more arguments.
fn on_slurm(slurm: &Slurm, store: &Path, more: &[&str]) -> Command {
    let mut command = slurm.tell(furrow());
    command.arg("--store").arg(store).arg("run").arg(store.join("matrix.toml"));
    command.args(["--executor", "slurm"]).args(more);
    command
}

fn answer(command: &mut Command) -> Value {
    let output = command.arg("--json").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?} ended with {}: {said}", output.status);
    serde_json::from_slice(&output.stdout).unwrap()
}

/// All that must not depend on where a run was computed: its id, and its cells with all their numbers and objects.
fn result(value: &Value) -> Value {
    let mut cells = value["cells"].clone();
    for cell in cells.as_array_mut().unwrap() {
        cell["cached"] = Value::Null;
    }
    json!([value["run"], cells, value["failed"], value["contrasts"]])
}

/// A store with the field's outings and a matrix, and beside it what one thread makes of it.
fn prepared(changes: &[(&str, &str)]) -> (tempfile::TempDir, tempfile::TempDir, Value) {
    let fresh = store();
    field().ingest(fresh.path());
    let path = matrix(fresh.path());
    let toml = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, changes.iter().fold(toml, |toml, (from, to)| toml.replace(from, to))).unwrap();
    let alone = tempfile::tempdir().unwrap();
    copy(fresh.path(), alone.path());
    let expected = json(alone.path(), &["run", text(&alone.path().join("matrix.toml")), "-j", "1"]);
    (fresh, alone, expected)
}

fn copy(from: &Path, to: &Path) {
    let status = Command::new("cp").arg("-a").arg(from.join(".")).arg(to).status().unwrap();
    assert!(status.success());
}

#[test]
fn a_cluster_gives_the_same_outcomes_as_one_machine() {
    let Some(slurm) = Slurm::start() else { return };
    // A generated experience, a collective, a calibrated threshold: a unit of every kind.
    let generated = "[\"08:00\", \"10:00\", { parent = \"10:00\", generator = \"gamma\", domainness = [0.5] }]";
    let axes = format!("threshold = [40, \"calibrated\"]\nexperience = {generated}");
    let changes = [("verification = { threshold = 40 }\n", ""), ("experience = [\"08:00\", \"10:00\"]", axes.as_str())];
    let (fresh, alone, expected) = prepared(&changes);
    let database = |store: &Path| std::fs::metadata(store.join("catalogue.db")).unwrap().modified().unwrap();

    // Left at once: workers go on without the database, whose bytes nobody touches meanwhile.
    let left = answer(&mut on_slurm(&slurm, fresh.path(), &["--detach", "--array-limit", "2", "--partition", "field"]));
    assert_eq!((left["cells"].as_array().unwrap().len(), left["run"].clone()), (0, expected["run"].clone()));
    let touched = database(fresh.path());
    let began = Instant::now();
    while !slurm.queue().is_empty() {
        assert!(began.elapsed() < Duration::from_secs(240), "{:?}", slurm.queue());
        std::thread::sleep(Duration::from_millis(200));
    }
    assert_eq!(database(fresh.path()), touched, "a worker wrote into the catalogue");

    // Come back to.
    let collected = answer(slurm.tell(furrow()).arg("--store").arg(fresh.path()).args(["collect", "latest"]));
    let cells = expected["cells"].as_array().unwrap().len();
    assert_eq!((&collected["finished"], &collected["tasks_in_queue"]), (&json!(cells), &json!(0)));
    let again = answer(&mut on_slurm(&slurm, fresh.path(), &[]));
    assert_eq!(result(&again), result(&expected));
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true));

    // The catalogue lists what a local run would have listed.
    assert_eq!(json(fresh.path(), &["ls"]), json(alone.path(), &["ls"]));
    assert_eq!(json(fresh.path(), &["fsck"])["faults"], json!([]));
    assert_eq!(json(fresh.path(), &["fsck"])["rows"], json(alone.path(), &["fsck"])["rows"]);

    // And two threads of this machine say the same.
    let two = store();
    field().ingest(two.path());
    std::fs::copy(alone.path().join("matrix.toml"), two.path().join("matrix.toml")).unwrap();
    let local = json(two.path(), &["run", text(&two.path().join("matrix.toml")), "-j", "2"]);
    assert_eq!(result(&local), result(&expected));
}

#[test]
fn whoever_is_killed_the_same_command_ends_with_the_same_ids() {
    let Some(mut slurm) = Slurm::start() else { return };
    let (fresh, _alone, expected) = prepared(&[]);
    let worker = format!("worker --store {}", std::fs::canonicalize(fresh.path()).unwrap().display());
    let kill_workers =
        || Command::new("pkill").args(["-9", "-f", &worker]).status().is_ok_and(|status| status.success());
    let (mut submitters, mut workers) = (0, 0);
    for round in 0..3 {
        let mut submitter =
            on_slurm(&slurm, fresh.path(), &[]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // Until a worker computes; then it, the submitter or the node's daemon dies.
        let began = Instant::now();
        let mut hit = false;
        while !hit && submitter.try_wait().unwrap().is_none() && began.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(150 + 100 * round));
            hit = kill_workers();
        }
        workers += u32::from(hit);
        if round == 1 {
            slurm.kill_node();
            slurm.start_node();
        }
        submitters += u32::from(submitter.try_wait().unwrap().is_none());
        let _ = submitter.kill();
        submitter.wait().unwrap();
        assert_eq!(json(fresh.path(), &["fsck"])["faults"], json!([]), "round {round}");
    }
    assert!(submitters >= 1 && workers >= 1, "killed {submitters} submitters and {workers} workers");
    assert_eq!(result(&answer(&mut on_slurm(&slurm, fresh.path(), &["--keep-going"]))), result(&expected));
}

#[test]
fn what_fails_on_the_cluster_is_told_with_its_logs_last_lines() {
    let Some(slurm) = Slurm::start() else { return };
    let (fresh, _alone, expected) = prepared(&[]);
    // The images of the 10:00 experience are damaged: what hangs on them fails, the rest is computed.
    let listing = json(fresh.path(), &["ls"]);
    let experience = listing["experiences"].as_array().unwrap().iter().find(|e| e["slot"] == "10:00").unwrap();
    let id = experience["experience"].as_str().unwrap();
    let record = std::fs::read(fresh.path().join("objects").join(&id[..2]).join(id)).unwrap();
    let record: Value = serde_json::from_slice(&record).unwrap();
    let image = record["body"]["nodes"][0]["left"].as_str().unwrap();
    let path = fresh.path().join("objects").join(&image[..2]).join(image);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, b"not this image any more").unwrap();

    let output = on_slurm(&slurm, fresh.path(), &["--keep-going", "--json"]).output().unwrap();
    let said: Value = serde_json::from_slice(&output.stdout).unwrap();
    let failed = said["failed"].as_array().unwrap();
    assert_eq!(output.status.code(), Some(3), "{failed:?}");
    let of_08 = |cell: &&Value| cell["experience"] == "08:00";
    assert!(
        !failed.iter().any(|cell| of_08(&cell)) && failed.iter().any(|cell| cell["experience"] == "10:00"),
        "{failed:?}"
    );
    let reason = failed[0]["reason"].as_str().unwrap();
    assert!(reason.contains(&image[..12]) && reason.contains("the end of the log of task"), "{reason}");
    let whole = |value: &Value| value["cells"].as_array().unwrap().iter().filter(of_08).count();
    assert_eq!(whole(&said), whole(&expected));

    // Without --keep-going it is an error.
    let output = on_slurm(&slurm, fresh.path(), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));

    // Mended, the same command computes what is left.
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(result(&answer(&mut on_slurm(&slurm, fresh.path(), &[]))), result(&expected));
}

#[test]
fn without_slurm_the_command_says_what_to_do() {
    let store = store();
    field().ingest(store.path());
    let path = matrix(store.path());
    let mut command = furrow();
    command.env("PATH", "/nowhere").arg("--store").arg(store.path());
    let output = command.args(["run", text(&path), "--executor", "slurm"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("'squeue' is not on this machine") && said.contains("--executor local"), "{said}");
}
