//! A run is held to another, and a drop beyond the bound is an exit code.

use crate::support::matrix::Matrix;
use crate::support::recordings::ran;
use serde_json::Value;

#[test]
fn a_run_is_held_to_another() {
    let store = ran().store.copy();
    let run = |matrix: Matrix| store.json(format!("run {}", matrix.write(store.path())));
    let id = |run: &Value| run["run"].as_str().unwrap().to_owned();
    let (before, after) = (run(Matrix::small()), run(Matrix::small().threshold(100_000)));
    let (a, b) = (id(&before), id(&after));
    let compared = store.json(format!("compare {a} {b}"));
    let cells = compared["comparison"]["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 3);
    let own = &before["cells"][0];
    let share = 100.0 * own["good"].as_f64().unwrap() / own["frames"].as_f64().unwrap();
    assert!(share > 10.0, "the sibling traversal is localised: {share}");
    assert!((cells[0]["change_points"].as_f64().unwrap() + share).abs() < 1e-9);
    let code = |a: &str, b: &str, points: &str| {
        store.furrow(format!("compare {a} {b} --max-drop {points}")).output().status.code()
    };
    assert_eq!((code(&a, &b, "0"), code(&b, &a, "0")), (Some(3), Some(0)));
    assert_eq!((code(&a, &b, "100"), code(&a, &a, "0"), code(&a, &b, "nothing")), (Some(0), Some(0), Some(2)));
    // A cell that the second run lacks is no cell that held.
    let fewer = id(&run(Matrix::small().without_collectives()));
    assert_eq!((code(&a, &fewer, "100"), code(&fewer, &a, "0")), (Some(3), Some(0)));
}
