//! `furrow browse`: pages that show what the store holds, to this machine alone, and change nothing.

mod hostile;
mod http;
mod seen;

use crate::command::{field, furrow, json, matrix, run, store, text};
use http::Served;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A store with everything that pages show: three outings, a run, and a generated experience at two z.
struct Shown {
    folder: tempfile::TempDir,
    listing: Value,
    /// What `furrow run --json` printed.
    run: Value,
    /// The parent of the generated ones.
    parent: String,
}

fn shown() -> &'static Shown {
    static SHOWN: OnceLock<Shown> = OnceLock::new();
    SHOWN.get_or_init(|| {
        let folder = store();
        let root = folder.path();
        field().ingest(root);
        let run = json(root, &["run", text(&matrix(root))]);
        let experiences = json(root, &["ls"])["experiences"].clone();
        let parent = experiences.as_array().unwrap().iter().find(|one| one["slot"] == "10:00").unwrap();
        let parent = parent["experience"].as_str().unwrap().to_owned();
        json(root, &["generate", &parent, "--generator", "gamma:0.8", "--z", "0.5,1.0"]);
        std::fs::write(root.join("reports/<b>kept.html"), "<!DOCTYPE html><title>kept</title>").unwrap();
        let listing = json(root, &["ls"]);
        Shown { folder, listing, run, parent }
    })
}

impl Shown {
    fn root(&self) -> &Path {
        self.folder.path()
    }

    fn run(&self) -> &str {
        self.run["run"].as_str().unwrap()
    }

    fn traversals(&self) -> &[Value] {
        self.listing["traversals"].as_array().unwrap()
    }

    /// The id of an outing of a slot and purpose.
    fn outing(&self, slot: &str, purpose: &str) -> &str {
        let is_it = |one: &&Value| one["slot"] == slot && one["purpose"] == purpose;
        self.traversals().iter().find(is_it).unwrap()["traversal"].as_str().unwrap()
    }

    fn children(&self) -> Vec<&Value> {
        self.listing["experiences"].as_array().unwrap().iter().filter(|one| one["generated"] == true).collect()
    }
}

/// Every file of a folder by its path, with its digest.
fn contents(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    let mut todo = vec![folder.to_owned()];
    while let Some(folder) = todo.pop() {
        for entry in std::fs::read_dir(&folder).unwrap().flatten() {
            match entry.file_type().unwrap().is_dir() {
                true => todo.push(entry.path()),
                false => {
                    let bytes = std::fs::read(entry.path()).unwrap();
                    found.insert(entry.path(), furrow_catalog::digest(&bytes).to_string());
                }
            }
        }
    }
    found
}

/// The frame at which a pass' counts from the listing say how many there are.
fn frames_of(outing: &Value) -> u64 {
    outing["counts"]["frames"].as_u64().unwrap()
}

#[test]
fn pages_show_what_the_store_holds_and_change_no_byte_of_it() {
    let shown = shown();
    let before = contents(shown.root());
    let served = Served::start(shown.root());
    let start = served.page("/");
    for outing in shown.traversals() {
        let id = outing["traversal"].as_str().unwrap();
        assert!(start.contains(&format!("/traversal/{id}\"")), "{id} is not on the first page");
        let page = served.page(&format!("/traversal/{id}"));
        assert!(page.contains(outing["recording"].as_str().unwrap()), "the recording's digest");
        let track = served.json(&format!("/traversal/{id}/track"));
        assert_eq!(track["at"].as_array().unwrap().len() as u64, frames_of(outing));
        let driven = track["travelled_m"].as_array().unwrap().last().unwrap().as_f64().unwrap();
        assert!((driven - outing["counts"]["length_m"].as_f64().unwrap()).abs() < 0.001, "{driven}");
        for side in ["left", "right"] {
            let picture = served.get(&format!("/traversal/{id}/frame/0/{side}.jpg"));
            assert!(picture.status == 200 && picture.body.starts_with(&[0xff, 0xd8]), "{}", picture.text());
        }
    }
    let live = shown.outing("08:00", "evaluation");
    let points = served.json(&format!("/traversal/{live}/frame/7/keypoints"))["keypoints"].as_array().unwrap().len();
    assert!(points > 50, "{points} keypoints");
    let before_it = served.json(&format!("/traversal/{live}/frame/7/before"));
    let (inliers, matches) =
        (before_it["lines"].as_array().unwrap().len() as u64, before_it["matches"].as_u64().unwrap());
    assert!(inliers > 30 && inliers <= matches, "{inliers} of {matches} to a keyframe just before");
    assert_eq!(
        served.get(&format!("/traversal/{live}/frame/0/before")).status,
        404,
        "nothing is before the first frame"
    );

    let run = served.page(&format!("/run/{}", shown.run()));
    let cells = shown.run["cells"].as_array().unwrap();
    assert_eq!(run.matches(">watch</a>").count(), cells.len());
    for cell in cells {
        let key = cell["key"].as_str().unwrap();
        let answers = served.json(&format!("/traversal/{live}/answers/{key}"))["answers"].as_array().unwrap().clone();
        let accepted = answers.iter().filter(|answer| answer["accepted"] == true).count() as u64;
        assert_eq!(Some(accepted), cell["good"].as_u64(), "good localisations of {key}");
        assert!(run.contains(&format!("/traversal/{live}#{key}")), "{key} leads to the player");
    }
    assert!(served.page(&format!("/run/{}/report", shown.run())).contains("furrow report"));
    assert!(served.page("/runs").contains(shown.run()));

    let family = served.json(&format!("/experience/{}/family", shown.parent));
    let z: Vec<f64> = family["family"]["generators"][0]["members"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| m["z"].as_f64().unwrap())
        .collect();
    assert_eq!(z, [0.5, 1.0]);
    assert_eq!(shown.children().len(), 2);
    assert!(served.page(&format!("/experience/{}", shown.parent)).contains("gamma:0.8"));
    assert!(start.contains("&lt;b&gt;kept.html") && !start.contains("<b>kept"));
    let kept = start.split("\"/reports/").nth(1).unwrap()[..12].to_owned();
    assert!(served.get(&format!("/reports/{kept}")).head.contains("sandbox"));

    assert_eq!(contents(shown.root()), before, "while it is served");
    assert_eq!(served.interrupt(), Some(0));
    assert_eq!(contents(shown.root()), before, "afterwards");
}

