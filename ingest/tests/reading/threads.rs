//! Chunks are read on all threads; what comes, and in which order, does not depend on how many those are.

use crate::bag_writer::bag;
use crate::written::mcap_file;
use crate::{Message, messages_of};
use furrow_ingest::recording::open;
use rand::{Rng, SeedableRng};
use std::path::Path;

/// Messages of noise of many sizes, every two of them in the wrong order.
fn messages() -> Vec<Message> {
    let data = |i: usize| {
        let mut data = vec![0; 400 + i * 7919 % 50_000];
        rand_chacha::ChaCha8Rng::seed_from_u64(i as u64).fill_bytes(&mut data);
        data
    };
    let topic = |i: usize| if i.is_multiple_of(3) { "/a" } else { "/b" };
    (0..600).map(|i| (topic(i).to_owned(), 1_000 + (i ^ 1) as i64, data(i))).collect()
}

/// What comes from a file on some threads: the messages, and the error that ends them.
fn read(path: &Path, threads: usize) -> (Vec<Message>, Option<String>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (messages, error) = pool.install(|| messages_of(&open(path).unwrap()));
    (messages, error.map(|error| error.to_string()))
}

#[test]
fn messages_and_the_error_that_ends_them_are_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recording");
    let (messages, zstd) = (messages(), Some(mcap::Compression::Zstd));
    let files = [
        bag("none", 4, &messages),
        bag("lz4", 4, &messages),
        mcap_file(None, true, true, &messages),
        mcap_file(Some(mcap::Compression::Lz4), true, true, &messages),
        mcap_file(zstd, true, true, &messages),
    ];
    // Within a chunk, messages come by time. Those of the bags hold four messages, those of the MCAP files one.
    let mut by_time = messages.clone();
    by_time.sort_by_key(|message| message.1);
    for (place, sound) in files.into_iter().enumerate() {
        std::fs::write(&path, &sound).unwrap();
        let written = if place < 2 { &by_time } else { &messages };
        for threads in [1, 2, 5] {
            let (read, error) = read(&path, threads);
            assert!(error.is_none() && read == *written, "file {place}, {threads} threads: {error:?}");
        }
        if place < 2 {
            // In a bag, nothing tells a changed pixel.
            continue;
        }
        let mut damaged = sound;
        let middle = damaged.len() / 2;
        damaged[middle..middle + 64].fill(0xff);
        std::fs::write(&path, &damaged).unwrap();
        let (before, error) = read(&path, 1);
        assert!(error.is_some() && before.len() > 100 && before == written[..before.len()], "file {place}: {error:?}");
        for threads in [2, 5] {
            assert!(read(&path, threads) == (before.clone(), error.clone()), "file {place}, {threads} threads");
        }
    }
}
