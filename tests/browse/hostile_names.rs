//! Names that would do something if they could, and objects that are damaged.

use super::seen;
use crate::support::command::quoted;
use crate::support::http::Served;
use crate::support::recordings::{Recording, recordings};
use crate::support::store::Store;

/// A name as nasty as names get.
fn nasty() -> String {
    format!("</title><script>alert(1)</script>\u{202e}\"'&{{{{ 7 * 7 }}}}{}", "x".repeat(300))
}

#[test]
fn hostile_names_are_shown_and_damage_is_named() {
    let store = Store::new();
    let Recording { file, slot, .. } = &recordings()[0];
    let name = quoted(nasty());
    let ingested = store.json(format!("ingest {file} --site {name} --route {name} --slot {slot} --purpose experience"));
    let id = ingested["traversal"].as_str().unwrap().to_owned();
    let served = Served::start(&store);
    let start = served.page("/");
    let key = start.split("href=\"/site/").nth(1).unwrap()[..12].to_owned();
    let experience = store.json("ls")["experiences"][0]["experience"].as_str().unwrap().to_owned();
    let pages = [
        "/".to_owned(),
        format!("/site/{key}"),
        format!("/site/{key}/{slot}/1"),
        format!("/traversal/{id}"),
        format!("/experience/{experience}"),
    ];
    for path in &pages {
        let page = served.page(path);
        assert!(page.contains("&lt;script&gt;alert(1)") && !page.contains("<script>alert"), "{path}");
        assert!(page.contains('\u{fffd}') && !page.contains('\u{202e}') && page.contains("{{ 7 * 7 }}"), "{path}");
    }
    seen::nothing_is_executed(&served, &pages);

    let record = store.json("ls")["traversals"][0].clone();
    drop(served);
    for (damaged, path) in [
        ("frames", "/traversal/ID"),
        ("calibration", "/traversal/ID/frame/0/left.jpg"),
        ("chain", "/traversal/ID/track"),
    ] {
        let (file, path) = (store.object(&record[damaged]), path.replace("ID", &id));
        let whole = std::fs::read(&file).unwrap();
        let mut torn = whole.clone();
        torn[0] ^= 1;
        std::fs::write(&file, torn).unwrap();
        let served = Served::start(&store);
        let reply = served.get(&path);
        assert_eq!(reply.status, 500, "{path} with damaged {damaged}");
        assert!(
            reply.text().contains(record[damaged].as_str().unwrap()) && reply.text().contains("furrow fsck"),
            "{}",
            reply.text()
        );
        assert_eq!(served.get("/").status, 200, "the first page stands, {damaged} damaged");
        std::fs::write(&file, whole).unwrap();
    }
}
