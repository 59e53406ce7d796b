//! Axes cross, rules choose, filters leave out.

use super::of_cells;
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use serde_json::json;
use std::collections::BTreeSet;

#[test]
fn axes_cross_and_rules_choose() {
    let store = ingested();
    let plan = |matrix: &Matrix| store.json(format!("plan {}", matrix.write(store.path())));
    let crossed = Matrix::small()
        .without_words()
        .experiences(&["recorded:*"])
        .axis("threshold", "[30, 40]")
        .axis("words", "[200, 300]")
        .axis("keyframes", "[{ distance_m = 1.0, yaw_rad = 0.2536 }, { distance_m = 2.0, yaw_rad = 0.2536 }]")
        .axis("policy", "[\"all\", { agree = 2 }]");
    let planned = plan(&crossed);
    // 2 experiences and a collective by 2 policies, under 2 x 2 x 2 settings.
    assert_eq!(planned["cells"].as_array().unwrap().len(), 4 * 8, "{planned}");
    assert_eq!(planned["blocked"], json!([]));
    let settings: BTreeSet<&str> = of_cells(&planned, "setting").into_iter().collect();
    assert_eq!(settings.len(), 8);
    assert!(settings.contains("200 words, keyframes 2 m 0.2536 rad, threshold 30"), "{settings:?}");
    assert!(of_cells(&planned, "experience").contains(&"both (agree 2)"));

    let ruled = crossed
        .table("[[exclude]]\nwords = 300\nthreshold = 30")
        .table("[[exclude]]\nexperience = \"both*\"\nkeyframes = [1.0]")
        .table("[[include]]\nexperience = [\"10:00\", \"both*\"]");
    let planned = plan(&ruled);
    // Of the 8 settings 6 are left; 10:00 in all of them, the collective's two policies in the 3 with keyframes 2 m
    // apart.
    assert_eq!(planned["cells"].as_array().unwrap().len(), 6 + 2 * 3);
    let matrix = ruled.write(store.path());
    let only = "--only words=200,experience=10:00 --only 'experience=both (all)'";
    assert_eq!(store.json(format!("plan {matrix} {only}"))["cells"].as_array().unwrap().len(), 4 + 3);
    store.fails(format!("plan {matrix} --only words=201"), 2, &[]);
    assert_eq!(planned["warnings"], json!([]), "every rule applies to some cell");

    // A rule that applies to nothing is pointed out; a filter leaves out what is blocked elsewhere.
    let misspelt = Matrix::small().experiences(&["08:00", "10:00", "14:00"]);
    let misspelt = misspelt.table("[[exclude]]\nexperience = \"08.00\"");
    let planned = plan(&misspelt);
    let warnings = planned["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w.as_str().unwrap().contains("experience=08.00")), "{warnings:?}");
    assert_eq!(planned["blocked"].as_array().unwrap().len(), 1);
    let filtered = store.json(format!("plan {} --only experience=10:00", misspelt.write(store.path())));
    assert_eq!((filtered["cells"].as_array().unwrap().len(), &filtered["blocked"]), (1, &json!([])));

    // Traversals by number and day; one that is not there is told from those that are.
    let entries = [
        "{ slot = \"08:00\", pass = 1 }",
        "{ slot = \"10:00\", date = \"2026-01-15\" }",
        "{ slot = \"08:00\", pass = 2 }",
    ];
    let numbered = Matrix::small().without_collectives().axis("experience", &format!("[{}]", entries.join(", ")));
    let planned = plan(&numbered);
    assert_eq!(of_cells(&planned, "experience"), ["08:00 pass 1", "10:00 on 2026-01-15"]);
    let reason = planned["blocked"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("08:00 pass 2") && reason.contains("number 1 on 2026-01-15"), "{reason}");
}
