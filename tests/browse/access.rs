//! Who is answered, and what is not there.

use super::shown::shown;
use crate::support::http::Served;
use crate::support::store::Store;

#[test]
fn only_this_machine_is_answered_and_only_get() {
    let shown = shown();
    let served = Served::start(&shown.store);
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
    let served = Served::start(&shown.store);
    let (none, live, parent) = ("ab".repeat(32), shown.traversal("08:00", "evaluation"), &shown.parent);
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
    let location = format!("location: /traversal/{live}/track");
    assert!(moved.status == 308 && moved.head.contains(&location), "{}", moved.head);
    shown.store.fails("browse --port 70000", 2, &[]);
    shown.store.fails(format!("browse --port {}", served.port), 1, &["--port"]);
    let nothing = tempfile::tempdir().unwrap();
    Store::at(nothing.path()).fails("browse", 1, &["furrow init"]);
}

#[test]
fn an_index_that_is_none_is_refused() {
    let store = Store::new();
    // What `init` has not copied into the file yet would serve in its place.
    let _ = std::fs::remove_file(store.file("catalogue.db-wal"));
    store.write("catalogue.db", "this is no database at all, whatever its name says");
    store.fails("browse", 1, &["index"]);
}
