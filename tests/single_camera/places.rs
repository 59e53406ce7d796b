//! Eight places of an independent renderer. The folder comes from FURROW_DATA; where it is absent, that is said.

use super::answers::answers;
use crate::support::command::{furrow, quoted};
use crate::support::golden_data::data_folder;
use crate::support::matrix::Matrix;
use crate::support::store::Store;
use std::collections::BTreeMap;

/// `median (least-most)`.
fn spread(numbers: &[u32]) -> String {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable();
    format!("{} ({}-{})", sorted[sorted.len() / 2], sorted[0], sorted[sorted.len() - 1])
}

/// An independent renderer's eight places, 5.2 m apart, at four hours. The threshold comes from the simulated field,
/// which shares nothing with that renderer.
#[test]
fn an_independent_renderers_places_are_told_apart_by_day() {
    let Some(places) = data_folder("path_traced_places") else { return };
    let store = Store::new();
    let traversals = [
        ("0800A", "08:00", "experience"),
        ("0800B", "08:00", "evaluation"),
        ("1000B", "10:00", "evaluation"),
        ("1400B", "14:00", "evaluation"),
        ("0430B", "04:30", "evaluation"),
    ];
    for (name, slot, purpose) in traversals {
        let folder = quoted(places.join(name));
        let poses = quoted(folder.join("groundtruth.tum"));
        let ingest = format!("ingest {folder} --site orchard --route lane --slot {slot} --purpose {purpose}");
        let summary = store.json(format!("{ingest} --poses {poses}"));
        // What the summary says decides which verification is measured below.
        assert_eq!((&summary["camera"], &summary["pairs"]), (&"single".into(), &8.into()), "{summary}");
        assert_eq!((&summary["motion"], &summary["calibration_assumed"]), (&"given poses".into(), &false.into()));
    }
    let lanes = store.file("lanes.mcap");
    furrow(format!("simulate --site backsburg --slot 10:00 --route vocabulary --length 24 -o {lanes}")).text();
    store.json(format!("ingest {lanes} --site orchard --route simulated --slot 10:00 --purpose vocabulary"));

    // SeqSLAM offers all places of every frame, so that verification ranks them all.
    let matrix = Matrix::new("places", "orchard")
        .words(200)
        .vocabulary("simulated")
        .images(40)
        .key("localiser", "{ method = \"seqslam\", sequence = 1, candidates = 8 }")
        .live(&["08:00", "10:00", "14:00", "04:30"])
        .experiences(&["08:00"]);
    let result = store.json(format!("run {}", matrix.write(store.path())));
    println!("two-view verification of upright SURF against 0800A (SIFT of NOTES.md in brackets)");
    println!("live   same place            wrong place           ranked first  good  threshold");
    let sift = BTreeMap::from([
        ("08:00", ["206 (142-421)", "11 (9-88)", "8/8"]),
        ("10:00", ["126 (51-182)", "11 (9-90)", "8/8"]),
        ("14:00", ["38 (27-121)", "10 (9-48)", "8/8"]),
        ("04:30", ["11 (10-82)", "10 (9-49)", "2/8"]),
    ]);
    for cell in result["cells"].as_array().unwrap() {
        let live = cell["live"].as_str().unwrap();
        let threshold = cell["threshold_inliers"].as_u64().unwrap() as u32;
        let answers = answers(&store, cell);
        let inliers = |frame: usize, place: usize| -> u32 {
            answers[frame].iter().find(|answer| answer.0 == place).unwrap().1.unwrap()
        };
        let same: Vec<u32> = (0..8).map(|i| inliers(i, i)).collect();
        // Places two or more apart lie 10.4 m apart.
        let far =
            (0..8).flat_map(|i| (0..8).map(move |j| (i, j))).filter(|&(i, j): &(usize, usize)| i.abs_diff(j) >= 2);
        let wrong: Vec<u32> = far.map(|(i, j)| inliers(i, j)).collect();
        let first = (0..8).filter(|&i| (0..8).all(|j| j == i || inliers(i, j) < same[i])).count();
        let [sift_same, sift_wrong, sift_first] = sift[live];
        println!(
            "{live}  {:<14} [{sift_same:>13}]  {:<10} [{sift_wrong:>9}]  {first}/8 [{sift_first}]  {:>5}  {threshold}",
            spread(&same),
            spread(&wrong),
            cell["good"]
        );
        let most = wrong.iter().max().unwrap();
        assert!(*most < threshold, "at {live} a wrong place reaches {most} inliers, the threshold is {threshold}");
        assert_eq!(cell["wrong"], 0, "{cell}");
        if live != "04:30" {
            assert_eq!(first, 8, "places of {live} that rank first");
        }
    }
}
