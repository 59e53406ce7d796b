//! Other place recognisers join the same matrix: SeqSLAM, and descriptors of a program of the user's own.

use crate::support::golden_data::files_below;
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use furrow_catalog::images::decode_grey;
use serde_json::{Value, json};
use std::path::Path;

/// The ids and thumbnails of all images of a store, as a user's program would find them: PNG files, named by their
/// digests.
fn thumbnails(store: &Path) -> Vec<(String, Vec<f32>)> {
    let files = files_below(&store.join("objects"));
    let images = files.iter().filter_map(|file| {
        let bytes = std::fs::read(file).ok()?;
        let image = bytes.starts_with(b"\x89PNG").then(|| decode_grey(&bytes, None).ok())??;
        let cells = (0..9 * 16).map(|cell| {
            let (row, column) = (cell / 16 * 40, cell % 16 * 40);
            let pixels = (row..row + 40).flat_map(|v| image.row(v)[column..column + 40].iter());
            pixels.map(|&pixel| f32::from(pixel)).sum::<f32>() / 1600.0
        });
        let cells: Vec<f32> = cells.collect();
        let mean = cells.iter().sum::<f32>() / cells.len() as f32;
        Some((file.file_name()?.to_string_lossy().into_owned(), cells.iter().map(|cell| cell - mean).collect()))
    });
    images.collect()
}

/// Writes an array as `numpy.save` does, and the ids beside it.
fn write_npy(path: &Path, rows: &[(String, Vec<f32>)]) {
    let mut header =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", rows.len(), rows[0].1.len());
    while (11 + header.len()) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = (header.len() as u16).to_le_bytes();
    let numbers = rows.iter().flat_map(|(_, row)| row.iter().flat_map(|number| number.to_le_bytes()));
    let bytes: Vec<u8> =
        b"\x93NUMPY\x01\x00".iter().copied().chain(length).chain(header.bytes()).chain(numbers).collect();
    std::fs::write(path, bytes).unwrap();
    std::fs::write(path.with_extension("txt"), rows.iter().map(|(id, _)| format!("{id}\n")).collect::<String>())
        .unwrap();
}

fn keys(plan: &Value) -> Vec<String> {
    plan["cells"].as_array().unwrap().iter().map(|cell| cell["key"].as_str().unwrap().to_owned()).collect()
}

/// The cell of 08:00 against 08:00 must have found right places and no wrong one.
fn judged(result: &Value, method: &str) {
    let cell = &result["cells"][0];
    let count = |name: &str| cell[name].as_u64().unwrap();
    assert_eq!(cell["method"], method, "{cell}");
    assert!(2 * count("good") > count("frames") && count("wrong") == 0, "{cell}");
}

#[test]
fn seqslam_and_external_descriptors_localise_in_the_same_matrix() {
    let store = ingested();
    let plan = |matrix: &Matrix| store.json(format!("plan {}", matrix.write(store.path())));
    let run = |matrix: &Matrix| store.json(format!("run {}", matrix.write(store.path())));
    let by_fabmap = keys(&plan(&Matrix::small()));
    let result = run(&Matrix::small().key("localiser", "{ method = \"seqslam\" }"));
    judged(&result, "seqslam");

    let file = store.file("thumbnails.npy");
    let mut rows = thumbnails(store.path());
    write_npy(&file, &rows);
    let external = "{ method = \"external\", descriptors = \"thumbnails.npy\", metric = \"cosine\" }";
    let external = Matrix::small().key("localiser", external);
    let by_thumbnails = keys(&plan(&external));
    judged(&run(&external), "external");
    assert!(by_thumbnails.iter().all(|key| !by_fabmap.contains(key) && !keys(&result).contains(key)));

    // Other descriptors are another question; too few are said before anything is computed.
    rows[0].1[0] += 1.0;
    write_npy(&file, &rows);
    let by_others = keys(&plan(&external));
    assert!(by_others.iter().all(|key| !by_thumbnails.contains(key)), "{by_others:?}");
    write_npy(&file, &rows[..2]);
    let planned = plan(&external);
    let reason = planned["blocked"][0]["reason"].as_str().unwrap();
    assert!(planned["cells"] == json!([]) && reason.contains("no descriptor for"), "{planned}");
}
