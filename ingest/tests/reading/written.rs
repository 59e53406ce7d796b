//! Containers written here, each read back whole.

use crate::bag_writer::bag;
use crate::{Message, messages_of};
use furrow_ingest::recording::{Encoding, open, open_many};
use sqlx::{AssertSqlSafe, ConnectOptions, Connection};
use std::path::{Path, PathBuf};

/// Messages on two topics, of sizes that do and do not compress, 10 ms apart.
pub fn some_messages(first: usize, count: usize) -> Vec<Message> {
    let data =
        |i: usize| if i.is_multiple_of(3) { vec![7; 40 + i] } else { format!("message {i} {}", i * i).into_bytes() };
    let topic = |i: usize| if i.is_multiple_of(2) { "/a" } else { "/b" };
    let one = |i: usize| (topic(i).to_owned(), 1_700_000_000_000_000_000 + i as i64 * 10_000_000, data(i));
    (first..first + count).map(one).collect()
}

pub fn mcap_file(compression: Option<mcap::Compression>, chunks: bool, summary: bool, messages: &[Message]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let options = mcap::WriteOptions::new().compression(compression).use_chunks(chunks).chunk_size(Some(300));
    let options = options.profile("ros2").emit_summary_records(summary).emit_message_indexes(summary);
    let mut writer = options.create(&mut bytes).unwrap();
    let schema = writer.add_schema("std_msgs/msg/String", "ros2msg", b"string data").unwrap();
    let none = std::collections::BTreeMap::new();
    let channels = ["/a", "/b"].map(|topic| writer.add_channel(schema, topic, "cdr", &none).unwrap());
    for (topic, ns, data) in messages {
        let channel_id = channels[usize::from(topic == "/b")];
        let header =
            mcap::records::MessageHeader { channel_id, sequence: 0, log_time: *ns as u64, publish_time: *ns as u64 };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    bytes.into_inner()
}

pub fn db3_file(path: &Path, statements: &[&str], messages: &[Message]) {
    let options = sqlx::sqlite::SqliteConnectOptions::new().filename(path).create_if_missing(true);
    let work = async {
        let mut connection = options.disable_statement_logging().connect().await.unwrap();
        let tables = [
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, \
             serialization_format TEXT NOT NULL)",
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, \
             data BLOB NOT NULL)",
            "INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/String', 'cdr'), \
             (2, '/b', 'std_msgs/msg/String', 'cdr')",
        ];
        for sql in tables.iter().chain(statements) {
            sqlx::query(AssertSqlSafe((*sql).to_owned())).execute(&mut connection).await.unwrap();
        }
        for (topic, ns, data) in messages {
            let insert = sqlx::query("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
            let id = 1 + i64::from(topic == "/b");
            insert.bind(id).bind(*ns).bind(&data[..]).execute(&mut connection).await.unwrap();
        }
        connection.close().await.unwrap();
    };
    tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(work);
}

fn check(path: &Path, encoding: Encoding, expected: &[Message]) {
    let recording = open(path).unwrap();
    let (messages, error) = messages_of(&recording);
    assert!(error.is_none(), "{error:?}");
    assert!(messages == expected, "{}: {} messages for {}", path.display(), messages.len(), expected.len());
    assert_eq!(recording.first_ns(), expected.iter().map(|message| message.1).min());
    for topic in recording.topics() {
        let expected = expected.iter().filter(|message| message.0 == topic.name).count() as u64;
        assert_eq!((topic.messages, topic.encoding), (Some(expected), encoding), "{}", path.display());
        assert_eq!(topic.type_name, "std_msgs/String");
    }
}

#[test]
fn bags_of_every_compression_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let messages = some_messages(0, 200);
    for compression in ["none", "bz2", "lz4"] {
        // Names do not matter.
        let path = folder.path().join(format!("{compression}.mcap"));
        std::fs::write(&path, bag(compression, 7, &messages)).unwrap();
        check(&path, Encoding::Ros1, &messages);
    }
}

