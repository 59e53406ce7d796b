//! Records: opcode, 64-bit length, body. Lengths are checked here against the bytes that there are, before the `mcap`
//! crate parses a body.

use crate::recording::topic::Encoding;
use mcap::records::{Record, op};
use std::collections::BTreeMap;
use std::ops::Range;

/// Opcode and length.
pub(super) const RECORD_HEADER_BYTES: u64 = 9;

/// A record's opcode and the length of its body.
pub(super) fn read_header(bytes: [u8; RECORD_HEADER_BYTES as usize]) -> (u8, u64) {
    let [opcode, len @ ..] = bytes;
    (opcode, u64::from_le_bytes(len))
}

/// The records in `bytes`, as opcode and place of the body; the offset of the first that does not fit is an error.
pub(super) fn records(bytes: &[u8]) -> impl Iterator<Item = Result<(u8, Range<usize>), usize>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = bytes.get(at..).filter(|rest| !rest.is_empty())?;
        let start = at;
        let fitting = rest.split_first_chunk().and_then(|(head, body)| {
            let (opcode, len) = read_header(*head);
            let len = usize::try_from(len).ok().filter(|&len| len <= body.len())?;
            let body = start + head.len()..start + head.len() + len;
            Some((opcode, body))
        });
        at = fitting.as_ref().map_or(bytes.len(), |(_, body)| body.end);
        Some(fitting.ok_or(start))
    })
}

/// What stands before a message's data.
pub(super) struct MessageHead {
    pub(super) channel: u16,
    pub(super) log_time_ns: i64,
}

impl MessageHead {
    /// Channel, sequence, log time, publish time.
    pub(super) const BYTES: usize = 22;

    /// The head of a message's body.
    pub(super) fn read(body: &[u8]) -> Option<Self> {
        let (channel, rest) = body.split_first_chunk()?;
        let (_sequence, rest) = rest.split_first_chunk::<4>()?;
        let (log_time, _) = rest.split_first_chunk()?;
        let log_time_ns = i64::try_from(u64::from_le_bytes(*log_time)).unwrap_or(i64::MAX);
        (body.len() >= Self::BYTES).then_some(Self { channel: u16::from_le_bytes(*channel), log_time_ns })
    }
}

/// The channels of a file and the names of their schemas.
#[derive(Debug, Default)]
pub(super) struct Channels {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (String, u16, Encoding)>,
}

impl Channels {
    /// Reads a schema or channel record; others are passed over. Returns what is wrong with it.
    pub(super) fn read(&mut self, opcode: u8, body: &[u8]) -> Result<(), String> {
        if opcode != op::SCHEMA && opcode != op::CHANNEL {
            return Ok(());
        }
        match mcap::parse_record(opcode, body).map_err(|error| error.to_string())? {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let encoding = Encoding::from_name(&channel.message_encoding);
                self.channels.insert(channel.id, (channel.topic, channel.schema_id, encoding));
            }
            _ => {}
        }
        Ok(())
    }

    /// How many channels are known.
    pub(super) fn len(&self) -> usize {
        self.channels.len()
    }

    /// Whether a channel is known.
    pub(super) fn knows(&self, channel: u16) -> bool {
        self.channels.contains_key(&channel)
    }

    /// Each channel's id, topic, type and encoding, by id.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u16, &str, &str, Encoding)> {
        self.channels.iter().map(|(&id, (topic, schema, encoding))| {
            (id, topic.as_str(), self.schemas.get(schema).map_or("", String::as_str), *encoding)
        })
    }
}
