//! A child has its parent's stamps and chain, and other images.

use super::{TRAIN, train};
use crate::support::recordings::ingested_for_training;
use furrow_catalog::images::decode_colour;
use serde_json::Value;

#[test]
fn a_child_has_its_parents_stamps_and_chain_and_other_images() {
    let store = ingested_for_training();
    let trained = train(&store, "vocabulary");
    assert_eq!((&trained["name"], &trained["source_images"]), (&"otf:10:00>08:00".into(), &30.into()));
    assert_eq!(train(&store, "vocabulary"), trained, "the same images give the same generator");
    let parent = store.experience("10:00");
    let id = parent["experience"].as_str().unwrap();
    let generate = format!("generate {} --generator otf:10:00>08:00 --z 0,0.5,1", &id[..12]);
    let made = store.json(&generate);
    let children = made["experiences"].as_array().unwrap();
    let mimics: Vec<&str> = children.iter().map(|child| child["mimics"].as_str().unwrap()).collect();
    assert_eq!(mimics, ["10:00", "08:00", "08:00"]);
    let before = store.record(&parent["experience"]);
    for child in children {
        let after = store.record(&child["experience"]);
        for same in ["chain", "rig", "keyframes"] {
            assert_eq!(after[same], before[same], "{same}");
        }
        assert_eq!(after["kind"]["generated"]["parent"], parent["experience"]);
        let (before, after) = (before["nodes"].as_array().unwrap(), after["nodes"].as_array().unwrap());
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(after) {
            assert_eq!(before["stamp_ns"], after["stamp_ns"]);
            let (before, after) = (store.image(before), store.image(after));
            let largest = before.rgb.iter().zip(&after.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert_eq!(largest <= 1, child["domainness"] == 0.0, "z = {}: {largest}", child["domainness"]);
        }
    }
    // All is found the second time, and on one thread; the gate was measured and is kept.
    let again = store.json(&generate);
    let painted: u64 = again["experiences"].as_array().unwrap().iter().map(|c| c["painted"].as_u64().unwrap()).sum();
    let ids = |made: &Value| -> Vec<Value> {
        made["experiences"].as_array().unwrap().iter().map(|child| child["experience"].clone()).collect()
    };
    assert_eq!((painted, ids(&again)), (0, ids(&made)));
    let shown = store.json("generator show otf:10:00>08:00");
    assert_eq!(shown["gates"][0]["curve"].as_array().unwrap().len(), 3);
    assert!(shown["gates"][0]["switch"]["kappa"].as_f64().unwrap() < 4.0, "{shown}");
    store.assert_intact();
    let sheet = store.file("sheet.jpg");
    store.json(format!("generator show otf:10:00>08:00 --sheet {sheet}"));
    let sheet = decode_colour(&std::fs::read(sheet).unwrap(), None).unwrap();
    assert!(sheet.width > 1200 && sheet.height > 1200, "{} x {}", sheet.width, sheet.height);

    let child = children[1]["experience"].as_str().unwrap();
    store.fails(format!("generate {child} --generator identity --z 1"), 1, &["grandchildren", "recorded"]);
    let misspelt = format!("generate {id} --generator otf:10:00>8:00 --z 1");
    store.fails(misspelt, 1, &["did you mean 'otf:10:00>08:00'"]);
    store.fails(format!("generate {id} --generator noise:3 --z 3"), 1, &["-0.5", "2"]);
    store.fails(format!("generate {id} --generator noise:3 --z 1,2 --mimics 10:00"), 2, &["--mimics"]);
    store.fails(TRAIN.replace("08:00", "16:00"), 1, &["16:00", "08:00, 10:00"]);
}
