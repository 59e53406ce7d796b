//! Chunks read from a file and unpacked within bounds.

use super::buffer::Buffer;
use super::chunk::{ChunkAt, Packing};
use super::error::{DAMAGED, ReadError};
use super::file::SharedFile;
use super::lz4::Lz4;
use std::io::Read;

/// Unpacks chunks, one after another, in memory that it keeps.
#[derive(Default)]
pub(crate) struct Unpacker {
    packed: Buffer,
    lz4: Lz4,
    zstd: zstd::bulk::Decompressor<'static>,
}

impl Unpacker {
    /// Adds a chunk's data to `data`: exactly as long as declared and with the declared CRC. After an error, anything
    /// may stand there.
    pub(crate) fn unpack(&mut self, file: &SharedFile, at: &ChunkAt, data: &mut Buffer) -> Result<(), ReadError> {
        let start = data.len();
        if at.packing == Packing::None {
            file.read_at(at.offset, data.grow(at.uncompressed_bytes as usize), "a chunk")?;
        } else {
            self.packed.clear();
            file.read_at(at.offset, self.packed.grow(at.bytes as usize), "a chunk")?;
            self.decompress(file, at, data)?;
        }
        let crc = if at.crc == 0 { 0 } else { crc32fast::hash(&data[start..]) };
        if crc != at.crc {
            return Err(damaged(file, at, format!("a chunk with CRC-32 {:08x}", at.crc), format!("{crc:08x}")));
        }
        Ok(())
    }

    fn decompress(&mut self, file: &SharedFile, at: &ChunkAt, data: &mut Buffer) -> Result<(), ReadError> {
        let start = data.len();
        // One byte more than declared tells the chunk that holds more.
        let (packed, room) = (&*self.packed, data.grow(at.uncompressed_bytes as usize + 1));
        let unpacked = match at.packing {
            Packing::None => Ok(0),
            Packing::Bz2 => read_into(bzip2::read::BzDecoder::new(packed), room),
            Packing::Lz4 => self.lz4.decompress(packed, room),
            // Where data do not fit, the stream's decoder gives what does; where they are damaged, it says so too.
            Packing::Zstd => self.zstd.decompress_to_buffer(packed, room).or_else(|_| {
                zstd::stream::read::Decoder::with_buffer(packed).and_then(|decoder| read_into(decoder, room))
            }),
        };
        let unpacked = unpacked
            .map_err(|error| damaged(file, at, format!("{:?} data of a chunk", at.packing), error.to_string()))?;
        data.truncate(start + unpacked);
        if unpacked as u64 == at.uncompressed_bytes {
            return Ok(());
        }
        let longer = unpacked as u64 > at.uncompressed_bytes;
        let found = if longer { "more".to_owned() } else { format!("{unpacked} bytes") };
        Err(damaged(file, at, format!("a chunk of {} bytes unpacked", at.uncompressed_bytes), found))
    }
}

fn damaged(file: &SharedFile, at: &ChunkAt, expected: String, found: String) -> ReadError {
    ReadError::unexpected(file.path(), at.offset, expected, found, DAMAGED)
}

/// Fills `room` from its start, as far as `from` goes: how many bytes that are.
fn read_into(mut from: impl Read, room: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < room.len() {
        match from.read(&mut room[filled..]) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

/// The first bytes of a zstd frame. No CDR encapsulation header begins like it.
pub(crate) const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Unpacks a message that rosbag2 compressed on its own (`compression_mode: message`), to at most `most` bytes; `None`
/// where the message is not compressed.
pub(crate) fn unpack_message(bytes: &[u8], most: u64) -> Option<std::io::Result<Vec<u8>>> {
    bytes.starts_with(&ZSTD_MAGIC).then(|| {
        let mut data = Vec::with_capacity(most.min(1 << 20) as usize);
        zstd::stream::read::Decoder::with_buffer(bytes)?.take(most + 1).read_to_end(&mut data)?;
        let fits = data.len() as u64 <= most;
        fits.then_some(data).ok_or_else(|| std::io::Error::other(format!("it unpacks to more than {most} bytes")))
    })
}
