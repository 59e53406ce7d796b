//! The same frames are one traversal, whatever the file is called, whatever label it is given and whenever its true
//! poses come.

use crate::support::command::{Quoted, quoted};
use crate::support::recordings::recordings;
use crate::support::store::Store;
use serde_json::{Value, json};

/// A recording under a name of its own in the store's folder, without its true poses beside it.
fn renamed(store: &Store, name: &str) -> Quoted {
    let file = store.file(name);
    std::fs::copy(&recordings()[0].file, &file).expect("a copy");
    file
}

fn traversals(store: &Store) -> Vec<Value> {
    store.json("ls")["traversals"].as_array().expect("traversals").clone()
}

fn labelled(file: &Quoted, route: &str, purpose: &str) -> String {
    format!("ingest {file} --site old-zoo --route {route} --slot 08:00 --purpose {purpose}")
}

#[test]
fn the_same_frames_are_known_by_their_first_label() {
    let store = Store::new();
    let first = store.json(labelled(&renamed(&store, "first.mcap"), "main", "experience"));
    assert_eq!((&first["known"], &first["differs"]), (&json!(false), &json!([])));
    let other_name = renamed(&store, "second.mcap");
    let again = store.json(labelled(&other_name, "main", "experience"));
    assert_eq!((&again["known"], &again["traversal"]), (&json!(true), &first["traversal"]));

    // Under other labels they are known as well, and the command says that it did not do as it was told. Topics that
    // are named are found out only when the frames are read.
    let [left, right] = ["left_source", "right_source"].map(|side| store.record(&first["traversal"])[side].clone());
    let topics = format!("--left {} --right {}", left.as_str().expect("a topic"), right.as_str().expect("a topic"));
    let relabelled = labelled(&other_name, "lane", "experience");
    for line in [relabelled.clone(), relabelled.replace("08:00", "10:00"), relabelled.replace("old-zoo", "zoo")] {
        let known = store.furrow(&line).json_with_code(3);
        assert_eq!((&known["known"], &known["traversal"]), (&json!(true), &first["traversal"]), "{line}");
        assert_eq!(known["label"]["route"], "main");
        let said = known["differs"][0].as_str().expect("a sentence");
        assert!(said.contains("site old-zoo, route main, 08:00, experience") && said.contains("--frames"), "{said}");
    }
    let known = store.furrow(format!("{relabelled} {topics}")).json_with_code(3);
    assert_eq!(known["traversal"], first["traversal"]);
    assert_eq!(traversals(&store).len(), 1);

    // Other frames are another traversal; so are the same ones for another purpose, and the note says so.
    store.json(format!("{relabelled} --frames odd"));
    let judged = store.json(labelled(&other_name, "main", "evaluation"));
    assert!(judged["notes"].to_string().contains("proves nothing"), "{judged}");
    assert_eq!(traversals(&store).len(), 3);
    store.assert_intact();
}

