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
/// What the peaks of two runs may differ by, in KiB: threads come to their work in another order. What is ahead of its
/// use is more memory, but does not depend on the length.
const MOST_KIB: u64 = 8 << 10;

/// The peak of the memory that a process takes that does nothing but read, in KiB, as Linux counts it.
fn peak_kib(folder: &Path, bytes: &[u8]) -> u64 {
    let path = folder.join("long");
    std::fs::write(&path, bytes).unwrap();
    let mut child = std::process::Command::new(std::env::current_exe().unwrap());
    child.args(["--exact", "memory::read_and_tell_the_peak", "--ignored", "--nocapture"]).env(LONG, &path);
    let printed = String::from_utf8(child.output().unwrap().stdout).unwrap();
    let line = printed.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.unwrap_or_else(|| panic!("{printed}")).trim().trim_end_matches(" kB").parse().unwrap()
}

#[test]
fn a_recording_four_times_as_long_takes_no_more_memory() {
    let folder = tempfile::tempdir().unwrap();
    let message = |i: usize| ("/a".to_owned(), i as i64, vec![i as u8; MESSAGE_BYTES]);
    let messages: Vec<Message> = (0..256).map(message).collect();
    // Were a chunk kept, the difference would be this.
    const { assert!((256 - 64) * MESSAGE_BYTES as u64 > 4 * MOST_KIB << 10) };
    let bag = |packing| move |messages: &[Message]| bag(packing, 4, messages);
    let mcap = |packing| move |messages: &[Message]| mcap_file(packing, true, true, messages);
    let writers: [(&str, &dyn Fn(&[Message]) -> Vec<u8>); 6] = [
        ("bag, none", &bag("none")),
        ("bag, lz4", &bag("lz4")),
        ("mcap, none", &mcap(None)),
        ("mcap, lz4", &mcap(Some(mcap::Compression::Lz4))),
        ("mcap, zstd", &mcap(Some(mcap::Compression::Zstd))),
        ("mcap, no chunks", &|messages| mcap_file(None, false, true, messages)),
    ];
    for (name, write) in writers {
        let [short, long] = [64, 256].map(|count| peak_kib(folder.path(), &write(&messages[..count])));
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
