//! Many small recordings, sound and broken.

use crate::support::command::quoted;
use crate::support::golden_data::{data_folder, files_below};
use crate::support::store::Store;

#[test]
fn every_fixture_is_ingested_or_refused_with_a_reason() {
    let Some(fixtures) = data_folder("bag_fixtures") else { return };
    let store = Store::new();
    let recordings = files_below(&fixtures).into_iter().filter(|path| {
        path.extension().is_some_and(|extension| ["bag", "mcap", "db3"].iter().any(|known| extension == *known))
    });
    let mut tried = 0;
    for path in recordings {
        let path = quoted(path);
        let ingest = store.furrow(format!("ingest {path} --site s --route r --slot 12:00 --purpose experience"));
        let output = ingest.output();
        let stderr = String::from_utf8_lossy(&output.stderr);
        let named = stderr.contains(path.file_name().unwrap().to_str().unwrap());
        match output.status.code() {
            Some(0) => {}
            Some(1) => assert!(named, "{path}: {stderr}"),
            other => panic!("{path}: ended with {other:?}: {stderr}"),
        }
        assert!(!stderr.contains("panicked"), "{path}: {stderr}");
        tried += 1;
    }
    assert!(tried >= 10, "{tried} fixtures");
    store.assert_intact();
    store.text("ls");
}
