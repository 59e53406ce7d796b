//! The whole road on the simulated field: what `make demo` does, smaller, on a machine without any recording.

use crate::command::{field, json, matrix, run, store, text};

#[test]
fn a_simulated_site_goes_from_recordings_to_a_report() {
    let store = store();
    let summaries = field().ingest(store.path());
    for summary in &summaries {
        assert!(summary["pairs"].as_u64().unwrap() > 50, "{summary}");
        assert_eq!(summary["unpaired"], serde_json::json!([]), "{summary}");
    }
    let matrix = matrix(store.path());
    let planned = json(store.path(), &["plan", text(&matrix)]);
    assert_eq!(planned["cells"].as_array().unwrap().len(), 3);
    let result = json(store.path(), &["run", text(&matrix)]);
    assert_eq!(result["run"], planned["run"]);
    assert_eq!(result["blocked"], serde_json::json!([]));
    let cells = result["cells"].as_array().unwrap();
    let sibling = &cells[0];
    assert_eq!((sibling["live"].as_str(), sibling["experience"].as_str()), (Some("08:00"), Some("08:00")));
    let (frames, correct) = (sibling["frames"].as_f64().unwrap(), sibling["correct"].as_f64().unwrap());
    eprintln!("simulated 08:00 against 08:00: {sibling}");
    assert!(correct / frames > 0.5, "the same hour must be found: {sibling}");
    assert!(sibling["wrong"].as_f64().unwrap() <= 0.05 * frames, "{sibling}");

    let again = json(store.path(), &["run", text(&matrix)]);
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true));
    assert_eq!(again["run"], result["run"]);

    let page = store.path().join("report.html");
    let made = run(&["--store", text(store.path()), "report", "latest", "-o", text(&page)]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("<svg") && html.contains("data:image/jpeg;base64,"));
    for address in ["src=\"http", "href=\"http", "@import", "url(http"] {
        assert!(!html.contains(address), "the page asks the network: {address}");
    }
    assert_eq!(json(store.path(), &["fsck"])["faults"], serde_json::json!([]));
}

#[test]
fn odometry_follows_the_simulated_robot() {
    let store = store();
    let (file, route, slot, _) = &field().outings[0];
    let summary = json(
        store.path(),
        &["ingest", text(file), "--site", "old-zoo", "--route", route, "--slot", slot, "--pass", "experience"],
    );
    let tum = store.path().join("odometry.tum");
    json(
        store.path(),
        &["export", "trajectory", summary["traversal"].as_str().unwrap(), "--format", "tum", "-o", text(&tum)],
    );
    let positions = |path: &std::path::Path| -> Vec<[f64; 3]> {
        let text = std::fs::read_to_string(path).unwrap();
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        lines
            .map(|line| {
                let v: Vec<f64> = line.split_whitespace().map(|v| v.parse().unwrap()).collect();
                [v[1], v[2], v[3]]
            })
            .collect()
    };
    let (found, truth) = (positions(&tum), positions(&file.with_extension("groundtruth.tum")));
    assert_eq!(found.len(), truth.len());
    // Distances from the start need no alignment of frames.
    let from_start = |track: &[[f64; 3]]| -> Vec<f64> {
        track.iter().map(|p| (0..3).map(|i| (p[i] - track[0][i]).powi(2)).sum::<f64>().sqrt()).collect()
    };
    let length_m: f64 = truth.windows(2).map(|p| (0..3).map(|i| (p[1][i] - p[0][i]).powi(2)).sum::<f64>().sqrt()).sum();
    let worst = from_start(&found).iter().zip(from_start(&truth)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    eprintln!("simulated drive: worst distance error {worst:.3} m over {length_m:.2} m");
    assert!(worst / length_m < 0.03, "{worst} m over {length_m} m");

    // The command says the same of the same two tracks, whether it reads the estimate from the store or from the file.
    let truth_file = file.with_extension("groundtruth.tum");
    let traversal = summary["traversal"].as_str().unwrap();
    let compare = |estimate: &str| {
        let arguments = ["compare-trajectory", text(&truth_file), estimate, "--align", "first", "--lengths", "2,4"];
        json(store.path(), &arguments)["report"].clone()
    };
    let report = compare(traversal);
    assert_eq!(report["poses"], truth.len());
    assert!(report["ape_m"]["max"].as_f64().unwrap() >= worst - 1e-6, "{report}");
    for stretch in report["lengths"].as_array().unwrap() {
        assert!(stretch["translation"].as_f64().unwrap() < 0.03, "{report}");
    }
    let (stored, exported) = (report["ape_m"]["rmse"].as_f64().unwrap(), compare(text(&tum))["ape_m"]["rmse"].as_f64());
    assert!((stored - exported.unwrap()).abs() < 1e-6, "{stored} {exported:?}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let ids = |threads: &str| {
        let store = store();
        let ingested: Vec<_> = field()
            .outings
            .iter()
            .map(|(file, route, slot, purpose)| {
                let output = crate::command::furrow()
                    .env("RAYON_NUM_THREADS", threads)
                    .arg("--store")
                    .arg(store.path())
                    .args([
                        "--json",
                        "ingest",
                        text(file),
                        "--site",
                        "old-zoo",
                        "--route",
                        route,
                        "--slot",
                        slot,
                        "--pass",
                        purpose,
                    ])
                    .output()
                    .unwrap();
                let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
                summary["traversal"].clone()
            })
            .collect();
        let matrix = matrix(store.path());
        let run = json(store.path(), &["run", text(&matrix), "-j", threads]);
        let mut outcomes = run["cells"].clone();
        outcomes.as_array_mut().unwrap().iter_mut().for_each(|cell| cell["cached"] = serde_json::Value::Null);
        (ingested, run["run"].clone(), outcomes)
    };
    assert_eq!(ids("1"), ids("3"));
}
