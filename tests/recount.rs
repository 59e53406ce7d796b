//! The numbers of a cell, counted again from its table of events, and the policies of a collective beside each other.

use crate::support::command::quoted;
use crate::support::events::{Row, accepted, rows_by_frame};
use crate::support::matrix::Matrix;
use crate::support::recordings::recordings;
use crate::support::store::Store;
use serde_json::{Value, json};

/// The rows of each live frame.
fn events(store: &Store, cell: &Value) -> Vec<Vec<Row>> {
    rows_by_frame(store.path(), cell).into_values().collect()
}

/// Frames for which some condition holds.
fn frames(frames: &[Vec<Row>], holds: impl Fn(&[Row]) -> bool) -> u64 {
    frames.iter().filter(|rows| holds(rows)).count() as u64
}

/// Counts a cell's numbers again, the long way. The traversal stays where its experiences were, so every frame has a
/// mapped place.
fn recount(cell: &Value, events: &[Vec<Row>]) {
    let (evaluation, truth) = (&cell["evaluation"], &cell["evaluation"]["ground_truth"]);
    let n = events.len();
    assert_eq!(evaluation["frames"], n, "{cell}");
    assert_eq!(evaluation["good"], frames(events, |rows| accepted(rows).is_some()));
    assert_eq!(evaluation["returned"], frames(events, |rows| rows.iter().any(|row| row.inliers.is_some())));
    let judged = |right| frames(events, |rows| accepted(rows).is_some_and(|row| row.correct == Some(right)));
    assert_eq!((&truth["correct"], &truth["wrong"]), (&judged(true).into(), &judged(false).into()));
    assert_eq!(truth["mapped"], n);
    let share = |count: u64| Value::from(count as f64 / n as f64);
    let good = evaluation["good"].as_u64().unwrap();
    assert_eq!(evaluation["percent_of_frames"], Value::from(100.0 * good as f64 / n as f64));
    recount_curves(truth, events);
    let mut names: Vec<&str> = events.iter().flatten().map(|row| row.experience.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let collective = names.len() > 1;
    for k in [1, 5, 10, 20] {
        // The hub of a collective ranks by inliers: a rank by likelihood over all its members says nothing of it.
        if collective {
            assert_eq!(truth[format!("recall_at_{k}")], Value::Null);
            continue;
        }
        let among_first = frames(events, |rows| {
            let right = rows.iter().filter(|row| row.correct == Some(true));
            // Right where fewer than k hypotheses are likelier.
            let likelier = |one: &Row| rows.iter().filter(|row| row.log_likelihood > one.log_likelihood).count();
            right.map(likelier).min().is_some_and(|likelier| likelier < k)
        });
        assert_eq!(truth[format!("recall_at_{k}")], share(among_first), "recall@{k}");
    }
    let best = |rows: &[Row]| {
        let verified = rows.iter().filter(|row| row.inliers.is_some());
        let more =
            |a: &&Row, b: &&Row| a.inliers.cmp(&b.inliers).then_with(|| a.log_likelihood.total_cmp(&b.log_likelihood));
        verified.max_by(more).map(|row| (row.inliers.unwrap(), row.correct == Some(true)))
    };
    assert_eq!(truth["recall_of_answers"], share(frames(events, |rows| best(rows).is_some_and(|(_, right)| right))));
    // The least count that lets no wrong answer in.
    let highest_wrong =
        events.iter().filter_map(|rows| best(rows)).filter(|(_, right)| !right).map(|best| best.0).max();
    let above = frames(events, |rows| best(rows).is_some_and(|(inliers, _)| Some(inliers) > highest_wrong));
    assert_eq!(truth["recall_at_full_precision"], share(above));
    for point in truth["precision_recall"].as_array().unwrap() {
        let limit = point["inliers"].as_u64().unwrap() as u32;
        let over = frames(events, |rows| best(rows).is_some_and(|(inliers, _)| inliers >= limit));
        let right = frames(events, |rows| best(rows).is_some_and(|(inliers, right)| inliers >= limit && right));
        assert!((point["precision"].as_f64().unwrap() - right as f64 / over as f64).abs() < 1e-12, "{point}");
        assert!((point["recall"].as_f64().unwrap() - right as f64 / n as f64).abs() < 1e-12, "{point}");
    }
    assert_eq!(evaluation["good_interval"], Value::Null, "a drive of {n} frames is too short for an interval");
}

/// Recall over the distance that is tolerated, and the share of the stretches of 10 m that reach a recall.
fn recount_curves(truth: &Value, events: &[Vec<Row>]) {
    for point in truth["recall_within"].as_array().unwrap() {
        let metres = point["metres"].as_f64().unwrap();
        let near = frames(events, |rows| accepted(rows).is_some_and(|row| row.error_m.unwrap() <= metres));
        assert_eq!(point["recall"], Value::from(near as f64 / events.len() as f64), "{point}");
    }
    let start_m = events[0][0].travelled_m;
    let last = ((events[events.len() - 1][0].travelled_m - start_m) / 10.0).floor() as u32;
    let in_stretch = |stretch: u32| {
        let frames =
            events.iter().filter(|rows| ((rows[0].travelled_m - start_m) / 10.0).floor() == f64::from(stretch));
        let right: Vec<bool> = frames.map(|rows| accepted(rows).is_some_and(|row| row.correct == Some(true))).collect();
        right.iter().filter(|right| **right).count() as f64 / right.len() as f64
    };
    let recalls: Vec<f64> = (0..=last).map(in_stretch).filter(|recall| recall.is_finite()).collect();
    for point in truth["route_recalled"].as_array().unwrap() {
        let wanted = point["recall"].as_f64().unwrap();
        let reached = recalls.iter().filter(|recall| **recall >= wanted).count();
        assert_eq!(point["share"], Value::from(reached as f64 / recalls.len() as f64), "{point}");
    }
}

const POLICIES: [&str; 5] = ["\"all\"", "{ slot = 1 }", "{ similar = 1 }", "{ agree = 2 }", "\"oracle\""];

#[test]
fn policies_stand_beside_each_other_and_their_numbers_are_counts() {
    let store = Store::new();
    for recording in recordings() {
        // The truth lies beside each recording.
        let truth = quoted(recording.file.with_extension("groundtruth.tum"));
        store.json(format!("{} --ground-truth {truth}", recording.ingest()));
    }
    // Low enough that some answers are wrong, so that something is counted on both sides.
    let matrix = POLICIES.iter().fold(Matrix::small().threshold(12), |matrix, policy| {
        let name = policy.replace(['"', '{', '}', '='], "");
        matrix.collective(&format!("by {}", name.trim()), "recorded", &format!("policy = {policy}"))
    });
    let result = store.json(format!("run {}", matrix.write(store.path())));
    let cells = result["cells"].as_array().unwrap();
    assert_eq!(result["blocked"], json!([]));
    let tables: Vec<Vec<Vec<Row>>> = cells.iter().map(|cell| events(&store, cell)).collect();
    for (cell, table) in cells.iter().zip(&tables) {
        recount(cell, table);
    }
    let named = |name: &str| cells.iter().position(|cell| cell["experience"] == name).unwrap();
    let [all, slot, similar, agree, oracle] =
        ["by all", "by slot  1", "by similar  1", "by agree  2", "by oracle"].map(named);
    assert_eq!(cells[agree]["policy"], "agree 2");
    // One experience is asked; by slot it is the one of the live traversal's own hour.
    let asked = |rows: &[Row]| {
        let mut names: Vec<&str> =
            rows.iter().filter(|row| row.inliers.is_some()).map(|row| row.experience.as_str()).collect();
        names.dedup();
        names.join(" ")
    };
    let own = named("08:00");
    let own_id = tables[own][0][0].experience.clone();
    assert!(tables[slot].iter().all(|rows| ["", own_id.as_str()].contains(&asked(rows).as_str())));
    assert_eq!(cells[slot]["good"], cells[own]["good"]);
    assert!(tables[similar].iter().all(|rows| !asked(rows).contains(' ')));
    // Two agree only where both reach the threshold.
    let both = frames(&tables[all], |rows| {
        let reaches = |name: &str| rows.iter().any(|row| row.experience == name && row.inliers >= Some(12));
        reaches(&own_id) && rows.iter().any(|row| row.experience != own_id && row.inliers >= Some(12))
    });
    assert_eq!(cells[agree]["good"], both);
    assert!(both > 0 && both < cells[all]["good"].as_u64().unwrap(), "{both}");
    // The oracle is never wrong, and right wherever some experience was.
    let right_exists =
        frames(&tables[all], |rows| rows.iter().any(|row| row.inliers >= Some(12) && row.correct == Some(true)));
    assert_eq!((&cells[oracle]["wrong"], &cells[oracle]["correct"]), (&0.into(), &right_exists.into()));
}
