//! The messages of a chunk.

use super::record::{Fields, counted, op};
use crate::recording::block::{Block, Entry};
use crate::recording::chunk::ChunkAt;
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::jobs::DecodeChunk;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Decodes chunks of a bag.
pub(super) struct ChunkDecoder {
    /// The file, for errors.
    pub(super) path: PathBuf,
    /// The topic of each connection, `None` where it is not wanted.
    pub(super) connections: BTreeMap<u32, Option<usize>>,
    /// By the chunk's offset: messages by connection, as its index says.
    pub(super) counts: BTreeMap<u64, BTreeMap<u32, u64>>,
}

impl DecodeChunk for ChunkDecoder {
    fn decode(&self, at: &ChunkAt, start: usize, block: &mut Block) -> Result<(), ReadError> {
        let damaged =
            |expected: String, found: String| ReadError::unexpected(&self.path, at.offset, expected, found, DAMAGED);
        let Block { bytes, entries } = block;
        let (mut counts, mut rest) = (BTreeMap::<u32, u64>::new(), &bytes[start..]);
        while !rest.is_empty() {
            let inside = bytes.len() - rest.len() - start;
            let no_record =
                || damaged(format!("a whole record {inside} bytes into a chunk"), "one that is not whole".to_owned());
            let (header, after) = counted(rest).ok_or_else(no_record)?;
            let (data, after) = counted(after).ok_or_else(no_record)?;
            let fields = Fields::new(header).ok_or_else(no_record)?;
            rest = after;
            match fields.u8("op") {
                Some(op::MESSAGE) => {
                    let (id, receive_ns) = fields.u32("conn").zip(fields.time_ns("time")).ok_or_else(no_record)?;
                    *counts.entry(id).or_default() += 1;
                    let topic = self.connections.get(&id).copied();
                    let Some(topic) = topic.ok_or_else(|| unknown_connection(&self.path, at.offset, id))? else {
                        continue;
                    };
                    let end = bytes.len() - rest.len();
                    entries.push(Entry { topic, receive_ns, bytes: end - data.len()..end });
                }
                Some(op::CONNECTION) => {}
                _ => return Err(no_record()),
            }
        }
        if self.counts.get(&at.offset).is_some_and(|index| *index != counts) {
            let expected = format!("{:?} messages by connection, as the chunk's index says", self.counts[&at.offset]);
            return Err(damaged(expected, format!("{counts:?}")));
        }
        Ok(())
    }
}

/// A message or index of a connection that the index section does not have.
pub(super) fn unknown_connection(path: &Path, offset: u64, id: u32) -> ReadError {
    let found = format!("connection {id}");
    ReadError::unexpected(path, offset, "a chunk of connections that the index names", found, DAMAGED)
}
