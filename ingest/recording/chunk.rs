//! Chunks: where they lie, and how much they can hold.

use super::error::{DAMAGED, ReadError};
use std::path::Path;

/// The largest chunk or message that is read, uncompressed: a recorder's chunks have about 1 MiB.
pub(crate) const MOST_CHUNK_BYTES: u64 = 1 << 30;

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
    /// Bytes that reading it takes, packed and unpacked.
    pub(crate) fn bytes_taken(&self) -> u64 {
        self.bytes.saturating_add(self.uncompressed_bytes)
    }

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
}
