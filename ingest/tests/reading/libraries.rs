//! What the crates `mcap` and `rosbag` get wrong on damaged files, each beside what furrow makes of the same file. A
//! test that fails after an update says that the crate has become better: the reading of that part may then be left to
//! it.

use crate::bag_writer::bag;
use crate::written::some_messages;
use crate::{each_message, messages_of};
use furrow_ingest::recording::open;
use mcap::records::op;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::panic::catch_unwind;
use std::path::Path;

/// An MCAP record.
fn record(opcode: u8, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat()
}

/// A message on channel 1 with `data`.
fn message(data: &[u8]) -> Vec<u8> {
    let head = [&1_u16.to_le_bytes()[..], &[0; 4], &5_u64.to_le_bytes(), &5_u64.to_le_bytes()].concat();
    record(op::MESSAGE, &[&head, data].concat())
}

/// A chunk without a CRC, as rosbag2's fastest profile writes them.
fn chunk(compression: &str, uncompressed_bytes: usize, data: &[u8]) -> Vec<u8> {
    let times = [0; 16];
    let (size, name) = ((uncompressed_bytes as u64).to_le_bytes(), compression.as_bytes());
    let lengths =
        [(name.len() as u32).to_le_bytes().to_vec(), name.to_vec(), (data.len() as u64).to_le_bytes().to_vec()];
    record(op::CHUNK, &[&times[..], &size, &[0; 4], &lengths.concat(), data].concat())
}

/// A whole file with one channel and these records in its data section, without a summary.
fn mcap_of(records: &[Vec<u8>]) -> Vec<u8> {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let header = record(op::HEADER, &[text("ros2"), text("test")].concat());
    let schema =
        [&1_u16.to_le_bytes()[..], &text("std_msgs/msg/String"), &text("ros2msg"), &text("string data")].concat();
    let channel = [&1_u16.to_le_bytes()[..], &1_u16.to_le_bytes(), &text("/a"), &text("cdr"), &[0; 4]].concat();
    let start = [mcap::MAGIC.to_vec(), header, record(op::SCHEMA, &schema), record(op::CHANNEL, &channel)].concat();
    let end = [record(op::DATA_END, &[0; 4]), record(op::FOOTER, &[0; 20]), mcap::MAGIC.to_vec()].concat();
    [start, records.concat(), end].concat()
}

/// The messages that `mcap` reads with all its checks on, and whether it came to the end without an error.
fn read_by_mcap(bytes: &[u8]) -> (Vec<Vec<u8>>, bool) {
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_check_finishes_after_end_magic(true)
        .with_record_length_limit(1 << 30);
    let (mut reader, mut rest, mut messages) = (LinearReader::new_with_options(options), bytes, Vec::new());
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(need)) => {
                let taken = need.min(rest.len());
                reader.insert(taken).copy_from_slice(&rest[..taken]);
                reader.notify_read(taken);
                rest = &rest[taken..];
            }
            Ok(LinearReadEvent::Record { opcode, data }) if opcode == op::MESSAGE => messages.push(data[22..].to_vec()),
            Ok(LinearReadEvent::Record { .. }) => {}
            Err(_) => return (messages, false),
        }
    }
    (messages, true)
}

/// The error of opening or reading `bytes`; `None` where all went well.
fn read_by_furrow(bytes: &[u8]) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recording");
    std::fs::write(&path, bytes).unwrap();
    match open(&path) {
        Err(error) => Some(error.to_string()),
        Ok(recording) => each_message(&recording, &mut |_, _, _| ()).map(|error| error.to_string()),
    }
}

#[test]
fn both_read_a_sound_file() {
    let both = [message(b"one"), message(b"two")].concat();
    let bytes = mcap_of(&[chunk("", both.len(), &both), message(b"bare")]);
    assert_eq!(read_by_mcap(&bytes), (vec![b"one".to_vec(), b"two".to_vec(), b"bare".to_vec()], true));
    assert_eq!(read_by_furrow(&bytes), None);
}

#[test]
fn mcap_passes_over_a_hole_of_zeros() {
    // A file system that lost a block leaves zeros. They read as records of opcode 0 and length 0, nine bytes each.
    let lost = message(b"five!");
    assert_eq!(lost.len() % 9, 0);
    let bytes = mcap_of(&[message(b"one"), vec![0; lost.len()], message(b"three")]);
    assert_eq!(read_by_mcap(&bytes), (vec![b"one".to_vec(), b"three".to_vec()], true));
    let error = read_by_furrow(&bytes).unwrap();
    assert!(error.contains("at byte") && error.contains("found opcode 0"), "{error}");
}

#[test]
fn mcap_loses_what_a_chunk_holds_beyond_its_declared_length() {
    let (one, two) = (message(b"one"), message(b"two"));
    let packed = zstd::bulk::compress(&[one.clone(), two].concat(), 3).unwrap();
    let bytes = mcap_of(&[chunk("zstd", one.len(), &packed)]);
    assert_eq!(read_by_mcap(&bytes), (vec![b"one".to_vec()], true));
    let error = read_by_furrow(&bytes).unwrap();
    assert!(error.contains("unpacked, found more"), "{error}");
}

