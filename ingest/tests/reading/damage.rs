//! Damage of every kind: read or refused, never a panic, never more memory or time than the file is worth.

use crate::bag_writer::bag;
use crate::written::{db3_file, mcap_file, some_messages};
use crate::{each_message, messages_of};
use furrow_ingest::recording::open;
use rand::{Rng, RngExt, SeedableRng};
use std::path::Path;

/// Sound small files of every container.
fn files(folder: &Path) -> Vec<(&'static str, Vec<u8>)> {
    let messages = some_messages(0, 40);
    let mut files: Vec<(&str, Vec<u8>)> =
        ["none", "bz2", "lz4"].map(|compression| ("bag", bag(compression, 9, &messages))).to_vec();
    for compression in [None, Some(mcap::Compression::Lz4), Some(mcap::Compression::Zstd)] {
        files.push(("mcap", mcap_file(compression, true, true, &messages)));
    }
    files.push(("mcap", mcap_file(Some(mcap::Compression::Zstd), true, false, &messages)));
    files.push(("mcap", mcap_file(None, false, true, &messages)));
    let path = folder.join("sound.db3");
    db3_file(&path, &["PRAGMA synchronous = OFF", "CREATE INDEX t ON messages (timestamp)"], &messages);
    files.push(("db3", std::fs::read(&path).unwrap()));
    files
}

/// The error of opening or reading; `None` where all went well.
fn outcome(path: &Path) -> Option<String> {
    match open(path) {
        Err(error) => Some(error.to_string()),
        Ok(recording) => each_message(&recording, &mut |_, _, _| ()).map(|error| error.to_string()),
    }
}

#[test]
fn a_file_cut_anywhere_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut");
    for (kind, bytes) in files(folder.path()) {
        let step = if kind == "db3" { 509 } else { 37 };
        for len in (0..bytes.len()).step_by(step).chain([bytes.len() - 1]) {
            std::fs::write(&path, &bytes[..len]).unwrap();
            let error = outcome(&path).unwrap_or_else(|| panic!("{kind} cut at {len} of {} was read", bytes.len()));
            assert!(error.contains("; ") && error.contains("at byte"), "{kind} cut at {len}: {error}");
        }
    }
}

#[test]
fn flipped_bytes_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flipped");
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    for (kind, bytes) in files(folder.path()) {
        let rounds = if kind == "db3" { 25 } else { 300 };
        for _ in 0..rounds {
            let mut damaged = bytes.clone();
            for _ in 0..random.random_range(1..4) {
                let at = random.random_range(0..damaged.len());
                // Large lengths are the likeliest to hurt.
                damaged[at] = if random.random() { 0xff } else { random.next_u32() as u8 };
            }
            std::fs::write(&path, &damaged).unwrap();
            if let Some(error) = outcome(&path) {
                assert!(error.contains("; ") || error.contains("topic"), "{kind}: {error}");
            }
        }
    }
}

#[test]
fn flipped_bytes_in_packed_chunks_are_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flipped");
    let messages = some_messages(0, 60);
    let files = [
        bag("bz2", 60, &messages),
        mcap_file(None, true, true, &messages),
        mcap_file(Some(mcap::Compression::Lz4), true, true, &messages),
        mcap_file(Some(mcap::Compression::Zstd), true, true, &messages),
    ];
    let sound = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        open(&path).ok().map(|recording| messages_of(&recording))
    };
    for bytes in files {
        for at in (0..bytes.len()).step_by(11) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            // Damage outside the messages (padding, statistics, indices that are not used) may pass; wrong messages may
            // not.
            if let Some((read, None)) = sound(&damaged) {
                let data = |messages: &[crate::Message]| messages.iter().map(|m| m.2.clone()).collect::<Vec<_>>();
                assert!(
                    data(&read) == data(&messages),
                    "a flip at {at} of {} changed what was read: {:?}",
                    bytes.len(),
                    read
                );
            }
        }
    }
}

#[test]
fn bombs_are_refused_before_they_unfold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bomb");
    // A chunk that declares four gibibytes.
    let mut bytes = bag("lz4", 40, &some_messages(0, 40));
    let at = bytes.windows(5).position(|window| window == b"size=").unwrap() + 5;
    bytes[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    std::fs::write(&path, &bytes).unwrap();
    assert!(outcome(&path).unwrap().contains("to hold at most"));
    // A message of zeros that unfolds to more than the limit is cut off at the limit; here, one that is merely large
    // passes.
    let zeros = vec![0_u8; 1 << 22];
    let message = ("/a".to_owned(), 5, zstd::bulk::compress(&zeros, 3).unwrap());
    db3_file(&path.with_extension("db3"), &["PRAGMA synchronous = OFF"], &[message]);
    let (read, error) = messages_of(&open(&path.with_extension("db3")).unwrap());
    assert!(error.is_none() && read[0].2 == zeros);
}

#[test]
fn a_database_that_is_being_written_or_is_hostile_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.db3");
    db3_file(&path, &[], &some_messages(0, 3));
    std::fs::write(folder.path().join("log.db3-wal"), b"changes").unwrap();
    assert!(outcome(&path).unwrap().contains("in a log beside it"));

    // Tables that are views, which may never end.
    let path = folder.path().join("views.db3");
    let endless = "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) \
        SELECT i AS id, 1 AS topic_id, i AS timestamp, x'00' AS data FROM n";
    db3_file(&path, &["DROP TABLE messages", endless], &[]);
    assert!(outcome(&path).unwrap().contains("looking for the tables"));

    // Values of other types than rosbag2 writes.
    let path = folder.path().join("types.db3");
    db3_file(&path, &["INSERT INTO messages VALUES (1, 1, 'noon', 'text')"], &[]);
    assert!(outcome(&path).unwrap().contains("; "));

    // One that another program holds.
    let path = folder.path().join("locked.db3");
    db3_file(&path, &[], &some_messages(0, 3));
    let work = async {
        use sqlx::{ConnectOptions, Executor};
        let options = sqlx::sqlite::SqliteConnectOptions::new().filename(&path);
        let mut connection = options.disable_statement_logging().connect().await.unwrap();
        connection.execute("BEGIN EXCLUSIVE").await.unwrap();
        outcome(&path)
    };
    let error = tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(work).unwrap();
    assert!(error.contains("locked") && error.contains("stop the program"), "{error}");
}

#[test]
fn other_files_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.bag");
    let zstd = zstd::bulk::compress(&[0; 100], 3).unwrap();
    let others: [(&[u8], &str); 4] = [
        (b"#ROSBAG V1.2\nfoo", "rosbag fix"),
        (b"hello, world, hello", "give a recording"),
        // Expanded, it is no recording either.
        (&zstd, "give a recording"),
        (b"#ROSB", "copy it again"),
    ];
    for (bytes, advice) in others {
        std::fs::write(&path, bytes).unwrap();
        let error = outcome(&path).unwrap();
        assert!(error.contains(advice) && error.contains("at byte 0"), "{error}");
    }
    let error = outcome(folder.path()).unwrap();
    assert!(error.contains("ros2 bag reindex"), "{error}");
    std::fs::write(
        folder.path().join("metadata.yaml"),
        "rosbag2_bagfile_information:\n  relative_file_paths: [../../etc/passwd]\n",
    )
    .unwrap();
    let error = outcome(folder.path()).unwrap();
    assert!(error.contains("passwd") && !error.contains(".."), "never looked for outside the folder: {error}");
}
