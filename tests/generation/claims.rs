//! What a contrast may name, and what is said where it names something else or leaves out the placebo.

use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use serde_json::{Value, json};

/// Children of 10:00 beside recorded experiences; nothing was recorded at 16:00.
fn matrix(more: &str) -> Matrix {
    let generated = "{ parent = \"10:00\", generator = \"invariant\", domainness = [0.5, 1.0] }";
    Matrix::new("c", "old-zoo")
        .words(400)
        .live(&["08:00"])
        .axis("experience", &format!("[\"08:00\", \"10:00\", \"16:00\", {generated}]"))
        .collective("children", "generated", more)
}

#[test]
fn contrasts_that_name_nothing_are_refused_and_claims_without_a_placebo_are_named() {
    let store = ingested();
    // What is set against what; the line that is wrong, by its text; what is said.
    let refused = [
        (("childen", "parent"), "of = \"childen\"", "did you mean 'children'"),
        (("children", "11:00"), "over", "did you mean '10:00'"),
        (("children", "placebo"), "over", "placebo = true"),
        (("10:00", "parent"), "over", "none of it is generated"),
        (("children", "mimicked"), "over", "each generated"),
        (("10:00", "10:00"), "over", "itself"),
        (("10:00 as 10:00", "10:00"), "of = \"10:00 as", "write one of them out"),
    ];
    for ((of, over), wrong, word) in refused {
        let asked = matrix("").contrast(of, over);
        let line = format!("line {}", asked.line_of(wrong));
        store.fails(format!("plan {}", asked.write(store.path())), 1, &[&line, word]);
    }
    // The plan is printed whatever its exit code: 16:00 is blocked.
    let plan = |asked: Matrix| -> Value {
        let output = store.furrow(format!("plan {} --json", asked.write(store.path()))).output();
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let warned = |plan: &Value, word: &str| {
        plan["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(word))
    };
    let bare = plan(matrix("").contrast("children", "parent"));
    assert!(warned(&bare, "'children' is set against '10:00' and against no placebo"), "{bare}");
    let beside = plan(matrix("placebo = true").contrast("children", "parent").contrast("children", "placebo"));
    assert_eq!(beside["warnings"], json!([]));
    assert_eq!(beside["contrasts"][1]["over"], "children (placebo)");
    // What the axis names and the store lacks is no error: it is said, and the rest goes on.
    let absent = plan(matrix("").contrast("10:00", "16:00"));
    assert!(warned(&absent, "no experience traversal at 16:00"), "{absent}");
    // A mixed collective keeps its recorded members where placebos take the place of the generated ones.
    let mixed = matrix("placebo = true").collective("mixed", "10:00 and generated", "placebo = true");
    let mixed = plan(mixed.contrast("mixed", "placebo"));
    assert_eq!(mixed["contrasts"][0]["over"], "mixed (placebo)", "{mixed}");
}
