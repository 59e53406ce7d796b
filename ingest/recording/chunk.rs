//! Chunks: where they lie, and how they are decompressed within bounds.

use super::error::{DAMAGED, ReadError};
use std::io::Read;
use std::path::Path;

/// The largest chunk or message that is read, uncompressed: a recorder's chunks have about 1 MiB.
pub(crate) const MOST_CHUNK_BYTES: u64 = 1 << 30;
/// How much is read and decompressed ahead of its use.
pub(crate) const MOST_AHEAD_BYTES: u64 = 1 << 28;

/// How a chunk is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Packing {
    None,
    Bz2,
    Lz4,
    Zstd,
}

impl Packing {
    /// The packing that containers call `name`.
    pub(crate) fn from_name(name: &[u8]) -> Option<Self> {
        match name {
            b"" | b"none" => Some(Packing::None),
            b"bz2" => Some(Packing::Bz2),
            b"lz4" => Some(Packing::Lz4),
            b"zstd" => Some(Packing::Zstd),
            _ => None,
        }
    }

    /// The most that `packed` bytes can unpack to. A length byte of lz4 stands for at most 255 bytes, a zstd block of 4
    /// bytes for 128 KiB, and a bz2 block of 900 kB of run-length codes (4 bytes for 259) takes some 40 bytes.
    fn most_unpacked(self, packed: u64) -> u64 {
        let (ratio, slack) = match self {
            Packing::None => (1, 0),
            Packing::Bz2 => (1 << 21, 1 << 26),
            Packing::Lz4 => (255, 1 << 16),
            Packing::Zstd => (1 << 15, 1 << 17),
        };
        packed.saturating_mul(ratio).saturating_add(slack)
    }
}

/// The most that a file of `packed` bytes, compressed as a whole, is expanded to: recordings of images hardly shrink,
/// and raw black ones by some hundreds.
pub(crate) fn most_unpacked_file(packed: u64) -> u64 {
    packed.saturating_mul(1 << 10).saturating_add(1 << 30)
}

/// A chunk, or a run of bare records, as it lies in the file.
#[derive(Debug, Clone)]
pub(crate) struct ChunkAt {
    /// Where its packed data begin.
    pub(crate) offset: u64,
    /// Its packed length.
    pub(crate) bytes: u64,
    /// Its length unpacked, as the file declares it.
    pub(crate) uncompressed_bytes: u64,
    /// How it is packed.
    pub(crate) packing: Packing,
    /// CRC-32 of the unpacked data; zero where there is none.
    pub(crate) crc: u32,
}

impl ChunkAt {
    /// Refuses a chunk that declares more than it can hold, before anything is allocated for it.
    pub(crate) fn check(&self, path: &Path) -> Result<(), ReadError> {
        let most = self.packing.most_unpacked(self.bytes).min(MOST_CHUNK_BYTES);
        let exact = self.packing == Packing::None && self.uncompressed_bytes != self.bytes;
        if self.uncompressed_bytes <= most && !exact {
            return Ok(());
        }
        let expected = format!("a chunk of {} bytes packed ({:?}) to hold at most {most}", self.bytes, self.packing);
        let found = format!("{} bytes declared", self.uncompressed_bytes);
        Err(ReadError::unexpected(path, self.offset, expected, found, DAMAGED))
    }

    /// The chunk's data, exactly as long as declared and with the declared CRC.
    pub(crate) fn unpack(&self, path: &Path, packed: Vec<u8>) -> Result<Vec<u8>, ReadError> {
        let damaged =
            |expected: String, found: String| ReadError::unexpected(path, self.offset, expected, found, DAMAGED);
        let data = match self.packing {
            Packing::None => Ok(packed),
            Packing::Bz2 => read_at_most(bzip2::read::BzDecoder::new(&packed[..]), self.uncompressed_bytes),
            Packing::Lz4 => read_at_most(lz4_flex::frame::FrameDecoder::new(&packed[..]), self.uncompressed_bytes),
            Packing::Zstd => zstd::stream::read::Decoder::with_buffer(&packed[..])
                .and_then(|decoder| read_at_most(decoder, self.uncompressed_bytes)),
        };
        let data = data.map_err(|error| damaged(format!("{:?} data of a chunk", self.packing), error.to_string()))?;
        if data.len() as u64 != self.uncompressed_bytes {
            let longer = data.len() as u64 > self.uncompressed_bytes;
            let found = if longer { "more".to_owned() } else { format!("{} bytes", data.len()) };
            return Err(damaged(format!("a chunk of {} bytes unpacked", self.uncompressed_bytes), found));
        }
        if self.crc != 0 && crc32fast::hash(&data) != self.crc {
            let found = format!("{:08x}", crc32fast::hash(&data));
            return Err(damaged(format!("a chunk with CRC-32 {:08x}", self.crc), found));
        }
        Ok(data)
    }
}

/// The first bytes of a zstd frame. No CDR encapsulation header begins like it.
pub(crate) const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Unpacks a message that rosbag2 compressed on its own (`compression_mode: message`), to at most `most` bytes; `None`
/// where the message is not compressed.
pub(crate) fn unpack_message(bytes: &[u8], most: u64) -> Option<std::io::Result<Vec<u8>>> {
    bytes.starts_with(&ZSTD_MAGIC).then(|| {
        let data = read_at_most(zstd::stream::read::Decoder::with_buffer(bytes)?, most)?;
        let fits = data.len() as u64 <= most;
        fits.then_some(data).ok_or_else(|| std::io::Error::other(format!("it unpacks to more than {most} bytes")))
    })
}

/// Everything that `from` gives, but at most one byte more than `most`.
fn read_at_most(from: impl Read, most: u64) -> std::io::Result<Vec<u8>> {
    let mut data = Vec::with_capacity(most.min(1 << 20) as usize);
    from.take(most + 1).read_to_end(&mut data)?;
    Ok(data)
}
