//! Memory is flat: a recording that is four times as long takes no more of it.

use crate::Message;
use crate::bag_writer::bag;
use crate::each_message;
use crate::written::mcap_file;
use furrow_ingest::recording::open;
use std::path::Path;

/// The recording that [`read_and_tell_the_peak`] reads.
const LONG: &str = "FURROW_TEST_LONG_RECORDING";
const MESSAGE_BYTES: usize = 1 << 18;
/// What the peaks of two runs may differ by, in KiB: threads come to their work in another order.
const MOST_KIB: usize = 8 << 10;

/// The peak of the memory that a process takes that does nothing but read, in KiB, as Linux counts it.
fn peak_kib(path: &Path, bytes: Vec<u8>) -> usize {
    std::fs::write(path, bytes).unwrap();
    let mut child = std::process::Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "memory::read_and_tell_the_peak", "--ignored", "--nocapture"]).env(LONG, path);
    let printed = String::from_utf8(child.output().unwrap().stdout).unwrap();
    let line = printed.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.unwrap_or_else(|| panic!("{printed}")).trim().trim_end_matches(" kB").parse().unwrap()
}

#[test]
fn a_recording_four_times_as_long_takes_no_more_memory() {
    let folder = tempfile::tempdir().unwrap();
    let message = |i: usize| ("/a".to_owned(), i as i64, vec![i as u8; MESSAGE_BYTES]);
    let messages: Vec<Message> = (0..256).map(message).collect();
    // Were chunks kept, the difference would be this.
    const { assert!((256 - 64) * MESSAGE_BYTES / 1024 > 4 * MOST_KIB) };
    let files = |count: usize| {
        let messages = &messages[..count];
        let mcap = |packing| mcap_file(packing, true, true, messages);
        [
            ("bag, none", bag("none", 4, messages)),
            ("bag, lz4", bag("lz4", 4, messages)),
            ("mcap, none", mcap(None)),
            ("mcap, lz4", mcap(Some(mcap::Compression::Lz4))),
            ("mcap, zstd", mcap(Some(mcap::Compression::Zstd))),
            ("mcap, no chunks", mcap_file(None, false, true, messages)),
        ]
    };
    let path = folder.path().join("recording");
    for ((name, short), (_, long)) in files(64).into_iter().zip(files(256)) {
        let [short, long] = [short, long].map(|bytes| peak_kib(&path, bytes));
        eprintln!("{name}: {short} KiB, four times as long {long} KiB");
        assert!(long < short + MOST_KIB, "{name}: {short} KiB, four times as long {long} KiB");
    }
}

/// Only for [`peak_kib`].
#[test]
#[ignore = "run by another test in a process of its own"]
fn read_and_tell_the_peak() {
    let Some(path) = std::env::var_os(LONG) else { return };
    let mut messages = 0;
    let error = each_message(&open(Path::new(&path)).unwrap(), &mut |_, _, bytes| {
        messages += usize::from(bytes.len() == MESSAGE_BYTES);
    });
    assert!(error.is_none() && messages.is_multiple_of(64), "{error:?} after {messages} messages");
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    println!("\n{}", status.lines().find(|line| line.starts_with("VmHWM:")).unwrap());
}