#[test]
fn true_poses_come_later_and_are_replaced() {
    let store = Store::new();
    let file = renamed(&store, "row.mcap");
    let ingest = labelled(&file, "main", "evaluation");
    let bare = store.json(&ingest);
    let truth = std::fs::read_to_string(recordings()[0].file.with_extension("groundtruth.tum")).expect("true poses");
    let good = store.write("good.tum", &truth);

    // Poses of no clock, of another one, or of none of the frames change nothing.
    let first_digit_moved = |line: &str| match line.split_once(' ') {
        Some((stamp, pose)) if !line.starts_with('#') => format!("{}000000000 {pose}\n", stamp.replace('.', "")),
        _ => format!("{line}\n"),
    };
    let nanoseconds = store.write("nanoseconds.tum", truth.lines().map(first_digit_moved).collect::<String>());
    let elsewhere = store.write("elsewhere.tum", "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");
    let id = bare["traversal"].as_str().expect("an id").to_owned();
    store.fails(format!("attach-truth {id} {nanoseconds}"), 1, &["0 of", "nanoseconds"]);
    store.fails(format!("attach-truth {id} {elsewhere}"), 1, &["0 of", "from 0"]);
    store.fails(format!("{} --ground-truth {elsewhere}", ingest.replace("main", "lane")), 3, &[]);
    assert_eq!(traversals(&store)[0]["traversal"], id);

    let attached = store.json(format!("attach-truth {id} {good}"));
    assert_eq!((&attached["supersedes"], &attached["replaced"]), (&json!(id), &json!(null)));
    assert_eq!(attached["frames"], attached["frames_with_pose"]);
    let listed = traversals(&store);
    assert_eq!((listed.len(), &listed[0]["traversal"]), (1, &attached["traversal"]));
    assert_eq!(
        (&listed[0]["ground_truth"], &listed[0]["chain"]),
        (&attached["ground_truth"], &store.record(&json!(id))["chain"])
    );
    store.fails(format!("attach-truth {id} {good}"), 1, &["latest version"]);
    let latest = attached["traversal"].as_str().expect("an id");
    store.fails(format!("attach-truth {} {good}", &id[..8]), 1, &["latest version", latest]);

    // The command that ingested it finds it, with these poses and without, and says where others are meant.
    for (line, code) in [(ingest.clone(), 0), (format!("{ingest} --ground-truth {good}"), 0)] {
        let known = store.furrow(line).json_with_code(code);
        assert_eq!((&known["known"], &known["traversal"]), (&json!(true), &attached["traversal"]));
    }
    let fewer = truth.lines().take(truth.lines().count() / 2).map(|line| format!("{line}\n")).collect::<String>();
    let fewer = store.write("fewer.tum", fewer);
    let known = store.furrow(format!("{ingest} --ground-truth {fewer}")).json_with_code(3);
    assert!(known["differs"].to_string().contains("attach-truth"), "{known}");

    // Centimetres are told by the length of the way.
    assert_eq!(attached["notes"], json!([]));
    let in_centimetres = |line: &str| {
        let fields = line.split_whitespace().enumerate();
        let scaled = fields.map(|(i, field)| match field.parse::<f64>() {
            Ok(metres) if (1..=3).contains(&i) => (metres * 100.0).to_string(),
            _ => field.to_owned(),
        });
        scaled.collect::<Vec<_>>().join(" ") + "\n"
    };
    let centimetres = truth.lines().filter(|line| !line.starts_with('#')).map(in_centimetres).collect::<String>();
    let wrong = store.json(format!("attach-truth {latest} {}", store.write("centimetres.tum", centimetres)));
    assert!(wrong["notes"][0].as_str().is_some_and(|note| note.contains("are they in metres")), "{wrong}");
    let mended = store.json(format!("attach-truth {} {good}", wrong["traversal"].as_str().expect("an id")));
    assert_eq!((&mended["traversal"], &mended["notes"]), (&attached["traversal"], &json!([])));
    assert!(!store.json(&ingest)["notes"].to_string().contains("by the true poses"));

    // Replaced, and put back: the version from before is the latest again.
    let now = attached["traversal"].as_str().expect("an id").to_owned();
    let replaced = store.json(format!("attach-truth {now} {fewer}"));
    assert_eq!(replaced["replaced"], attached["ground_truth"]);
    assert!(replaced["frames_with_pose"].as_u64() < replaced["frames"].as_u64(), "{replaced}");
    let back = store.json(format!("attach-truth {} {good}", replaced["traversal"].as_str().expect("an id")));
    assert_eq!(back["traversal"], attached["traversal"]);
    assert_eq!(traversals(&store).len(), 1);
    assert_eq!(store.json(&ingest)["traversal"], attached["traversal"]);
    store.assert_intact();
}

#[test]
fn a_site_has_clocks() {
    let store = Store::new();
    let set = store.json("site set 'row 7' --utc-offset +12:00");
    assert_eq!(set, json!({ "site": "row 7", "utc_offset_min": 720, "traversals": 0 }));
    assert_eq!(store.json("site set 'row 7' --utc-offset -03:30")["utc_offset_min"], -210);
    assert_eq!(store.furrow("site set 'row 7' --utc-offset Pacific/Auckland").output().status.code(), Some(2));
    store.json(labelled(&quoted(&*recordings()[0].file), "main", "experience"));
    let listed = store.json("site ls")["sites"][0].clone();
    // The simulated receiver knows where it is.
    assert_eq!((&listed["site"], &listed["utc_offset"]), (&json!("old-zoo"), &json!("estimated from satellite fixes")));
    store.json("site set old-zoo --utc-offset +02:00");
    let listed = store.json("site ls")["sites"][0].clone();
    assert_eq!((&listed["utc_offset"], &listed["utc_offset_min"]), (&json!("given"), &json!(120)));
}