#[test]
fn only_this_machine_is_answered_and_only_get() {
    let shown = shown();
    let served = Served::start(shown.root());
    let port = served.port;
    let ask =
        |method: &str, hosts: &str| served.send(&format!("{method} / HTTP/1.1\r\n{hosts}Connection: close\r\n\r\n"));
    let here = format!("Host: 127.0.0.1:{port}\r\n");
    assert_eq!(ask("GET", &here).status, 200);
    assert_eq!(ask("GET", &format!("Host: localhost:{port}\r\n")).status, 200);
    for other in [
        "Host: evil.example\r\n",
        "Host: 127.0.0.1\r\n",
        "Host: 127.0.0.1:1\r\n",
        "Host: 127.0.0.1.evil.example\r\n",
        "",
    ] {
        let reply = ask("GET", other);
        assert!([400, 421].contains(&reply.status) && !reply.text().contains("old-zoo"), "{other}: {}", reply.status);
    }
    assert_eq!(ask("GET", &format!("{here}Host: evil.example\r\n")).status, 421);
    for method in ["POST", "HEAD", "PUT", "DELETE", "OPTIONS"] {
        let reply = ask(method, &here);
        assert!(reply.status == 405 && reply.head.contains("allow: get"), "{method}: {}", reply.head);
    }
    let head = served.get("/").head;
    for expected in
        ["default-src 'none'", "x-content-type-options: nosniff", "cross-origin-resource-policy: same-origin"]
    {
        assert!(head.contains(expected), "{expected} is not in {head}");
    }
    assert!(!head.contains("unsafe"), "{head}");
    // Nobody else can reach it: the address is this machine's own.
    let sockets = std::fs::read_to_string("/proc/net/tcp").unwrap();
    let listening: Vec<&str> =
        sockets.lines().filter(|line| line.contains(&format!(":{port:04X} 00000000:0000 0A"))).collect();
    assert!(listening.len() == 1 && listening[0].contains("0100007F:"), "{listening:?}");
}

#[test]
fn what_is_not_there_is_a_friendly_404() {
    let shown = shown();
    let served = Served::start(shown.root());
    let (none, live, parent) = ("ab".repeat(32), shown.outing("08:00", "evaluation"), &shown.parent);
    let paths = [
        "/nowhere".to_owned(),
        "/traversal/xyz".to_owned(),
        format!("/traversal/{none}"),
        format!("/traversal/{parent}"),
        format!("/experience/{none}"),
        format!("/run/{none}"),
        "/site/000000000000".to_owned(),
        "/reports/..%2fcatalogue.db".to_owned(),
        "/traversal/%ff".to_owned(),
        "/traversal/%3Cscript%3Ealert(1)%3C%2Fscript%3E".to_owned(),
    ];
    for path in paths {
        let reply = served.get(&path);
        assert!(
            reply.status == 404 && reply.text().contains("href=\"/\""),
            "{path}: {} {}",
            reply.status,
            reply.text()
        );
        assert!(!reply.text().contains("<script>"), "{path}");
    }
    for path in ["frame/99999/left.jpg", "frame/-1/left.jpg", "frame/0/up.jpg", "frame/x/keypoints", "answers/x"] {
        assert_eq!(served.get(&format!("/traversal/{live}/{path}")).status, 404, "{path}");
    }
    assert_eq!(served.get(&format!("/experience/{parent}/node/99999")).status, 404);
    // Addresses of earlier versions lead on.
    let moved = served.get(&format!("/outing/{live}/track"));
    assert!(
        moved.status == 308 && moved.head.contains(&format!("location: /traversal/{live}/track")),
        "{}",
        moved.head
    );
    assert_eq!(run(&["--store", text(shown.root()), "browse", "--port", "70000"]).status.code(), Some(2));
    let taken = furrow().args(["--store", text(shown.root()), "browse", "--port", &served.port.to_string()]).output();
    let taken = taken.unwrap();
    let said = String::from_utf8_lossy(&taken.stderr).into_owned();
    assert!(taken.status.code() == Some(1) && said.contains("--port"), "{said}");
    let nothing = tempfile::tempdir().unwrap();
    let refused = run(&["--store", text(nothing.path()), "browse"]);
    assert!(refused.status.code() == Some(1) && String::from_utf8_lossy(&refused.stderr).contains("furrow init"));
}

#[test]
fn an_index_that_is_none_is_refused() {
    let store = store();
    // What `init` has not copied into the file yet would serve in its place.
    let _ = std::fs::remove_file(store.path().join("catalogue.db-wal"));
    std::fs::write(store.path().join("catalogue.db"), "this is no database at all, whatever its name says").unwrap();
    let refused = run(&["--store", text(store.path()), "browse"]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(1) && said.contains("index") && !said.contains("panicked"), "{said}");
}
