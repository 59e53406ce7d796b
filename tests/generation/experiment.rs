//! A matrix generates its experiences and sets placebos beside the collective.

use super::train;
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested_for_training;
use serde_json::{Value, json};

const CHILDREN: [&str; 2] = ["10:00 as 08:00 (otf:10:00>08:00 z 0.5)", "10:00 as 08:00 (otf:10:00>08:00 z 1)"];

fn labels(run: &Value) -> Vec<&str> {
    run["cells"].as_array().unwrap().iter().map(|cell| cell["experience"].as_str().unwrap()).collect()
}

#[test]
fn a_matrix_generates_and_sets_placebos_beside_the_collective() {
    let store = ingested_for_training();
    train(&store, "vocabulary");
    let generated = "{ parent = \"10:00\", generator = \"otf:10:00>08:00\", domainness = [0.5, 1.0] }";
    let matrix = Matrix::small()
        .words(400)
        .images(40)
        .axis("experience", &format!("[\"10:00\", {generated}]"))
        .without_collectives()
        .collective("children", "10:00 generated", "placebo = true")
        .contrast("each generated", "parent")
        .contrast("children", "placebo")
        .write(store.path());
    let planned = store.json(format!("plan {matrix}"));
    let expected = ["10:00", CHILDREN[0], CHILDREN[1], "children", "children (placebo)"];
    assert_eq!((labels(&planned).as_slice(), &planned["blocked"]), (&expected[..], &json!([])));
    let ran = store.json(format!("run {matrix}"));
    let cells = ran["cells"].as_array().unwrap();
    assert!(cells.iter().all(|cell| cell["frames"].as_u64().unwrap() > 20 && cell["cached"] == false));
    let again = store.json(format!("run {matrix}"));
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true), "{again}");
    assert_eq!(again["run"], ran["run"], "a run is the same before and after its experiences were made");
    contrasts_are_differences_of_the_cells(&ran);
    assert_eq!((&again["contrasts"], &ran["warnings"]), (&ran["contrasts"], &json!([])));
    let page = store.file("report.html");
    store.json(format!("report {} -o {page}", ran["run"].as_str().unwrap()));
    let page = std::fs::read_to_string(&page).unwrap();
    for contrast in ran["contrasts"].as_array().unwrap() {
        let value = format!("<data class=\"area_m\" value=\"{}\">", contrast["area_m"]["difference"]);
        assert!(page.contains("contrasts-figure") && page.contains(&value), "no {value}");
    }
    let generators = store.json("generator ls");
    let names: Vec<&str> =
        generators["generators"].as_array().unwrap().iter().map(|g| g["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["gamma:0.8", "gamma:1.25", "otf:10:00>08:00"], "as many placebos as children");
    store.assert_intact();

    // Trained on the route that it is judged on: refused, and said which.
    train(&store, "main");
    assert_eq!(store.json("generator ls")["generators"].as_array().unwrap().len(), 4);
    let planned: Value =
        serde_json::from_slice(&store.furrow(format!("plan {matrix} --json")).output().stdout).unwrap();
    let blocked = planned["blocked"].as_array().unwrap();
    assert_eq!(blocked.len(), 3, "{planned}");
    for cell in blocked {
        let reason = cell["reason"].as_str().unwrap();
        assert!(reason.contains("otf:10:00>08:00") && reason.contains("same route"), "{reason}");
    }
}

/// Every contrast is the difference of its two cells; a drive this short has no interval, and says so.
fn contrasts_are_differences_of_the_cells(run: &Value) {
    let cell =
        |label: &Value| run["cells"].as_array().unwrap().iter().find(|cell| cell["experience"] == *label).unwrap();
    let contrasts = run["contrasts"].as_array().unwrap();
    let pairs: Vec<(&str, &str)> =
        contrasts.iter().map(|c| (c["of"].as_str().unwrap(), c["over"].as_str().unwrap())).collect();
    assert_eq!(pairs, [(CHILDREN[0], "10:00"), (CHILDREN[1], "10:00"), ("children", "children (placebo)")]);
    for contrast in contrasts {
        let (of, over) = (cell(&contrast["of"]), cell(&contrast["over"]));
        for (name, place) in [
            ("good", "/evaluation/good"),
            ("right", "/evaluation/ground_truth/correct"),
            ("lost_fraction", "/evaluation/lost/lost_fraction"),
            ("area_m", "/evaluation/lost/area_m"),
        ] {
            let number = |value: &Value, place: &str| value.pointer(place).and_then(Value::as_f64).unwrap();
            let found = &contrast[name];
            let difference = number(found, "/difference");
            assert!((difference - (number(of, place) - number(over, place))).abs() < 1e-9, "{name}: {contrast}");
            assert_eq!((&found["verdict"], &found["interval"]), (&"too-little-road".into(), &Value::Null), "{name}");
        }
        assert_eq!((&contrast["frames"], &contrast["pooled"]), (&of["frames"], &Value::from(false)));
    }
}
