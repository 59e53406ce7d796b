//! Relighting is a stage of its own: identity at z = 0, other images and another id at z = 1; and its sun stands where
//! the NOAA solar equations have it.

use super::{TRAIN, train};
use crate::support::recordings::ingested_for_training;
use serde_json::Value;

#[test]
fn relighting_knows_the_sun_and_is_asked_for() {
    let store = ingested_for_training();
    train(&store, "vocabulary");
    let lit = format!("{TRAIN} --relight 1 --name lit");
    let trained = store.json(&lit);
    assert_eq!(store.json(&lit), trained);
    let shown = store.json("generator show lit");
    assert_eq!(shown["parameters"]["strengths"]["relight"], 1.0);
    // 08:00 on 15 January: 24.8 degrees high, azimuth 100; the recording begins up to eight minutes later.
    let sun: Vec<f64> = serde_json::from_value(shown["parameters"]["relight"]["target_sun"].clone()).unwrap();
    let (elevation, azimuth) = (sun[2].asin().to_degrees(), sun[0].atan2(sun[1]).to_degrees());
    assert!((24.8..27.0).contains(&elevation) && (98.0..100.5).contains(&azimuth), "{elevation} {azimuth}");
    let listed = store.text("generator ls");
    assert_eq!(listed.matches("relight 1").count(), 1, "{listed}");

    let parent = &store.experience("10:00")["experience"];
    let make = |generator: &str| {
        let made = store.json(format!("generate {} --generator {generator} --z 0,1", parent.as_str().unwrap()));
        [0, 1].map(|i| made["experiences"][i]["experience"].clone())
    };
    let (plain, relit) = (make("otf:10:00>08:00"), make("lit"));
    assert_eq!(make("lit"), relit);
    let first = |experience: &Value| store.image(&store.record(experience)["nodes"][0]);
    let largest = |a: &Value, b: &Value| {
        let (a, b) = (first(a), first(b));
        a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
    };
    assert!(largest(parent, &relit[0]) <= 1);
    assert!(largest(&plain[1], &relit[1]) > 5, "{}", largest(&plain[1], &relit[1]));
    store.json(format!("generator show lit --sheet {}", store.file("sheet.jpg")));
    store.assert_intact();
    store.fails(format!("{TRAIN} --relight 5"), 2, &["--relight", "0 (off) to 4"]);
    store.fails(format!("{TRAIN} --relight 1 --place 95,0"), 2, &["--place", "north and east"]);
    store.fails(format!("{TRAIN} --place -33.9,18.4"), 2, &["--relight"]);
}
