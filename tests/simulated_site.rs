//! The whole road on the simulated field: what `make demo` does, smaller, on a machine without any recording.

use crate::support::command::quoted;
use crate::support::matrix::Matrix;
use crate::support::recordings::{ingested, ran, recordings, summaries};
use crate::support::store::Store;
use serde_json::{Value, json};
use std::path::Path;

#[test]
fn a_simulated_site_goes_from_recordings_to_a_report() {
    for summary in summaries() {
        assert!(summary["pairs"].as_u64().unwrap() > 50, "{summary}");
        assert_eq!(summary["unpaired"], json!([]), "{summary}");
    }
    let unrun = ingested();
    let planned = unrun.json(format!("plan {}", Matrix::small().write(unrun.path())));
    assert_eq!(planned["cells"].as_array().unwrap().len(), 3);
    let result = &ran().run;
    assert_eq!(result["run"], planned["run"]);
    assert_eq!(result["blocked"], json!([]));
    let sibling = &result["cells"][0];
    assert_eq!((sibling["live"].as_str(), sibling["experience"].as_str()), (Some("08:00"), Some("08:00")));
    let (frames, correct) = (sibling["frames"].as_f64().unwrap(), sibling["correct"].as_f64().unwrap());
    eprintln!("simulated 08:00 against 08:00: {sibling}");
    assert!(correct / frames > 0.5, "the same hour must be found: {sibling}");
    assert!(sibling["wrong"].as_f64().unwrap() <= 0.05 * frames, "{sibling}");

    let store = ran().store.copy();
    let again = store.json(format!("run {}", Matrix::small().write(store.path())));
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true));
    assert_eq!(again["run"], result["run"]);

    let page = store.file("report.html");
    store.text(format!("report latest -o {page}"));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("<svg") && html.contains("data:image/jpeg;base64,"));
    for address in ["src=\"http", "href=\"http", "@import", "url(http"] {
        assert!(!html.contains(address), "the page asks the network: {address}");
    }
    store.assert_intact();
}

/// The positions of a file in TUM's format.
fn positions(file: &Path) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(file).unwrap();
    let poses = text.lines().filter(|line| !line.starts_with('#'));
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().map(|v| v.parse().unwrap()).collect() };
    poses.map(numbers).map(|v| [v[1], v[2], v[3]]).collect()
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn odometry_follows_the_simulated_robot() {
    let store = ingested();
    let traversal = summaries()[0]["traversal"].as_str().unwrap();
    let tum = store.file("odometry.tum");
    store.json(format!("export trajectory {traversal} --format tum -o {tum}"));
    let truth_file = quoted(recordings()[0].file.with_extension("groundtruth.tum"));
    let (found, truth) = (positions(&tum), positions(&truth_file));
    assert_eq!(found.len(), truth.len());
    // Distances from the start need no alignment of frames.
    let from_start = |track: &[[f64; 3]]| -> Vec<f64> { track.iter().map(|p| distance(p, &track[0])).collect() };
    let length_m: f64 = truth.windows(2).map(|p| distance(&p[1], &p[0])).sum();
    let worst = from_start(&found).iter().zip(from_start(&truth)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    eprintln!("simulated robot: worst distance error {worst:.3} m over {length_m:.2} m");
    assert!(worst / length_m < 0.03, "{worst} m over {length_m} m");

    // The command says the same of the same two tracks, whether it reads the estimate from the store or from the file.
    let compare = |estimate: &str| {
        let line = format!("compare-trajectory {truth_file} {estimate} --align first --lengths 2,4");
        store.json(line)["report"].clone()
    };
    let report = compare(traversal);
    assert_eq!(report["poses"], truth.len());
    assert!(report["ape_m"]["max"].as_f64().unwrap() >= worst - 1e-6, "{report}");
    for stretch in report["lengths"].as_array().unwrap() {
        assert!(stretch["translation"].as_f64().unwrap() < 0.03, "{report}");
    }
    let exported = compare(&tum.to_string())["ape_m"]["rmse"].as_f64();
    let stored = report["ape_m"]["rmse"].as_f64().unwrap();
    assert!((stored - exported.unwrap()).abs() < 1e-6, "{stored} {exported:?}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let ids = |threads: &str| {
        let store = Store::new();
        let ingest = |line: String| store.furrow(line).env("RAYON_NUM_THREADS", threads).json()["traversal"].clone();
        let traversals: Vec<Value> = recordings().iter().map(|recording| ingest(recording.ingest())).collect();
        let run = store.json(format!("run {} -j {threads}", Matrix::small().write(store.path())));
        let mut outcomes = run["cells"].clone();
        outcomes.as_array_mut().unwrap().iter_mut().for_each(|cell| cell["cached"] = Value::Null);
        (traversals, run["run"].clone(), outcomes)
    };
    assert_eq!(ids("1"), ids("3"));
}