#[test]
fn mcap_hands_over_bytes_from_behind_a_chunk() {
    // The chunk's only record is longer than the chunk by the whole message behind it.
    let behind = message(b"not of this message");
    let mut long = message(b"one");
    let body = (long.len() - 9 + behind.len()) as u64;
    long[1..9].copy_from_slice(&body.to_le_bytes());
    let bytes = mcap_of(&[chunk("", long.len(), &long), behind.clone()]);
    // A debug build of the crate panics where a release build goes on.
    if let Ok((messages, _)) = catch_unwind(|| read_by_mcap(&bytes)) {
        assert_eq!(messages[0], [&b"one"[..], &behind].concat());
    }
    let error = read_by_furrow(&bytes).unwrap();
    assert!(error.contains("longer than the chunk"), "{error}");
}

#[test]
fn mcap_cannot_pass_over_a_chunk() {
    // Opening a recording would read all of it: the crate wants every chunk whole before it tells of the next record.
    let data = message(&vec![7; 1 << 20]);
    let bytes = mcap_of(&[chunk("", data.len(), &data)]);
    let mut reader = LinearReader::new_with_options(LinearReaderOptions::default().with_emit_chunks(true));
    let (mut rest, mut largest) = (&bytes[..], 0);
    while let Some(event) = reader.next_event() {
        if let LinearReadEvent::ReadRequest(need) = event.unwrap() {
            largest = largest.max(need);
            reader.insert(need).copy_from_slice(&rest[..need]);
            reader.notify_read(need);
            rest = &rest[need..];
        }
    }
    assert!(largest > 1 << 20 && rest.is_empty());
}

/// A bag with the value of the bag header's `index_pos` replaced.
fn bag_with_index_at(index_pos: u64) -> Vec<u8> {
    let mut bytes = bag("none", 9, &some_messages(0, 40));
    let at = bytes.windows(10).position(|window| window == b"index_pos=").unwrap() + 10;
    bytes[at..at + 8].copy_from_slice(&index_pos.to_le_bytes());
    bytes
}

/// Reads every chunk of a bag with the crate `rosbag`.
fn read_by_rosbag(path: &Path) -> rosbag::Result<usize> {
    let bag = rosbag::RosBag::new(path).unwrap();
    let mut messages = 0;
    for record in bag.chunk_records() {
        if let rosbag::ChunkRecord::Chunk(chunk) = record? {
            for message in chunk.messages() {
                messages += usize::from(matches!(message?, rosbag::MessageRecord::MessageData(_)));
            }
        }
    }
    Ok(messages)
}

#[test]
fn rosbag_panics_on_truncated_and_unindexed_bags() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.bag");
    for (index_pos, reason) in [(1 << 40, "where the file ends"), (0, "not indexed")] {
        let bytes = bag_with_index_at(index_pos);
        std::fs::write(&path, &bytes).unwrap();
        assert!(catch_unwind(|| read_by_rosbag(&path).map(|_| ())).is_err(), "index_pos {index_pos}");
        let error = read_by_furrow(&bytes).unwrap();
        assert!(error.contains(reason), "{error}");
    }
}

/// The offset of the first chunk's declared size.
fn declared_size_at(bytes: &[u8]) -> usize {
    bytes.windows(5).position(|window| window == b"size=").unwrap() + 5
}

#[test]
fn rosbag_loses_what_a_bz2_chunk_holds_beyond_its_declared_length() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.bag");
    let mut bytes = bag("bz2", 2, &some_messages(0, 2));
    std::fs::write(&path, &bytes).unwrap();
    assert_eq!(read_by_rosbag(&path).unwrap(), 2);
    // The first of the two messages as a chunk of its own says how long it is.
    let first = bag("none", 1, &some_messages(0, 1));
    let size = first[declared_size_at(&first)..][..4].to_vec();
    let at = declared_size_at(&bytes);
    bytes[at..at + 4].copy_from_slice(&size);
    std::fs::write(&path, &bytes).unwrap();
    assert_eq!(read_by_rosbag(&path).unwrap(), 1);
    let error = read_by_furrow(&bytes).unwrap();
    assert!(error.contains("unpacked, found more"), "{error}");
}

/// The path of a bag that a child process reads while it becomes shorter.
#[cfg(unix)]
const SHRINKING_BAG: &str = "FURROW_TEST_SHRINKING_BAG";

#[cfg(unix)]
#[test]
fn rosbag_kills_the_process_when_a_bag_becomes_shorter() {
    use std::os::unix::process::ExitStatusExt;
    const SIGBUS: i32 = 7;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shrinking.bag");
    let message = ("/a".to_owned(), 5, vec![7; 1 << 16]);
    let bytes = bag("none", 1, &[message.clone(), message]);
    std::fs::write(&path, &bytes).unwrap();
    let mut child = std::process::Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "libraries::shrink_a_bag_that_rosbag_reads", "--ignored"]).env(SHRINKING_BAG, &path);
    assert_eq!(child.output().unwrap().status.signal(), Some(SIGBUS));

    std::fs::write(&path, &bytes).unwrap();
    let recording = open(&path).unwrap();
    shorten(&path);
    let error = messages_of(&recording).1.unwrap().to_string();
    assert!(error.contains("to the end of the file"), "{error}");
}

#[cfg(unix)]
fn shorten(path: &Path) {
    std::fs::OpenOptions::new().write(true).open(path).unwrap().set_len(8192).unwrap();
}

/// Only for [`rosbag_kills_the_process_when_a_bag_becomes_shorter`].
#[cfg(unix)]
#[test]
#[ignore = "run by another test in a process of its own"]
fn shrink_a_bag_that_rosbag_reads() {
    let Some(path) = std::env::var_os(SHRINKING_BAG) else { return };
    let bag = rosbag::RosBag::new(&path).unwrap();
    shorten(Path::new(&path));
    assert!(bag.chunk_records().count() > 0);
}
