//! Where an experience stands when nobody knows where the robot really was.

use super::Run;
use super::wire::Message;
use crate::command::{field, json, store, text};
use crate::evaluation::accepted_inliers;
use furrow_catalog::{Catalog, tables};
use furrow_model::Purpose;
use std::collections::BTreeMap;
use std::path::Path;

/// The left images of a pass in a folder of their own, every `step`th.
fn image_folder(catalog: &Catalog, folder: &Path, purpose: Purpose, step: usize) {
    std::fs::create_dir(folder).unwrap();
    let mut rows = catalog.traversals().unwrap().into_iter();
    let row = rows.find(|row| row.purpose == purpose && row.slot.to_string() == "08:00").unwrap();
    let frames = catalog.objects().read(catalog.traversal(row.id).unwrap().frames).unwrap();
    for (i, frame) in tables::frames_from_parquet(frames).unwrap().iter().step_by(step).enumerate() {
        std::fs::write(folder.join(format!("{i:06}.png")), catalog.objects().read(frame.left).unwrap()).unwrap();
    }
}

#[test]
fn without_a_ground_truth_an_experience_stands_where_its_best_localisation_says() {
    let catalog = Catalog::open(Run::made().store.path()).unwrap();
    let store = store();
    let ingest = |file: &Path, route: &str, slot: &str, purpose: &str, more: &[&str]| {
        let place = ["ingest", text(file), "--site", "path", "--route", route, "--slot", slot, "--pass", purpose];
        json(store.path(), &[&place[..], more].concat());
    };
    for purpose in [Purpose::Experience, Purpose::Evaluation] {
        let folder = store.path().join(format!("images-{purpose}"));
        image_folder(&catalog, &folder, purpose, 4);
        ingest(&folder, "main", "08:00", &purpose.to_string(), &["--spacing-m", "0.4"]);
    }
    ingest(&field().outings[3].0, "vocabulary", "10:00", "vocabulary", &[]);
    let file = store.path().join("m.toml");
    let matrix = "name = \"m\"\nsite = \"path\"\ncodebook = { words = 300, route = \"vocabulary\", images = 40 }\n\
        keyframes = { distance_m = 0.8, yaw_rad = 0.2536 }\nverification = { threshold = 15 }\n[axes]\n\
        live = [\"08:00\"]\nexperience = [\"08:00\"]\n";
    std::fs::write(&file, matrix).unwrap();
    let run = json(store.path(), &["run", text(&file)]);
    let cell = &run["cells"][0];
    let exported = store.path().join("m.mcap");
    let told = json(store.path(), &["export", "run", "latest", "-o", text(&exported)]);
    let topics = told["messages"].as_object().unwrap();
    assert!(topics.keys().all(|topic| !topic.starts_with("/ground_truth")), "{topics:?}");

    let accepted = accepted_inliers(store.path(), cell);
    let most = *accepted.values().max().expect("the same road at the same hour is localised");
    let best = accepted.iter().find(|(_, inliers)| **inliers == most).map(|(stamp, _)| *stamp).unwrap();
    let bytes = std::fs::read(&exported).unwrap();
    let mut lines = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let read = Message::parse(&message.data);
        match message.channel.topic.as_str() {
            "/tf" => {
                let parent = |child: &str| {
                    let mut transforms = read.messages(1).into_iter();
                    transforms.find(|one| one.text(3) == child).map(|one| one.text(2))
                };
                assert_eq!(parent("experience_1_odometry").as_deref(), Some("live_odometry"));
                assert_eq!(parent("live_odometry"), None);
            }
            // SceneUpdate has entities 2; an entity lines 11; a line points 5.
            "/localisation/scene" => {
                let entities = read.messages(2).into_iter();
                let ends = entities.flat_map(|entity| entity.messages(11)).flat_map(|line| line.messages(5));
                let ends = ends.map(|end| [1, 2, 3].map(|axis| end.double(axis).unwrap_or(0.0)));
                lines.insert(message.log_time as i64, ends.collect::<Vec<_>>());
            }
            _ => {}
        }
    }
    let [live, node] = lines[&best].as_slice() else { panic!("a line has two ends: {:?}", lines[&best]) };
    assert!(live.iter().zip(node).all(|(a, b)| (a - b).abs() < 1e-9), "{live:?} and {node:?} are one place");
    // Images lie 0.4 m apart along z and nothing turns them.
    let driven: Vec<f64> = lines.values().filter_map(|ends| ends.first()).map(|end| end[2]).collect();
    assert!(driven.windows(2).all(|pair| pair[1] > pair[0] + 0.39), "{driven:?}");
}
