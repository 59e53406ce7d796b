//! The summary section: its CRC, channels and statistics, the footer and the closing magic, read by the `mcap` crate.

use super::record::{Channels, RECORD_HEADER_BYTES};
use crate::recording::chunk::MOST_CHUNK_BYTES;
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::file::Source;
use mcap::McapError;
use mcap::records::{Record, Statistics, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// Reads from the record at which `source` stands, which ends the data section, to the end of the file. Adds the
/// section's channels to those that are known and returns its statistics.
pub(super) fn read_summary(source: &mut Source, channels: &mut Channels) -> Result<Option<Statistics>, ReadError> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_emit_chunks(true)
        .with_validate_summary_section_crc(true)
        .with_record_length_limit(MOST_CHUNK_BYTES as usize);
    let mut reader = LinearReader::new_with_options(options);
    let mut offset = source.at();
    let mut statistics = None;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(bytes)) => {
                // Refused here where the file is shorter, before anything is allocated for it.
                source.check(bytes as u64, "the summary section")?;
                source.fill(reader.insert(bytes), "the summary section")?;
                reader.notify_read(bytes);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                let read = read_record(opcode, data, channels).map_err(|found| wrong_record(source, offset, found))?;
                statistics = read.or(statistics);
                offset += RECORD_HEADER_BYTES + data.len() as u64;
            }
            Err(error) => return Err(summary_error(source, offset, &error)),
        }
    }
    if source.at() == source.len() {
        return Ok(statistics);
    }
    let found = format!("{} bytes after the closing magic", source.len() - source.at());
    Err(ReadError::unexpected(source.path(), source.at(), "the end of the file", found, DAMAGED))
}

/// Reads a record: its statistics, if it has them, and its channel into `channels`. Returns what is wrong with it.
fn read_record(opcode: u8, data: &[u8], channels: &mut Channels) -> Result<Option<Statistics>, String> {
    match opcode {
        0 => Err("opcode 0".to_owned()),
        op::MESSAGE | op::CHUNK | op::MESSAGE_INDEX => {
            Err(format!("a record of the data section, opcode {opcode:#04x}"))
        }
        op::STATISTICS => match mcap::parse_record(opcode, data) {
            Ok(Record::Statistics(statistics)) => Ok(Some(statistics)),
            Ok(_) => Ok(None),
            Err(error) => Err(format!("statistics that cannot be read: {error}")),
        },
        _ => channels.read(opcode, data).map(|()| None),
    }
}

fn wrong_record(source: &Source, offset: u64, found: String) -> ReadError {
    ReadError::unexpected(source.path(), offset, "a record of the summary section", found, DAMAGED)
}

fn summary_error(source: &Source, offset: u64, error: &McapError) -> ReadError {
    let (expected, found) = match error {
        McapError::BadSummaryCrc { saved, calculated } => {
            (format!("a summary with CRC-32 {saved:08x} before the footer"), format!("{calculated:08x}"))
        }
        McapError::BadMagic => ("the closing magic at the end".to_owned(), "other bytes".to_owned()),
        McapError::RecordTooLarge { opcode, len } => {
            ("a record of at most 1 GiB".to_owned(), format!("{len} bytes of opcode {opcode:#04x}"))
        }
        other => ("a record of the summary section".to_owned(), other.to_string()),
    };
    ReadError::unexpected(source.path(), offset, expected, found, DAMAGED)
}
