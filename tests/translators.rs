//! Other programs that generate experiences: commands over JSON lines and ONNX models.

use crate::command::{furrow, json, text};
use crate::generated::{fails, image, ingested, parent, record};
use serde_json::Value;

/// A program that copies its input, as a shell script, and one that never answers.
#[cfg(unix)]
#[test]
fn a_command_paints_over_json_lines() {
    let store = ingested();
    let store = store.path();
    let id = parent(store)["experience"].as_str().unwrap().to_owned();
    let plugin = |name: &str, script: &str, more: &str| {
        let folder = store.join(name);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("paint.sh"), script).unwrap();
        let file = folder.join("translator.json");
        let text = format!(
            "{{\"schema\": 1, \"name\": \"{name}\", \"kind\": \"command\", \"command\": [\"sh\", \"paint.sh\"], \"directions\": [{{\"from\": \"10:00\", \"to\": \"08:00\"}}], \"z_range\": [0, 1], \"z_semantics\": \"displacement_from_input\"{more}}}"
        );
        std::fs::write(&file, text).unwrap();
        file
    };
    const READ: &str = "while read -r line; do\n id=$(echo \"$line\" | sed 's/.*\"id\":\\([0-9]*\\).*/\\1/')\n in=$(echo \"$line\" | sed 's/.*\"in\":\"\\([^\"]*\\)\".*/\\1/')\n out=$(echo \"$line\" | sed 's/.*\"out\":\"\\([^\"]*\\)\".*/\\1/')\n";
    let copy = plugin(
        "copy",
        &format!(
            "{READ} echo $id >> asked\n cp \"$in\" \"$out\"\n echo \"{{\\\"id\\\":$id,\\\"ok\\\":true,\\\"ms\\\":1}}\"\ndone\n"
        ),
        "",
    );
    let added = json(store, &["generator", "add", text(&copy)]);
    assert_eq!(added["generators"][0]["name"], "copy:10:00>08:00");
    let args = ["generate", &id, "--generator", "copy:10:00>08:00", "--z", "1"];
    let made = json(store, &args);
    let (before, after) =
        (record(store, &Value::from(id.clone())), record(store, &made["experiences"][0]["experience"]));
    for (before, after) in before["nodes"].as_array().unwrap().iter().zip(after["nodes"].as_array().unwrap()) {
        assert_eq!(image(store, before), image(store, after));
    }
    let asked = || std::fs::read_to_string(store.join("copy/asked")).unwrap().lines().count();
    let first = asked();
    json(store, &args);
    assert_eq!(asked(), first, "what was painted and measured is not asked for again");
    // A changed script is another painter: nothing of the old one is served, and its experience stands beside the old one.
    let script = store.join("copy/paint.sh");
    let before = std::fs::read_to_string(&script).unwrap();
    std::fs::write(&script, format!("# another\n{before}")).unwrap();
    let repainted = json(store, &args);
    assert!(asked() > first, "a changed script paints anew");
    assert_eq!(repainted["experiences"][0]["painted"], made["experiences"][0]["painted"]);
    std::fs::write(&script, &before).unwrap();
    let second = asked();
    let found = json(store, &args);
    assert_eq!(
        (&found["experiences"], asked()),
        (&json(store, &args)["experiences"], second),
        "the old one's are known"
    );
    assert_eq!(found["experiences"][0]["experience"], made["experiences"][0]["experience"]);
    std::fs::remove_file(&script).unwrap();
    fails(store, &args, 1, &["copy:10:00>08:00", "paint.sh", "put it back"]);
    let said = furrow().arg("--store").arg(store).args(args).arg("--json").output().unwrap();
    assert_eq!((said.status.code(), said.stdout.len()), (Some(1), 0), "a program is given one whole document or none");

    let generate = |name: &str| {
        [
            "generate".to_owned(),
            id.clone(),
            "--generator".to_owned(),
            format!("{name}:10:00>08:00"),
            "--z".to_owned(),
            "1".to_owned(),
        ]
    };
    let wrong = [
        ("mute", "sleep 60\n".to_owned(), ", \"timeout_s\": 0.5", "longer than 0.5 s"),
        ("dead", "exit 3\n".to_owned(), "", "ended"),
        (
            "sorry",
            format!("{READ} echo \"{{\\\"id\\\":$id,\\\"ok\\\":false,\\\"err\\\":\\\"no canvas\\\"}}\"\ndone\n"),
            "",
            "no canvas",
        ),
        ("liar", format!("{READ} echo \"{{\\\"id\\\":$id,\\\"ok\\\":true}}\"\ndone\n"), "", "wrote no"),
        (
            "scribbler",
            format!("{READ} echo scribble > \"$out\"\n echo \"{{\\\"id\\\":$id,\\\"ok\\\":true}}\"\ndone\n"),
            "",
            "no image",
        ),
        ("babbler", "while read -r line; do echo hello; done\n".to_owned(), "", "hello"),
    ];
    for (name, script, more, word) in wrong {
        json(store, &["generator", "add", text(&plugin(name, &script, more))]);
        let args = generate(name);
        fails(store, &args.each_ref().map(String::as_str), 1, &[name, word]);
    }
    assert_eq!(json(store, &["fsck"])["faults"], serde_json::json!([]));
    fails(store, &["generator", "add", text(&store.join("nowhere.json"))], 1, &["cannot be read"]);
    fails(store, &["generator", "add", text(&plugin("odd", "", ", \"colour\": 1"))], 1, &["colour"]);
}

/// Without ONNX Runtime, that is said, with what to do.
#[test]
fn a_missing_onnx_runtime_is_said() {
    let store = ingested();
    let store = store.path();
    let id = parent(store)["experience"].as_str().unwrap().to_owned();
    std::fs::write(store.join("model.onnx"), b"no model").unwrap();
    let file = store.join("translator.json");
    let wanted = |sha: &str| {
        format!(
            "{{\"schema\": 1, \"name\": \"cut\", \"kind\": \"onnx\", \"weights\": \"model.onnx\", \"weights_sha256\": \"{sha}\", \"directions\": [{{\"from\": \"10:00\", \"to\": \"08:00\"}}], \"z_range\": [0, 1], \"z_semantics\": \"displacement_from_input\"}}"
        )
    };
    std::fs::write(&file, wanted(&"0".repeat(64))).unwrap();
    fails(store, &["generator", "add", text(&file)], 1, &["SHA-256", "right file"]);
    // printf 'no model' | sha256sum
    std::fs::write(&file, wanted("f62c7d17e241fe5c5c0c64d2e32ab6e3bd10547a9c02977cc126acc0fe6e6554")).unwrap();
    json(store, &["generator", "add", text(&file)]);
    let output = furrow()
        .env("ORT_DYLIB_PATH", store.join("nowhere.so"))
        .arg("--store")
        .arg(store)
        .args(["generate", &id, "--generator", "cut:10:00>08:00", "--z", "1"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("ONNX Runtime") && said.contains("ORT_DYLIB_PATH"), "{said}");
}
