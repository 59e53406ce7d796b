//! Files: read forward with every length checked against what is left, and read anywhere by several threads.

use super::error::{COPY_OR_SALVAGE, ReadError};
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

/// A recording's file and a place in it.
pub(crate) struct Source {
    path: PathBuf,
    file: BufReader<File>,
    len: u64,
    at: u64,
}

impl Source {
    /// Opens a plain file that is not empty.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        // A pipe without a writer would be waited for here.
        if !std::fs::metadata(path).map_err(ReadError::io(path, "opening"))?.is_file() {
            let other = std::io::Error::new(ErrorKind::InvalidInput, "it is a pipe, a device or a socket, not a file");
            return Err(ReadError::io(path, "opening")(other));
        }
        let file = File::open(path).map_err(ReadError::io(path, "opening"))?;
        let len = file.metadata().map_err(ReadError::io(path, "asking for the size of"))?.len();
        if len == 0 {
            return Err(ReadError::unexpected(path, 0, "a recording", "an empty file", COPY_OR_SALVAGE));
        }
        Ok(Self { path: path.to_owned(), file: BufReader::new(file), len, at: 0 })
    }

    /// The file's path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file's length in bytes.
    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// The offset of the next byte.
    pub(crate) fn at(&self) -> u64 {
        self.at
    }

    /// Refuses `bytes` more of `what` where the file ends before.
    pub(crate) fn check(&self, bytes: u64, what: &str) -> Result<(), ReadError> {
        let left = self.len - self.at;
        if bytes <= left {
            return Ok(());
        }
        let found = format!("{left} bytes to the end of the file");
        Err(ReadError::unexpected(&self.path, self.at, format!("{bytes} bytes of {what}"), found, COPY_OR_SALVAGE))
    }

    /// The next `bytes` bytes.
    pub(crate) fn take(&mut self, bytes: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        self.check(bytes, what)?;
        let mut taken = Vec::new();
        let read = (&mut self.file).take(bytes).read_to_end(&mut taken);
        self.advance(read.map(|n| n as u64), bytes, what)?;
        Ok(taken)
    }

    /// The next `N` bytes.
    pub(crate) fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ReadError> {
        let mut taken = [0; N];
        self.fill(&mut taken, what)?;
        Ok(taken)
    }

    /// Fills `buffer` with the next bytes.
    pub(crate) fn fill(&mut self, buffer: &mut [u8], what: &str) -> Result<(), ReadError> {
        let bytes = buffer.len() as u64;
        self.check(bytes, what)?;
        let read = self.file.read_exact(buffer);
        self.advance(read.map(|()| bytes), bytes, what)
    }

    /// Passes over `bytes` bytes.
    pub(crate) fn skip(&mut self, bytes: u64, what: &str) -> Result<(), ReadError> {
        self.check(bytes, what)?;
        let seek = match i64::try_from(bytes) {
            Ok(ahead) => self.file.seek_relative(ahead),
            Err(_) => Err(std::io::ErrorKind::InvalidInput.into()),
        };
        self.advance(seek.map(|()| bytes), bytes, what)
    }

    /// Goes to `offset`, which must not lie past the end.
    pub(crate) fn seek(&mut self, offset: u64, what: &str) -> Result<(), ReadError> {
        if offset >= self.at {
            return self.skip(offset - self.at, what);
        }
        self.file.seek(SeekFrom::Start(offset)).map_err(ReadError::io(&self.path, "seeking in"))?;
        self.at = offset;
        Ok(())
    }

    /// Moves on by what was read, which must be all that was wanted.
    fn advance(&mut self, read: std::io::Result<u64>, wanted: u64, what: &str) -> Result<(), ReadError> {
        let read = read.map_err(ReadError::io(&self.path, "reading"))?;
        self.at += read;
        if read == wanted {
            return Ok(());
        }
        let found = "a file that became shorter while it was read";
        Err(ReadError::unexpected(&self.path, self.at, format!("{wanted} bytes of {what}"), found, COPY_OR_SALVAGE))
    }
}

/// A file that several threads read from at once.
pub(crate) struct SharedFile {
    path: PathBuf,
    file: File,
}

impl SharedFile {
    /// Opens a file.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(ReadError::io(path, "opening"))?;
        Ok(Self { path: path.to_owned(), file })
    }

    /// The file's path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Fills `buffer` with the bytes of `what` at `offset`. The file may have become shorter since it was opened.
    pub(crate) fn read_at(&self, offset: u64, buffer: &mut [u8], what: &str) -> Result<(), ReadError> {
        self.file.read_exact_at(buffer, offset).map_err(|error| {
            if error.kind() != ErrorKind::UnexpectedEof {
                return ReadError::io(&self.path, "reading")(error);
            }
            let left = self.file.metadata().map_or(0, |metadata| metadata.len().saturating_sub(offset));
            let (expected, found) =
                (format!("{} bytes of {what}", buffer.len()), format!("{left} bytes to the end of the file"));
            ReadError::unexpected(&self.path, offset, expected, found, COPY_OR_SALVAGE)
        })
    }
}
