//! The messages of a chunk, or of a run of bare records.

use super::record::{Channels, MessageHead, records};
use crate::recording::block::{Block, Entry};
use crate::recording::chunk::{ChunkAt, MOST_CHUNK_BYTES};
use crate::recording::error::{COPY_OR_SALVAGE, DAMAGED, ReadError};
use crate::recording::jobs::DecodeChunk;
use crate::recording::topic::Encoding;
use crate::recording::unpack::unpack_message;
use mcap::records::op;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Decodes chunks of a file.
pub(super) struct ChunkDecoder {
    /// The file, for errors.
    pub(super) path: PathBuf,
    /// The topic of each channel, `None` where it is not wanted, and its encoding.
    pub(super) channels: BTreeMap<u16, (Option<usize>, Encoding)>,
}

impl DecodeChunk for ChunkDecoder {
    fn decode(&self, at: &ChunkAt, start: usize, block: &mut Block) -> Result<(), ReadError> {
        let damaged = |expected: String, found: String| damaged_chunk(&self.path, at, expected, found);
        let Block { bytes, entries } = block;
        let (chunk, mut unpacked) = (&bytes[start..], Vec::new());
        for record in records(chunk) {
            let (opcode, body) = record.map_err(|inside| record_too_long(&self.path, at, inside))?;
            if opcode != op::MESSAGE {
                continue;
            }
            let head = MessageHead::read(&chunk[body.clone()]);
            let too_short = || damaged("a message of at least 22 bytes".to_owned(), format!("{} bytes", body.len()));
            let head = head.ok_or_else(too_short)?;
            let unknown = || damaged("a message of a known channel".to_owned(), format!("channel {}", head.channel));
            let channel = self.channels.get(&head.channel).copied();
            let (Some(topic), encoding) = channel.ok_or_else(unknown)? else { continue };
            let data = body.start + MessageHead::BYTES..body.end;
            let most = MOST_CHUNK_BYTES - unpacked.len() as u64;
            let plain = (encoding == Encoding::Cdr).then(|| unpack_message(&chunk[data.clone()], most)).flatten();
            let data = match plain {
                None => start + data.start..start + data.end,
                Some(plain) => {
                    let plain = plain.map_err(|error| damaged("a zstd message".to_owned(), error.to_string()))?;
                    let first = bytes.len() + unpacked.len();
                    unpacked.extend_from_slice(&plain);
                    first..bytes.len() + unpacked.len()
                }
            };
            entries.push(Entry { topic, receive_ns: head.log_time_ns, bytes: data });
        }
        bytes.extend_from_slice(&unpacked);
        Ok(())
    }
}

/// Adds the channels and messages in a chunk's data to those that are known.
pub(super) fn count_messages(
    path: &Path,
    at: &ChunkAt,
    data: &[u8],
    channels: &mut Channels,
    counts: &mut BTreeMap<u16, u64>,
) -> Result<(), ReadError> {
    for record in records(data) {
        let (opcode, body) = record.map_err(|inside| record_too_long(path, at, inside))?;
        let body = &data[body];
        let wrong_channel = |found| damaged_chunk(path, at, "a schema or channel".to_owned(), found);
        channels.read(opcode, body).map_err(wrong_channel)?;
        if let Some(head) = (opcode == op::MESSAGE).then(|| MessageHead::read(body)).flatten() {
            *counts.entry(head.channel).or_default() += 1;
        }
    }
    Ok(())
}

fn damaged_chunk(path: &Path, at: &ChunkAt, expected: String, found: String) -> ReadError {
    ReadError::unexpected(path, at.offset, expected, found, DAMAGED)
}

fn record_too_long(path: &Path, at: &ChunkAt, inside: usize) -> ReadError {
    let expected = format!("a whole record {inside} bytes into the chunk's data");
    ReadError::unexpected(path, at.offset, expected, "one longer than the chunk", COPY_OR_SALVAGE)
}
