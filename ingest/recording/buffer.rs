//! Memory that is used again.

use std::ops::Deref;

/// Bytes that grow and are cleared. What was allocated once is neither freed nor zeroed before it is filled anew: for
/// chunks of a megabyte, the page faults of fresh memory cost more than reading or unpacking.
#[derive(Debug, Default)]
pub(crate) struct Buffer {
    bytes: Vec<u8>,
    len: usize,
}

impl Buffer {
    /// Forgets the bytes and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Forgets the bytes behind the first `len`.
    pub(crate) fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// How much memory it keeps, in bytes.
    pub(crate) fn capacity(&self) -> usize {
        self.bytes.len()
    }

    /// `more` bytes at the end, to be filled: they hold anything. Of fresh memory, only what is filled is taken from
    /// the machine, whatever a damaged file declares.
    pub(crate) fn grow(&mut self, more: usize) -> &mut [u8] {
        let start = self.len;
        let end = start + more;
        if end > self.bytes.len() {
            let mut larger = vec![0; end.max(2 * self.bytes.len())];
            larger[..start].copy_from_slice(&self.bytes[..start]);
            self.bytes = larger;
        }
        self.len = end;
        &mut self.bytes[start..end]
    }

    /// Adds bytes at the end.
    pub(crate) fn extend_from_slice(&mut self, bytes: &[u8]) {
        self.grow(bytes.len()).copy_from_slice(bytes);
    }
}

impl Deref for Buffer {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        &self.bytes[..self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::Buffer;

    #[test]
    fn what_is_added_stands_there_and_cleared_memory_is_kept() {
        let mut buffer = Buffer::default();
        buffer.extend_from_slice(b"one");
        buffer.grow(5).copy_from_slice(b", two");
        assert_eq!(&*buffer, b"one, two");
        buffer.truncate(3);
        buffer.extend_from_slice(b"!");
        assert_eq!(&*buffer, b"one!");
        let capacity = buffer.capacity();
        buffer.clear();
        assert!(buffer.is_empty() && buffer.capacity() == capacity);
        assert_eq!(buffer.grow(2).len(), 2);
    }
}
