//! Files that appear complete or not at all: written under another name, synced, renamed, the folder synced.

use super::error::RecordError;
use std::fs::{File, remove_file, rename};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file in the making beside its final place; dropped without [`FreshFile::publish`], it is removed.
#[derive(Debug)]
pub struct FreshFile {
    file: BufWriter<File>,
    path: PathBuf,
    part: PathBuf,
    published: bool,
}

impl FreshFile {
    /// Begins the file that will be `path`.
    pub fn create(path: &Path) -> Result<FreshFile, RecordError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let part = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
        let file = File::create(&part).map_err(|source| RecordError::Write { path: path.to_owned(), source })?;
        Ok(FreshFile { file: BufWriter::with_capacity(1 << 18, file), path: path.to_owned(), part, published: false })
    }

    /// The path that the file will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names the finished file; gives its length in bytes.
    pub fn publish(mut self) -> Result<u64, RecordError> {
        let mut done = || -> io::Result<u64> {
            self.file.flush()?;
            let bytes = self.file.seek(SeekFrom::End(0))?;
            self.file.get_ref().sync_all()?;
            rename(&self.part, &self.path)?;
            let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty());
            File::open(folder.unwrap_or(Path::new(".")))?.sync_all()?;
            Ok(bytes)
        };
        let bytes = done().map_err(|source| RecordError::Write { path: self.path.clone(), source })?;
        self.published = true;
        Ok(bytes)
    }
}

impl Write for FreshFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for FreshFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Drop for FreshFile {
    fn drop(&mut self) {
        if !self.published {
            // Nothing can be done about a part that cannot be removed, and nobody reads it.
            let _ = remove_file(&self.part);
        }
    }
}
