//! Other programs that generate experiences: commands over JSON lines and ONNX models.

use super::parent_id;
use crate::support::command::Quoted;
use crate::support::recordings::ingested_for_training;
use crate::support::store::Store;
use serde_json::{Value, json};

/// The description of a program that paints 10:00 as 08:00, with more keys.
fn description(name: &str, more: &Value) -> String {
    let mut description = json!({
        "schema": 1, "name": name, "directions": [{ "from": "10:00", "to": "08:00" }], "z_range": [0, 1],
        "z_semantics": "displacement_from_input",
    });
    let more = more.as_object().unwrap().clone();
    description.as_object_mut().unwrap().extend(more);
    description.to_string()
}

/// A program that is a shell script, in a folder of the store.
fn program(store: &Store, name: &str, script: &str, more: &Value) -> Quoted {
    std::fs::create_dir_all(store.file(name)).unwrap();
    store.write(&format!("{name}/paint.sh"), script);
    let mut keys = json!({ "kind": "command", "command": ["sh", "paint.sh"] });
    keys.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    store.write(&format!("{name}/translator.json"), description(name, &keys))
}

/// A script that does something with every request: `$id`, `$in` and `$out` are what it asks for.
fn script(work: &str) -> String {
    let field = |name: &str, value: &str| format!("{name}=$(echo \"$line\" | sed 's/.*\"{name}\":{value}.*/\\1/')\n");
    let text = "\"\\([^\"]*\\)\"";
    let fields = field("id", "\\([0-9]*\\)") + &field("in", text) + &field("out", text);
    format!("while read -r line; do\n{fields}{work}\ndone\n")
}

/// What a script answers with.
fn answer(rest: &str) -> String {
    format!("printf '{{\"id\":%s,{rest}}}\\n' \"$id\"")
}

/// A program that copies its input is asked once; one that fails is named with what is wrong.
#[test]
fn a_command_paints_over_json_lines() {
    let store = ingested_for_training();
    let id = parent_id(&store);
    let copies = script(&format!("echo $id >> asked\ncp \"$in\" \"$out\"\n{}", answer("\"ok\":true,\"ms\":1")));
    let copy = program(&store, "copy", &copies, &json!({}));
    let added = store.json(format!("generator add {copy}"));
    assert_eq!(added["generators"][0]["name"], "copy:10:00>08:00");
    let generate = format!("generate {id} --generator copy:10:00>08:00 --z 1");
    let made = store.json(&generate);
    let [before, after] = [&Value::from(id.clone()), &made["experiences"][0]["experience"]].map(|id| store.record(id));
    for (before, after) in before["nodes"].as_array().unwrap().iter().zip(after["nodes"].as_array().unwrap()) {
        assert_eq!(store.image(before), store.image(after));
    }
    let asked = || std::fs::read_to_string(store.file("copy/asked")).unwrap().lines().count();
    let first = asked();
    store.json(&generate);
    assert_eq!(asked(), first, "what was painted and measured is not asked for again");
    // A changed script is another painter: nothing of the old one is served, and its experience stands beside the old
    // one.
    store.write("copy/paint.sh", format!("# another\n{copies}"));
    let repainted = store.json(&generate);
    assert!(asked() > first, "a changed script paints anew");
    assert_eq!(repainted["experiences"][0]["painted"], made["experiences"][0]["painted"]);
    store.write("copy/paint.sh", &copies);
    let second = asked();
    let found = store.json(&generate);
    let again = store.json(&generate);
    assert_eq!((&found["experiences"], asked()), (&again["experiences"], second), "the old one's are known");
    assert_eq!(found["experiences"][0]["experience"], made["experiences"][0]["experience"]);
    std::fs::remove_file(store.file("copy/paint.sh")).unwrap();
    store.fails(&generate, 1, &["copy:10:00>08:00", "paint.sh", "put it back"]);
    let output = store.furrow(format!("{generate} --json")).output();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "one whole document on stdout, or none");

    let wrong = [
        ("mute", "sleep 60\n".to_owned(), json!({ "timeout_s": 0.5 }), "longer than 0.5 s"),
        ("dead", "exit 3\n".to_owned(), json!({}), "ended"),
        ("sorry", script(&answer("\"ok\":false,\"err\":\"no canvas\"")), json!({}), "no canvas"),
        ("liar", script(&answer("\"ok\":true")), json!({}), "wrote no"),
        ("scribbler", script(&format!("echo scribble > \"$out\"\n{}", answer("\"ok\":true"))), json!({}), "no image"),
        ("babbler", script("echo hello"), json!({}), "hello"),
    ];
    for (name, script, more, word) in wrong {
        store.json(format!("generator add {}", program(&store, name, &script, &more)));
        store.fails(format!("generate {id} --generator {name}:10:00>08:00 --z 1"), 1, &[name, word]);
    }
    store.assert_intact();
    store.fails("generator add nowhere.json", 1, &["cannot be read"]);
    store.fails(format!("generator add {}", program(&store, "odd", "", &json!({ "colour": 1 }))), 1, &["colour"]);
}

/// Without ONNX Runtime, that is said, with what to do.
#[test]
fn a_missing_onnx_runtime_is_said() {
    let store = ingested_for_training();
    store.write("model.onnx", "no model");
    let add = |sha: &str| {
        let model = json!({ "kind": "onnx", "weights": "model.onnx", "weights_sha256": sha });
        format!("generator add {}", store.write("translator.json", description("cut", &model)))
    };
    store.fails(add(&"0".repeat(64)), 1, &["SHA-256", "right file"]);
    // printf 'no model' | sha256sum
    store.json(add("f62c7d17e241fe5c5c0c64d2e32ab6e3bd10547a9c02977cc126acc0fe6e6554"));
    let generate = store.furrow(format!("generate {} --generator cut:10:00>08:00 --z 1", parent_id(&store)));
    generate.env("ORT_DYLIB_PATH", store.path().join("nowhere.so")).fails(1, &["ONNX Runtime", "ORT_DYLIB_PATH"]);
}
