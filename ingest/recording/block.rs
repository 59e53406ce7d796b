//! Blocks of messages: what a container hands over at a time.

use std::ops::Range;

/// One message of a block.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// The topic's place among its part's topics.
    pub(crate) topic: usize,
    /// When the recorder got it, nanoseconds.
    pub(crate) receive_ns: i64,
    /// Its bytes in the block.
    pub(crate) bytes: Range<usize>,
}

/// The messages of a chunk, a run of records or a page of rows, in order of receive time.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The bytes that entries point into.
    pub(crate) bytes: Vec<u8>,
    /// The messages.
    pub(crate) entries: Vec<Entry>,
}

impl Block {
    /// A block whose entries are put in order of receive time; ties keep their order.
    pub(crate) fn in_order(bytes: Vec<u8>, mut entries: Vec<Entry>) -> Self {
        entries.sort_by_key(|entry| entry.receive_ns);
        Self { bytes, entries }
    }
}
