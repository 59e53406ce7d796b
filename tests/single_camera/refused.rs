//! Folders of images that are refused, with why; and one that is not.

use crate::support::command::{Quoted, quoted};
use crate::support::store::Store;
use furrow_catalog::images::{RawImage, store_raw};
use serde_json::json;

/// A grey PNG of this size.
fn image(width: usize, height: usize, offset: usize) -> Vec<u8> {
    let data: Vec<u8> = (0..width * height).map(|i| ((i * 7 + i / width * 13 + offset) % 251) as u8).collect();
    let image = RawImage { width, height, step: width, encoding: "mono8", big_endian: false, data: &data };
    store_raw(&image).unwrap().bytes
}

#[test]
fn a_folder_that_cannot_be_a_traversal_says_why_and_leaves_nothing() {
    let store = Store::new();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, files: &[(&str, Vec<u8>)]| {
        let path = quoted(folder.path().join(name));
        std::fs::create_dir(&path).unwrap();
        files.iter().for_each(|(file, bytes)| std::fs::write(path.join(file), bytes).unwrap());
        path
    };
    let good = || image(64, 48, 1);
    let plain = write("plain", &[("a 1.png", good()), ("b.png", image(64, 48, 2)), ("c.png", image(64, 48, 3))]);
    let sizes = write("sizes", &[("0.png", good()), ("1.png", image(48, 64, 2))]);
    let torn = write("torn", &[("0.png", good()), ("1.png", good()[..good().len() * 2 / 3].to_vec())]);
    let empty = write("empty", &[("notes.txt", b"nothing".to_vec())]);
    let short = quoted(folder.path().join("short.tum"));
    std::fs::write(&short, "0 0 0 0 0 0 0 1\n").unwrap();
    let known = br#"{"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "rectified": true}"#;
    let calibrated = write("calibrated", &[("0.png", good()), ("calibration.json", known.to_vec())]);

    let place = "--site s --route r --slot 12:00 --purpose experience";
    let twofold = format!("--spacing-m 1 --poses {short}");
    let short_poses = format!("--poses {short}");
    let cases: [(&Quoted, &str, i32, &[&str]); 12] = [
        (&plain, "", 1, &["plain", "--spacing-m", "--poses"]),
        (&plain, "--spacing-m 0", 2, &["greater than 0"]),
        (&plain, "--spacing-m NaN", 2, &["greater than 0"]),
        (&plain, "--spacing-m=-3", 2, &["greater than 0"]),
        (&plain, &twofold, 2, &["cannot be used with"]),
        (&plain, "--spacing-m 1 --field-of-view 180", 2, &["between 0 and 180"]),
        (&plain, &short_poses, 1, &["short.tum", "100000000 ns", "a pose for each image"]),
        (&plain, "--poses nowhere.tum", 1, &["nowhere.tum"]),
        (&sizes, "--spacing-m 2", 1, &["1.png", "48x64", "0.png", "64x48", "one size"]),
        (&torn, "--spacing-m 2 --strict", 1, &["1.png", "damaged"]),
        (&empty, "--spacing-m 2", 1, &["empty", "JPEG, PNG, PGM or PPM images", "notes.txt"]),
        (&calibrated, "--spacing-m 1 --field-of-view 60", 1, &["calibrated", "assume no field of view"]),
    ];
    for (folder, options, code, words) in cases {
        store.fails(format!("ingest {folder} {place} {options}"), code, words);
    }
    let listing = store.json("ls");
    assert_eq!((&listing["traversals"], &listing["recordings"]), (&json!([]), &json!([])));
    assert_eq!(store.assert_intact()["objects"], 0);

    // The good folder goes in, once, whatever the images are called; another spacing is another traversal.
    let ingest = |spacing_m: u32| store.json(format!("ingest {plain} {place} --spacing-m {spacing_m}"));
    let first = ingest(2);
    assert_eq!((&first["trajectory"]["length_m"], &first["keyframes"]), (&4.0.into(), &3.into()));
    assert_eq!(ingest(2)["known"], true);
    assert_ne!(ingest(3)["traversal"], first["traversal"]);
    store.assert_intact();
}
