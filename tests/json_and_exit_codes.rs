//! What other people's scripts rely on: commands, JSON forms, exit codes.

use crate::support::command::furrow;
use crate::support::matrix::Matrix;
use crate::support::recordings::{ingested, ran, recordings, summaries};
use crate::support::store::Store;
use serde_json::{Value, json};

/// An object has all these keys.
#[track_caller]
fn has(value: &Value, wanted: &str) {
    let keys = value.as_object().expect("an object");
    let missing: Vec<&str> = wanted.split(' ').filter(|key| !keys.contains_key(*key)).collect();
    assert!(missing.is_empty(), "{missing:?} missing in {value}");
}

#[test]
fn json_has_the_promised_fields() {
    let summaries = summaries();
    has(&summaries[0], "recording traversal experience pairs unpaired trajectory keyframes");
    has(&summaries[0]["trajectory"], "frames length_m failed_steps");
    assert!(summaries[1]["experience"].is_null(), "an evaluation traversal is no experience");
    let store = ran().store.copy();
    let listing = store.json("ls");
    assert_eq!(listing["traversals"].as_array().unwrap().len(), 4);
    assert_eq!(listing["experiences"].as_array().unwrap().len(), 2);
    has(&listing["traversals"][0], "traversal site route slot pass recording");
    has(&listing["experiences"][0], "experience site route slot kind nodes");
    let fields = "key live experience codebook method frames good percent_good lost_fraction max_lost_m correct wrong \
                  cached";
    let fresh = ingested();
    for (store, ran) in [(&fresh, false), (&store, true)] {
        let planned = store.json(format!("plan {}", Matrix::small().write(store.path())));
        has(&planned, "run cells");
        has(&planned["cells"][0], fields);
        assert_eq!(planned["cells"][0]["cached"], ran);
    }
    has(&fresh.json("fsck"), "objects rows faults");
    let status = store.json("status");
    has(&status["runs"][0], "run matrix cells finished");
}

#[test]
fn the_store_is_found_by_option_variable_and_folder() {
    let store = Store::new();
    furrow("ls").env("FURROW_STORE", store.path()).text();
    furrow("ls").in_folder(&store.file("objects")).text();
    furrow(format!("ls --store {}", store.root())).text();
    let elsewhere = tempfile::tempdir().unwrap();
    furrow("ls").in_folder(elsewhere.path()).fails(1, &["furrow init"]);
}

#[test]
fn exit_codes_are_as_designed() {
    let store = Store::new();
    let code = |line: &str| furrow(line).output().status.code();
    assert_eq!(code(&format!("ls --store {}", store.root())), Some(0));
    assert_eq!(code("ls --store /nowhere/at/all"), Some(1));
    assert_eq!(code("no-such-command"), Some(2));
    assert_eq!(code("ingest x.bag --site s --route r --slot 25:00 --purpose experience"), Some(2));
    assert_eq!(code("ingest x.bag --site s --route r --slot 08:00 --purpose holiday"), Some(2));
    store.fails("ingest x.bag --site s --route r --slot 08:00 --purpose experience", 1, &[]);
}

#[test]
fn a_matrix_that_cannot_run_wholly_says_which_cells_and_why() {
    let store = ingested();
    let matrix = Matrix::new("partly", "old-zoo").words(300).images(30).threshold(40).live(&["08:00"]);
    let result = matrix.clone().experiences(&["08:00", "16:00"]).write(store.path());
    let result = store.furrow(format!("run {result}")).json_with_code(3);
    assert_eq!(result["cells"].as_array().unwrap().len(), 1);
    let reason = result["blocked"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("16:00") && reason.contains("08:00, 10:00"), "{reason}");

    let plan = |route: &str| {
        let matrix = matrix.clone().experiences(&["08:00"]).vocabulary(route).write(store.path());
        store.json(format!("plan {matrix}"))
    };
    let blocked = |route: &str, why: &str| {
        let planned = plan(route);
        assert_eq!(planned["cells"], json!([]));
        assert!(planned["blocked"][0]["reason"].as_str().unwrap().contains(why), "{planned}");
    };
    // The leakage guard: a vocabulary of the very route that is judged.
    store.json(recordings()[2].ingest_as("main", "vocabulary"));
    blocked("main", "same route");
    // And one of the same ground under another name, which only the true positions betray. The same frames would be
    // known by their route. The option has an older name.
    let elsewhere = recordings()[2].ingest_as("elsewhere", "vocabulary").replace("--purpose", "--pass");
    store.json(format!("{elsewhere} --frames even"));
    blocked("elsewhere", "true positions");
    blocked("vocabulry", "did you mean 'vocabulary'?");
}

#[test]
fn completions_and_manual_are_printed() {
    assert!(furrow("completions bash").text().contains("furrow"));
    assert!(furrow("man").text().contains(".TH furrow"));
}
