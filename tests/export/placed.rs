//! Where an experience stands when nobody knows where the robot really was.

use super::wire::Message;
use crate::support::events::accepted_inliers;
use crate::support::matrix::Matrix;
use crate::support::recordings::{ran, recordings};
use crate::support::store::Store;
use furrow_catalog::{Catalog, tables};
use furrow_model::Purpose;
use std::collections::BTreeMap;
use std::path::Path;

/// The left images of a traversal in a folder of their own, every `step`th.
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
    let catalog = Catalog::open(ran().store.path()).unwrap();
    let store = Store::new();
    for purpose in [Purpose::Experience, Purpose::Evaluation] {
        let folder = store.file(&format!("images-{purpose}"));
        image_folder(&catalog, &folder, purpose, 4);
        store
            .json(format!("ingest {folder} --site path --route main --slot 08:00 --purpose {purpose} --spacing-m 0.4"));
    }
    let vocabulary = &recordings()[3].file;
    store.json(format!("ingest {vocabulary} --site path --route vocabulary --slot 10:00 --purpose vocabulary"));
    let matrix = Matrix::new("m", "path").words(300).images(40).keyframes(0.8).threshold(15);
    let matrix = matrix.live(&["08:00"]).experiences(&["08:00"]).write(store.path());
    let run = store.json(format!("run {matrix}"));
    let cell = &run["cells"][0];
    let exported = store.file("m.mcap");
    let summary = store.json(format!("export run latest -o {exported}"));
    let topics = summary["messages"].as_object().unwrap();
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
    let travelled: Vec<f64> = lines.values().filter_map(|ends| ends.first()).map(|end| end[2]).collect();
    assert!(travelled.windows(2).all(|pair| pair[1] > pair[0] + 0.39), "{travelled:?}");
}
