//! The odd frames of a recording as evaluation, the even ones as experience.

use super::{ingest, street};
use crate::support::golden_data::data_folder;
use crate::support::matrix::Matrix;
use crate::support::store::Store;

#[test]
fn odd_frames_of_a_recording_are_found_among_its_even_ones() {
    let (Some((bag, _)), Some(sequence)) = (street(), data_folder("kitti_odo_seqA")) else { return };
    let store = Store::new();
    ingest(&store, &bag, "street", "experience", "even");
    ingest(&store, &bag, "street", "evaluation", "odd");
    ingest(&store, &sequence, "vocabulary", "vocabulary", "all");
    let matrix = Matrix::new("odd against even", "karlsruhe").words(6000);
    let matrix = matrix.live(&["14:00"]).experiences(&["14:00"]).write(store.path());
    let result = store.json(format!("run {matrix}"));
    let cell = &result["cells"][0];
    eprintln!("odd against even: {cell}");
    let (frames, correct) = (cell["frames"].as_f64().unwrap(), cell["correct"].as_f64().unwrap());
    assert_eq!(frames, 99.0);
    assert!(correct / frames >= 0.95, "{correct} of {frames} frames accepted and correct");
    assert!(cell["max_error_m"].as_f64().unwrap() <= 5.0, "accepted wrong by more than 5 m: {cell}");
    let page = store.file("report.html");
    store.json(format!("report {} -o {page}", result["run"].as_str().unwrap()));
    assert!(std::fs::read_to_string(&page).unwrap().contains("odd against even"));
}
