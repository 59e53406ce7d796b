//! The pages show what the store holds, and not a byte of it changes.

use super::shown::{frames_of, shown};
use crate::support::http::Served;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Every file of a folder by its path, with its digest.
fn contents(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    let mut todo = vec![folder.to_owned()];
    while let Some(folder) = todo.pop() {
        for entry in std::fs::read_dir(&folder).unwrap().flatten() {
            match entry.file_type().unwrap().is_dir() {
                true => todo.push(entry.path()),
                false => {
                    let bytes = std::fs::read(entry.path()).unwrap();
                    found.insert(entry.path(), furrow_catalog::digest(&bytes).to_string());
                }
            }
        }
    }
    found
}

#[test]
fn pages_show_what_the_store_holds_and_change_no_byte_of_it() {
    let shown = shown();
    let before = contents(shown.store.path());
    let served = Served::start(&shown.store);
    let start = served.page("/");
    for traversal in shown.traversals() {
        let id = traversal["traversal"].as_str().unwrap();
        assert!(start.contains(&format!("/traversal/{id}\"")), "{id} is not on the first page");
        let page = served.page(&format!("/traversal/{id}"));
        assert!(page.contains(traversal["recording"].as_str().unwrap()), "the recording's digest");
        let track = served.json(&format!("/traversal/{id}/track"));
        assert_eq!(track["at"].as_array().unwrap().len() as u64, frames_of(traversal));
        let travelled = track["travelled_m"].as_array().unwrap().last().unwrap().as_f64().unwrap();
        assert!((travelled - traversal["counts"]["length_m"].as_f64().unwrap()).abs() < 0.001, "{travelled}");
        for side in ["left", "right"] {
            let picture = served.get(&format!("/traversal/{id}/frame/0/{side}.jpg"));
            assert!(picture.status == 200 && picture.body.starts_with(&[0xff, 0xd8]), "{}", picture.text());
        }
    }
    let live = shown.traversal("08:00", "evaluation");
    let points = served.json(&format!("/traversal/{live}/frame/7/keypoints"))["keypoints"].as_array().unwrap().len();
    assert!(points > 50, "{points} keypoints");
    let before_it = served.json(&format!("/traversal/{live}/frame/7/before"));
    let (inliers, matches) =
        (before_it["lines"].as_array().unwrap().len() as u64, before_it["matches"].as_u64().unwrap());
    assert!(inliers > 30 && inliers <= matches, "{inliers} of {matches} to a keyframe just before");
    assert_eq!(
        served.get(&format!("/traversal/{live}/frame/0/before")).status,
        404,
        "nothing is before the first frame"
    );

    let run = served.page(&format!("/run/{}", shown.run()));
    let cells = shown.run["cells"].as_array().unwrap();
    assert_eq!(run.matches(">watch</a>").count(), cells.len());
    for cell in cells {
        let key = cell["key"].as_str().unwrap();
        let answers = served.json(&format!("/traversal/{live}/answers/{key}"))["answers"].as_array().unwrap().clone();
        let accepted = answers.iter().filter(|answer| answer["accepted"] == true).count() as u64;
        assert_eq!(Some(accepted), cell["good"].as_u64(), "good localisations of {key}");
        assert!(run.contains(&format!("/traversal/{live}#{key}")), "{key} leads to the player");
    }
    assert!(served.page(&format!("/run/{}/report", shown.run())).contains("furrow report"));
    assert!(served.page("/runs").contains(shown.run()));

    let family = served.json(&format!("/experience/{}/family", shown.parent));
    let z: Vec<f64> = family["family"]["generators"][0]["members"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| m["z"].as_f64().unwrap())
        .collect();
    assert_eq!(z, [0.5, 1.0]);
    assert_eq!(shown.children().len(), 2);
    assert!(served.page(&format!("/experience/{}", shown.parent)).contains("gamma:0.8"));
    assert!(start.contains("&lt;b&gt;kept.html") && !start.contains("<b>kept"));
    let kept = start.split("\"/reports/").nth(1).unwrap()[..12].to_owned();
    assert!(served.get(&format!("/reports/{kept}")).head.contains("sandbox"));

    assert_eq!(contents(shown.store.path()), before, "while it is served");
    assert_eq!(served.interrupt(), Some(0));
    assert_eq!(contents(shown.store.path()), before, "afterwards");
}
