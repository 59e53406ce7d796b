//! The matrix files of the repository.

use std::path::Path;

#[test]
fn every_matrix_of_the_repository_can_be_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("runner/matrices");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let toml = std::fs::read_to_string(&path).unwrap();
        furrow_runner::read_matrix(&path, &toml).unwrap_or_else(|error| panic!("{error}"));
        read += 1;
    }
    assert!(read >= 12, "{read} matrices");
}
