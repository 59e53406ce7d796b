//! Images as a set for place recognition: names with positions, the stored bytes, and the way back.

use super::{datasets, import};
use crate::support::command::quoted;
use crate::support::store::Store;
use std::collections::BTreeMap;
use std::fs;

#[test]
fn images_leave_with_their_positions_and_come_back() {
    let Some((folder, right)) = datasets() else { return };
    let store = Store::new();
    let kitti = &right["kitti-odometry"];
    let summary = import(&store, "kitti-odometry", folder.path(), kitti, "");
    let id = summary["traversal"].as_str().unwrap();
    let out = folder.path().join("vpr").join("queries");
    let line = format!("export images {id} --form vpr -o {}", quoted(&out));
    let told = store.json(&line);
    assert_eq!((&told["images"], &told["encoded"]), (&24.into(), &0.into()), "{told}");

    // Sorted as VPR-methods-evaluation sorts: the names of images.txt, each with the digest of its bytes.
    let list = fs::read_to_string(out.join("images.txt")).unwrap();
    let ids: Vec<(&str, &str)> = list.lines().map(|line| line.split_once("  ").unwrap()).collect();
    assert!(ids.windows(2).all(|pair| pair[0].1 < pair[1].1), "{list}");
    let sources: BTreeMap<String, String> = (0..24)
        .map(|i| fs::read(folder.path().join(format!("kitti/sequences/00/image_0/{i:06}.jpg"))).unwrap())
        .enumerate()
        .map(|(i, bytes)| (blake3(&bytes), format!("{i:06}")))
        .collect();
    for (id, name) in &ids {
        assert_eq!(blake3(&fs::read(out.join(name)).unwrap()), *id, "{name}");
        let fields: Vec<&str> = name.split('@').collect();
        assert_eq!((fields.len(), fields[15]), (16, ".jpg"), "{name}");
        assert_eq!(sources.get(*id).map(String::as_str), Some(fields[7]), "{name}");
        // KITTI's x is to the right and z ahead: east and north.
        let point = &kitti["points"][fields[7].parse::<usize>().unwrap()];
        for (field, axis) in [(1, 0), (2, 2)] {
            let (found, expected) = (fields[field].parse::<f64>().unwrap(), point[axis].as_f64().unwrap());
            assert!((found - expected).abs() < 0.006, "{name}: {point}");
        }
    }

    store.furrow(&line).fails(1, &["is there already"]);
    let back = Store::new();
    let labels = "--site elsewhere --route loop --slot 10:00 --purpose experience";
    let again = back.json(format!("import vpr {} {labels}", quoted(&out)));
    let (length, expected) = (again["trajectory"]["length_m"].as_f64().unwrap(), kitti["length"].as_f64().unwrap());
    assert_eq!(again["pairs"], 24);
    assert!((length - expected).abs() < 0.02 * expected, "{length} m, not {expected} m");
}

#[test]
fn an_experience_leaves_by_its_chain_where_nothing_else_tells() {
    let Some((folder, right)) = datasets() else { return };
    let store = Store::new();
    let summary = import(&store, "mono", folder.path(), &right["mono"], "--spacing-m 5");
    let out = folder.path().join("database");
    let told = store.json(format!("export images {} -o {}", summary["experience"].as_str().unwrap(), quoted(&out)));
    assert_eq!(told["images"], 12, "{told}");
    let mut norths: Vec<f64> = fs::read_dir(&out)
        .unwrap()
        .flatten()
        .map(|entry| entry.file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".jpg"))
        .map(|name| name.split('@').nth(2).unwrap().parse().unwrap())
        .collect();
    norths.sort_by(f64::total_cmp);
    assert_eq!(norths, (0..12).map(|i| 5.0 * f64::from(i)).collect::<Vec<_>>());
}

fn blake3(bytes: &[u8]) -> String {
    furrow_catalog::digest(bytes).to_string()
}
