//! Files that were compressed as a whole, as rosbag2's `compression_mode: file` leaves them: expanded into a temporary
//! file, which is gone when the recording is closed.

use super::chunk::most_unpacked_file;
use super::container::{Blocks, Container};
use super::error::{DAMAGED, ReadError};
use super::topic::Topic;
use super::unpack::ZSTD_MAGIC;
use std::fmt;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use tempfile::{NamedTempFile, TempPath};

/// Whether a file that begins so is compressed as a whole.
pub(crate) fn is_packed(start: &[u8]) -> bool {
    start.starts_with(&ZSTD_MAGIC)
}

/// A container in a temporary file.
pub(crate) struct Expanded {
    container: Box<dyn Container>,
    /// Removes the file when it is dropped.
    _file: TempPath,
}

impl Expanded {
    /// Expands `path` and opens what is in it by `open`.
    pub(crate) fn open(
        path: &Path,
        open: impl FnOnce(&Path) -> Result<Box<dyn Container>, ReadError>,
    ) -> Result<Self, ReadError> {
        let folder = std::env::temp_dir();
        let packed = File::open(path).map_err(ReadError::io(path, "opening"))?;
        let bytes = packed.metadata().map_err(ReadError::io(path, "asking for the size of"))?.len();
        let most = most_unpacked_file(bytes);
        let mut file = NamedTempFile::with_prefix_in("furrow-expanded-", &folder)
            .map_err(ReadError::io(&folder, "expanding a compressed recording into"))?;
        let damaged = |found: String| ReadError::unexpected(path, 0, "a whole zstd file", found, DAMAGED);
        let mut plain = zstd::stream::read::Decoder::with_buffer(BufReader::new(packed))
            .map_err(|error| damaged(error.to_string()))?
            .take(most + 1);
        let mut buffer = vec![0; 1 << 20];
        let mut written = 0_u64;
        loop {
            let read = plain.read(&mut buffer).map_err(|error| damaged(error.to_string()))?;
            if read == 0 {
                break;
            }
            written += read as u64;
            if written > most {
                return Err(damaged(format!("{bytes} bytes that expand to more than {most}")));
            }
            std::io::Write::write_all(&mut file, &buffer[..read]).map_err(ReadError::io(
                &folder,
                "expanding a compressed recording (TMPDIR names another folder) into",
            ))?;
        }
        let file = file.into_temp_path();
        let container = open(&file).map_err(|error| error.renamed(path))?;
        Ok(Self { container, _file: file })
    }
}

impl fmt::Debug for Expanded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Expanded").field(&self.container).finish()
    }
}

impl Container for Expanded {
    fn topics(&self) -> &[Topic] {
        self.container.topics()
    }

    fn bytes(&self) -> u64 {
        self.container.bytes()
    }

    fn first_ns(&self) -> Option<i64> {
        self.container.first_ns()
    }

    fn last_ns(&self) -> Option<i64> {
        self.container.last_ns()
    }

    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        self.container.blocks(wanted)
    }
}
