//! Blocks of messages: what a container hands over at a time.

use super::buffer::Buffer;
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

/// The messages of some chunks, a run of records or a page of rows, in order of receive time within each of them.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The bytes that entries point into.
    pub(crate) bytes: Buffer,
    /// The messages.
    pub(crate) entries: Vec<Entry>,
}

impl Block {
    /// Forgets the messages and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.bytes.clear();
        self.entries.clear();
    }

    /// Puts the entries from the place `first` on in order of receive time; ties keep their order.
    pub(crate) fn put_in_order(&mut self, first: usize) {
        self.entries[first..].sort_by_key(|entry| entry.receive_ns);
    }
}