#[test]
fn mcap_files_of_every_form_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let (path, messages) = (folder.path().join("recording"), some_messages(0, 200));
    for compression in [None, Some(mcap::Compression::Lz4), Some(mcap::Compression::Zstd)] {
        for (chunks, summary) in [(true, true), (true, false), (false, true), (false, false)] {
            std::fs::write(&path, mcap_file(compression, chunks, summary, &messages)).unwrap();
            check(&path, Encoding::Cdr, &messages);
        }
    }
}

#[test]
fn databases_of_every_form_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let messages = some_messages(0, 5000);
    let packed = |(topic, ns, data): &Message| (topic.clone(), *ns, zstd::bulk::compress(data, 3).unwrap());
    let packed: Vec<Message> = messages.iter().map(packed).collect();
    let index = "CREATE INDEX timestamp_idx ON messages (timestamp ASC)";
    let (sync, wal) = ("PRAGMA synchronous = OFF", "PRAGMA journal_mode = WAL");
    let forms: [(&str, &[&str], &[Message]); 4] = [
        ("indexed ? # %.db3", &[sync, index], &messages),
        ("bare", &[sync], &messages),
        ("packed", &[sync, index], &packed),
        ("ahead", &[sync, wal, index], &messages),
    ];
    for (name, statements, written) in forms {
        let path = folder.path().join(name);
        db3_file(&path, statements, written);
        check(&path, Encoding::Cdr, &messages);
        // Also from inside an async runtime.
        let inside = async { open(&path).map(|recording| recording.topics().len()) };
        assert_eq!(tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(inside).unwrap(), 2);
    }
}

#[test]
fn a_database_without_a_time_index_comes_in_order_of_writing_and_an_indexed_one_by_time() {
    let folder = tempfile::tempdir().unwrap();
    let mut messages = some_messages(0, 9000);
    messages.swap(3, 8000);
    let (bare, indexed) = (folder.path().join("bare"), folder.path().join("indexed"));
    db3_file(&bare, &["PRAGMA synchronous = OFF"], &messages);
    db3_file(&indexed, &["PRAGMA synchronous = OFF", "CREATE INDEX t ON messages (timestamp)"], &messages);
    let times = |path: &Path| messages_of(&open(path).unwrap()).0.iter().map(|message| message.1).collect::<Vec<_>>();
    assert!(times(&indexed).is_sorted());
    assert!(!times(&bare).is_sorted() && times(&bare).len() == 9000);
}

#[test]
fn files_that_overlap_are_merged_by_time() {
    let folder = tempfile::tempdir().unwrap();
    let messages = some_messages(0, 300);
    let on_topic = |topic: &str| messages.iter().filter(|message| message.0 == topic).cloned().collect::<Vec<_>>();
    let paths: Vec<PathBuf> = ["late", "a", "b"].iter().map(|name| folder.path().join(name)).collect();
    std::fs::write(&paths[0], bag("lz4", 5, &some_messages(300, 50))).unwrap();
    std::fs::write(&paths[1], bag("none", 5, &on_topic("/a"))).unwrap();
    std::fs::write(&paths[2], mcap_file(None, true, true, &on_topic("/b"))).unwrap();
    let merged = messages_of(&open_many(&paths).unwrap()).0;
    assert!(merged == some_messages(0, 350));
    assert!(open_many(&[]).is_err());
}

#[test]
fn topics_that_are_not_there_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.bag");
    std::fs::write(&path, bag("none", 5, &some_messages(0, 10))).unwrap();
    let read = open(&path).unwrap().read::<()>(&["/c"], &mut |_| (), &mut |_| std::ops::ControlFlow::Continue(()));
    let error = read.unwrap_err().to_string();
    assert!(error.contains("/c") && error.contains("/a, /b"), "{error}");
}
