//! Generated experiences, as a user makes and uses them.

use crate::command::{field, furrow, json, run, store, text};
use crate::interrupted::{killed_after, moments};
use furrow_catalog::images::decode_colour;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;

/// A store with the field's outings, and a second vocabulary pass at 08:00, so that there are two slots to train on.
pub fn ingested() -> tempfile::TempDir {
    static MORNING: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, morning) = MORNING.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("morning.mcap");
        let wanted = [
            "simulate",
            "--site",
            "old-zoo",
            "--slot",
            "08:00",
            "--route",
            "vocabulary",
            "--number",
            "1",
            "--length",
            "8",
            "-o",
            text(&file),
        ];
        assert!(run(&wanted).status.success());
        (folder, file)
    });
    let store = store();
    field().ingest(store.path());
    json(
        store.path(),
        &[
            "ingest",
            text(morning),
            "--site",
            "old-zoo",
            "--route",
            "vocabulary",
            "--slot",
            "08:00",
            "--pass",
            "vocabulary",
        ],
    );
    store
}

fn train(store: &Path, route: &str) -> Value {
    json(
        store,
        &[
            "generator",
            "train",
            "--site",
            "old-zoo",
            "--from",
            "10:00",
            "--to",
            "08:00",
            "--route",
            route,
            "--images",
            "30",
        ],
    )
}

/// The recorded experience at 10:00.
pub fn parent(store: &Path) -> Value {
    let listed = json(store, &["ls"]);
    let all = listed["experiences"].as_array().unwrap();
    all.iter().find(|e| e["slot"] == "10:00" && e["generated"] == false).unwrap().clone()
}

/// The whole record of an experience, read as any program could.
pub fn record(store: &Path, id: &Value) -> Value {
    let id = id.as_str().unwrap();
    let bytes = std::fs::read(store.join("objects").join(&id[..2]).join(id)).unwrap();
    serde_json::from_slice::<Value>(&bytes).unwrap()["body"].clone()
}

pub fn image(store: &Path, node: &Value) -> furrow_catalog::images::ColourImage {
    let id = node["left"].as_str().unwrap();
    decode_colour(&std::fs::read(store.join("objects").join(&id[..2]).join(id)).unwrap(), None).unwrap()
}

pub fn fails(store: &Path, args: &[&str], code: i32, words: &[&str]) {
    let output = furrow().arg("--store").arg(store).args(args).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "furrow {args:?}: {said}");
    words.iter().for_each(|word| assert!(said.contains(word), "expected '{word}' in: {said}"));
}

