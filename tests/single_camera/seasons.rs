//! A park in autumn and in snow. Folders come from FURROW_DATA; what is absent is skipped and said so.

use super::answers::{Ranked, answers};
use crate::support::command::quoted;
use crate::support::golden_data::data_folder;
use crate::support::store::Store;
use furrow_runner::evaluate::recall_at;

/// Recall of answers where neighbouring places count as right, too, as NOTES.md of the recordings allows.
fn recall(answers: &[Ranked]) -> [f64; 2] {
    let right = |(frame, ranked): (usize, &Ranked)| {
        ranked.iter().position(|answer| answer.0.abs_diff(frame) <= 1).map(|rank| rank as u32)
    };
    let ranks: Vec<Option<u32>> = answers.iter().enumerate().map(right).collect();
    [1, 5].map(|k| recall_at(k, &ranks).unwrap())
}

/// Autumn mapped, snow live. The baselines are NOTES.md's, on the route's 101 places; here are its first 59.
#[test]
fn snow_is_localised_in_autumn_better_than_by_the_baselines() {
    let (Some(seasons), Some(street)) = (data_folder("stromovka_2season_traverse"), data_folder("kitti_odo_seqA"))
    else {
        return;
    };
    let store = Store::new();
    let park = |season: &str, slot: &str, purpose: &str| {
        let folder = quoted(seasons.join(season));
        let place = format!("--site stromovka --route park --slot {slot} --purpose {purpose}");
        store.json(format!("ingest {folder} {place} --spacing-m 5"))
    };
    let mapped = park("autumn", "10:00", "experience");
    park("winter", "12:00", "evaluation");
    assert_eq!((&mapped["keyframes"], &mapped["motion"]), (&59.into(), &"given spacing of 5 m".into()));
    assert_eq!((&mapped["camera"], &mapped["calibration_assumed"]), (&"single".into(), &true.into()));
    let street = quoted(street);
    store.json(format!("ingest {street} --site stromovka --route street --slot 12:00 --purpose vocabulary"));

    let committed = include_str!("../../runner/matrices/stromovka.toml");
    let line = committed.lines().find(|line| line.starts_with("localiser")).unwrap();
    let methods = [
        ("SeqSLAM, shifted (the matrix file)", line),
        ("SeqSLAM, not shifted", "localiser = { method = \"seqslam\", sequence = 10, candidates = 5 }"),
        ("single image, shifted", "localiser = { method = \"seqslam\", sequence = 1, shift = 0.125, candidates = 5 }"),
        ("FAB-MAP 2.0, words of a street", "localiser = { method = \"fabmap2\", candidates = 5 }"),
    ];
    println!("{:<36} R@1    R@5    R@1 of the candidate with most inliers", "59 places, one neighbour allowed");
    let measured = methods.map(|(name, localiser)| {
        // Recall needs no threshold, and to calibrate one would take longer than all else here.
        let uncalibrated = format!("{localiser}\nverification = {{ threshold = 12 }}");
        let matrix = store.write("matrix.toml", committed.replace(line, &uncalibrated));
        let result = store.json(format!("run {matrix}"));
        let answers = answers(&store, &result["cells"][0]);
        assert_eq!(answers.len(), 59);
        let [first, fifth] = recall(&answers);
        let mut verified = answers.clone();
        verified.iter_mut().for_each(|ranked| ranked.sort_by_key(|answer| std::cmp::Reverse(answer.1)));
        let [chosen, _] = recall(&verified);
        println!("{name:<36} {first:.3}  {fifth:.3}  {chosen:.3}");
        [first, fifth]
    });
    println!("NOTES.md, 101 places: SAD 0.17 0.32; SIFT 0.12 0.26; SeqSLAM-like 0.15 0.40");
    let [first, fifth] = measured[0];
    assert!(first > 0.17 && fifth > 0.40, "R@1 {first}, R@5 {fifth}");
}