#[test]
fn a_child_has_its_parents_stamps_and_chain_and_other_images() {
    let store = ingested();
    let store = store.path();
    let trained = train(store, "vocabulary");
    assert_eq!((&trained["name"], &trained["source_images"]), (&"otf:10:00>08:00".into(), &30.into()));
    assert_eq!(train(store, "vocabulary"), trained, "the same images give the same generator");
    let parent = parent(store);
    let id = parent["experience"].as_str().unwrap();
    let args = ["generate", &id[..12], "--generator", "otf:10:00>08:00", "--z", "0,0.5,1"];
    let made = json(store, &args);
    let children = made["experiences"].as_array().unwrap();
    assert_eq!(children.iter().map(|c| c["mimics"].as_str().unwrap()).collect::<Vec<_>>(), ["10:00", "08:00", "08:00"]);
    let before = record(store, &parent["experience"]);
    for child in children {
        let after = record(store, &child["experience"]);
        assert_eq!(
            (&after["chain"], &after["rig"], &after["keyframes"]),
            (&before["chain"], &before["rig"], &before["keyframes"])
        );
        assert_eq!(after["kind"]["generated"]["parent"], parent["experience"]);
        let (before, after) = (before["nodes"].as_array().unwrap(), after["nodes"].as_array().unwrap());
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(after) {
            assert_eq!(before["stamp_ns"], after["stamp_ns"]);
            let (before, after) = (image(store, before), image(store, after));
            let largest = before.rgb.iter().zip(&after.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert_eq!(largest <= 1, child["domainness"] == 0.0, "z = {}: {largest}", child["domainness"]);
        }
    }
    // All is found the second time, and on one thread; the gate was measured and is kept.
    let again = json(store, &args);
    let painted: u64 = again["experiences"].as_array().unwrap().iter().map(|c| c["painted"].as_u64().unwrap()).sum();
    let ids = |made: &Value| {
        made["experiences"].as_array().unwrap().iter().map(|c| c["experience"].clone()).collect::<Vec<_>>()
    };
    assert_eq!((painted, ids(&again)), (0, ids(&made)));
    let shown = json(store, &["generator", "show", "otf:10:00>08:00"]);
    assert_eq!(shown["gates"][0]["curve"].as_array().unwrap().len(), 3);
    assert!(shown["gates"][0]["switch"]["kappa"].as_f64().unwrap() < 4.0, "{shown}");
    assert_eq!(json(store, &["fsck"])["faults"], serde_json::json!([]));
    let sheet = store.join("sheet.jpg");
    json(store, &["generator", "show", "otf:10:00>08:00", "--sheet", text(&sheet)]);
    let sheet = decode_colour(&std::fs::read(sheet).unwrap(), None).unwrap();
    assert!(sheet.width > 1200 && sheet.height > 1200, "{} x {}", sheet.width, sheet.height);

    let child = children[1]["experience"].as_str().unwrap();
    fails(store, &["generate", child, "--generator", "identity", "--z", "1"], 1, &["grandchildren", "recorded"]);
    fails(
        store,
        &["generate", id, "--generator", "otf:10:00>8:00", "--z", "1"],
        1,
        &["did you mean 'otf:10:00>08:00'"],
    );
    fails(store, &["generate", id, "--generator", "noise:3", "--z", "3"], 1, &["-0.5", "2"]);
    fails(store, &["generate", id, "--generator", "noise:3", "--z", "1,2", "--mimics", "10:00"], 2, &["--mimics"]);
    fails(
        store,
        &["generator", "train", "--site", "old-zoo", "--from", "10:00", "--to", "16:00"],
        1,
        &["16:00", "08:00, 10:00"],
    );
}

#[test]
fn a_matrix_generates_and_sets_placebos_beside_the_collective() {
    let store = ingested();
    let store = store.path();
    train(store, "vocabulary");
    let matrix = |generator: &str| {
        let path = store.join("generated.toml");
        let text = format!(
            "name = \"g\"\nsite = \"old-zoo\"\ncodebook = {{ words = 400, route = \"vocabulary\", images = 40 }}\nkeyframes = {{ distance_m = 1.0, yaw_rad = 0.2536 }}\n\
             verification = {{ threshold = 40 }}\n[axes]\nlive = [\"08:00\"]\nexperience = [\"10:00\", {{ parent = \"10:00\", generator = \"{generator}\", domainness = [0.5, 1.0] }}]\n\
             [[collective]]\nname = \"children\"\nof = \"10:00 generated\"\nplacebo = true\n\
             [[contrast]]\nof = \"each generated\"\nover = \"parent\"\n[[contrast]]\nof = \"children\"\nover = \"placebo\"\n"
        );
        std::fs::write(&path, text).unwrap();
        path
    };
    let path = matrix("otf:10:00>08:00");
    let planned = json(store, &["plan", text(&path)]);
    let labels = |run: &Value| {
        run["cells"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c["experience"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let expected = [
        "10:00",
        "10:00 as 08:00 (otf:10:00>08:00 z 0.5)",
        "10:00 as 08:00 (otf:10:00>08:00 z 1)",
        "children",
        "children (placebo)",
    ];
    assert_eq!((labels(&planned), &planned["blocked"]), (expected.map(str::to_owned).to_vec(), &serde_json::json!([])));
    let ran = json(store, &["run", text(&path)]);
    assert!(
        ran["cells"]
            .as_array()
            .unwrap()
            .iter()
            .all(|cell| cell["frames"].as_u64().unwrap() > 20 && cell["cached"] == false)
    );
    let again = json(store, &["run", text(&path)]);
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true), "{again}");
    assert_eq!(again["run"], ran["run"], "a run is the same before and after its experiences were made");
    contrasts_are_differences_of_the_cells(&ran);
    assert_eq!((&again["contrasts"], &ran["warnings"]), (&ran["contrasts"], &serde_json::json!([])));
    let page = store.join("report.html");
    json(store, &["report", ran["run"].as_str().unwrap(), "-o", text(&page)]);
    let page = std::fs::read_to_string(&page).unwrap();
    for contrast in ran["contrasts"].as_array().unwrap() {
        let value = format!("<data class=\"area_m\" value=\"{}\">", contrast["area_m"]["difference"]);
        assert!(page.contains("contrasts-figure") && page.contains(&value), "no {value}");
    }
    let generators = json(store, &["generator", "ls"]);
    let names: Vec<&str> =
        generators["generators"].as_array().unwrap().iter().map(|g| g["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["gamma:0.8", "gamma:1.25", "otf:10:00>08:00"], "as many placebos as children");
    assert_eq!(json(store, &["fsck"])["faults"], serde_json::json!([]));

    // Trained on the route that it is judged on: refused, and said which.
    train(store, "main");
    let refused = json(store, &["generator", "ls"]);
    assert_eq!(refused["generators"].as_array().unwrap().len(), 4);
    let planned = furrow().arg("--store").arg(store).args(["plan", text(&path), "--json"]).output().unwrap();
    let planned: Value = serde_json::from_slice(&planned.stdout).unwrap();
    let blocked = planned["blocked"].as_array().unwrap();
    assert_eq!(blocked.len(), 3, "{planned}");
    assert!(blocked.iter().all(|b| b["reason"].as_str().unwrap().contains("otf:10:00>08:00")
        && b["reason"].as_str().unwrap().contains("same route")));
}

/// Every contrast is the difference of its two cells, lies in its interval, and is called what the interval says.
fn contrasts_are_differences_of_the_cells(run: &Value) {
    let cell =
        |label: &Value| run["cells"].as_array().unwrap().iter().find(|cell| cell["experience"] == *label).unwrap();
    let contrasts = run["contrasts"].as_array().unwrap();
    let pairs: Vec<(&str, &str)> =
        contrasts.iter().map(|c| (c["of"].as_str().unwrap(), c["over"].as_str().unwrap())).collect();
    let child = |z: &str| format!("10:00 as 08:00 (otf:10:00>08:00 z {z})");
    let (near, far) = (child("0.5"), child("1"));
    assert_eq!(pairs, [(&*near, "10:00"), (&*far, "10:00"), ("children", "children (placebo)")]);
    for contrast in contrasts {
        let (of, over) = (cell(&contrast["of"]), cell(&contrast["over"]));
        for (name, place, wanted) in [
            ("good", "/evaluation/good", 1.0),
            ("right", "/evaluation/ground_truth/correct", 1.0),
            ("lost_fraction", "/evaluation/lost/lost_fraction", -1.0),
            ("area_m", "/evaluation/lost/area_m", -1.0),
        ] {
            let number = |value: &Value, place: &str| value.pointer(place).and_then(Value::as_f64).unwrap();
            let found = &contrast[name];
            let difference = number(found, "/difference");
            assert!((difference - (number(of, place) - number(over, place))).abs() < 1e-9, "{name}: {contrast}");
            let (low, high) = (number(found, "/interval/0"), number(found, "/interval/1"));
            assert!(low <= difference && difference <= high, "{name}: {contrast}");
            let expected = match (low * wanted, high * wanted) {
                (low, high) if low > 0.0 && high > 0.0 => "better",
                (low, high) if low < 0.0 && high < 0.0 => "worse",
                _ => "not-separable",
            };
            assert_eq!(found["verdict"], expected, "{name}: {contrast}");
        }
        assert_eq!((&contrast["frames"], &contrast["pooled"]), (&of["frames"], &Value::from(false)));
    }
}

/// What a contrast may name, and what is said where it names something else or leaves out the placebo.
#[test]
fn contrasts_that_name_nothing_are_refused_and_claims_without_a_placebo_are_named() {
    let store = ingested();
    let store = store.path();
    let path = store.join("contrasts.toml");
    let write = |collective: &str, contrast: &str| {
        let text = format!(
            "name = \"c\"\nsite = \"old-zoo\"\ncodebook = {{ words = 400, route = \"vocabulary\" }}\n[axes]\nlive = [\"08:00\"]\n\
             experience = [\"08:00\", \"10:00\", \"16:00\", {{ parent = \"10:00\", generator = \"invariant\", domainness = [0.5, 1.0] }}]\n\
             [[collective]]\nname = \"children\"\nof = \"generated\"\n{collective}\n[[contrast]]\n{contrast}\n"
        );
        std::fs::write(&path, text).unwrap();
    };
    let refused = [
        ("of = \"childen\"\nover = \"parent\"", "line 12", "did you mean 'children'"),
        ("of = \"children\"\nover = \"11:00\"", "line 13", "did you mean '10:00'"),
        ("of = \"children\"\nover = \"placebo\"", "line 13", "placebo = true"),
        ("of = \"10:00\"\nover = \"parent\"", "line 13", "none of it is generated"),
        ("of = \"children\"\nover = \"mimicked\"", "line 13", "each generated"),
        ("of = \"10:00\"\nover = \"10:00\"", "line 13", "itself"),
        ("of = \"10:00 as 10:00\"\nover = \"10:00\"", "line 12", "write one of them out"),
    ];
    for (contrast, line, word) in refused {
        write("", contrast);
        fails(store, &["plan", text(&path)], 1, &[line, word]);
    }
    let planned = |collective: &str, contrast: &str| {
        write(collective, contrast);
        let output = furrow().arg("--store").arg(store).args(["plan", text(&path), "--json"]).output().unwrap();
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let warned = |plan: &Value, word: &str| {
        plan["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(word))
    };
    let bare = planned("", "of = \"children\"\nover = \"parent\"");
    assert!(warned(&bare, "'children' is set against '10:00' and against no placebo"), "{bare}");
    let beside = planned(
        "placebo = true",
        "of = \"children\"\nover = \"parent\"\n[[contrast]]\nof = \"children\"\nover = \"placebo\"",
    );
    assert_eq!(beside["warnings"], serde_json::json!([]));
    assert_eq!(beside["contrasts"][1]["over"], "children (placebo)");
    // What the axis names and the store lacks is no error: it is said, and the rest goes on.
    let absent = planned("", "of = \"10:00\"\nover = \"16:00\"");
    assert!(warned(&absent, "no experience pass at 16:00"), "{absent}");
    // A mixed collective keeps its recorded members where placebos take the place of the generated ones.
    let mixed = planned(
        "placebo = true\n[[collective]]\nname = \"mixed\"\nof = \"10:00 and generated\"\nplacebo = true",
        "of = \"mixed\"\nover = \"placebo\"",
    );
    assert_eq!(mixed["contrasts"][0]["over"], "mixed (placebo)", "{mixed}");
}

/// Killed anywhere while it trains or paints, the same command ends with the ids of one that was left alone.
#[test]
fn training_and_generating_killed_at_any_moment_end_with_the_same_ids() {
    let train = ["generator", "train", "--site", "old-zoo", "--from", "10:00", "--to", "08:00", "--images", "30"];
    let undisturbed = ingested();
    let id = parent(undisturbed.path())["experience"].as_str().unwrap().to_owned();
    let generate = ["generate", &id, "--generator", "otf:10:00>08:00", "--z", "0.33,0.66,1"];
    let disturbed = ingested();
    let mut killed = 0;
    for args in [&train[..], &generate] {
        let began = Instant::now();
        let expected = json(undisturbed.path(), args);
        for delay in moments(began.elapsed(), 8) {
            killed += u32::from(killed_after(disturbed.path(), args, delay));
            assert_eq!(json(disturbed.path(), &["fsck"])["faults"], serde_json::json!([]), "{args:?} after {delay:?}");
        }
        let mut found = json(disturbed.path(), args);
        // How many images were left to paint is the one thing that may differ.
        for (found, expected) in found
            .get_mut("experiences")
            .and_then(Value::as_array_mut)
            .into_iter()
            .flatten()
            .zip(expected["experiences"].as_array().into_iter().flatten())
        {
            found["painted"] = expected["painted"].clone();
        }
        assert_eq!(found, expected);
    }
    assert!(killed >= 4, "only {killed} kills came in time");
    let listed = |store: &Path| json(store, &["ls"])["experiences"].as_array().unwrap().len();
    assert_eq!(listed(disturbed.path()), listed(undisturbed.path()));
}

/// Relighting is a stage of its own: identity at z = 0, other images and another id at z = 1; and its sun stands where SPEC 8.1 has it.
#[test]
fn relighting_knows_the_sun_and_is_asked_for() {
    let store = ingested();
    let store = store.path();
    train(store, "vocabulary");
    let lit = ["--relight", "1", "--name", "lit", "--images", "30"];
    let args = [&["generator", "train", "--site", "old-zoo", "--from", "10:00", "--to", "08:00"][..], &lit].concat();
    let trained = json(store, &args);
    assert_eq!(json(store, &args), trained);
    let shown = json(store, &["generator", "show", "lit"]);
    assert_eq!(shown["parameters"]["strengths"]["relight"], 1.0);
    // 08:00 on 15 January: 24.8 degrees high, azimuth 100; the drive sets out up to eight minutes later.
    let sun: Vec<f64> = serde_json::from_value(shown["parameters"]["relight"]["target_sun"].clone()).unwrap();
    let (elevation, azimuth) = (sun[2].asin().to_degrees(), sun[0].atan2(sun[1]).to_degrees());
    assert!((24.8..27.0).contains(&elevation) && (98.0..100.5).contains(&azimuth), "{elevation} {azimuth}");
    let said = furrow().arg("--store").arg(store).args(["generator", "ls"]).output().unwrap();
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    assert_eq!(said.matches("relight 1").count(), 1, "{said}");

    let parent = parent(store);
    let id = parent["experience"].as_str().unwrap();
    let make = |generator: &str| {
        let made = json(store, &["generate", id, "--generator", generator, "--z", "0,1"]);
        [0, 1].map(|i| made["experiences"][i]["experience"].clone())
    };
    let (plain, relit) = (make("otf:10:00>08:00"), make("lit"));
    assert_eq!(make("lit"), relit);
    let first = |experience: &Value| image(store, &record(store, experience)["nodes"][0]);
    let largest = |a: &Value, b: &Value| {
        let (a, b) = (first(a), first(b));
        a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
    };
    assert!(largest(&parent["experience"], &relit[0]) <= 1);
    assert!(largest(&plain[1], &relit[1]) > 5, "{}", largest(&plain[1], &relit[1]));
    let sheet = store.join("sheet.jpg");
    json(store, &["generator", "show", "lit", "--sheet", text(&sheet)]);
    assert_eq!(json(store, &["fsck"])["faults"], serde_json::json!([]));
    let train = ["generator", "train", "--site", "old-zoo", "--from", "10:00", "--to", "08:00"];
    fails(store, &[&train[..], &["--relight", "5"]].concat(), 2, &["--relight", "0 (off) to 4"]);
    fails(store, &[&train[..], &["--relight", "1", "--place", "95,0"]].concat(), 2, &["--place", "north and east"]);
    fails(store, &[&train[..], &["--place", "-33.9,18.4"]].concat(), 2, &["--relight"]);
}
