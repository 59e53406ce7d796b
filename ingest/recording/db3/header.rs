//! The header of a database file, checked before SQLite opens it.

use crate::recording::error::{COPY_OR_SALVAGE, ReadError};
use crate::recording::file::Source;
use std::path::Path;

/// The first bytes of a database.
pub(crate) const MAGIC: &[u8] = b"SQLite format 3\0";

/// What the header of a database says.
#[derive(Debug, Clone, Copy)]
pub(super) struct Header {
    /// The file's length in bytes.
    pub(super) bytes: u64,
    /// Whether the database is in write-ahead mode.
    pub(super) is_write_ahead: bool,
}

/// Reads the header. Refuses a file that is shorter than its header says, and one whose last changes lie in a log
/// beside it.
pub(super) fn read_header(path: &Path) -> Result<Header, ReadError> {
    let mut source = Source::open(path)?;
    let header: [u8; 100] = source.array("a database's header")?;
    let u32_at =
        |at: usize| u64::from(u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]));
    let page_bytes = match u16::from_be_bytes([header[16], header[17]]) {
        1 => 65_536,
        bytes => u64::from(bytes),
    };
    let size_is_current = u32_at(24) == u32_at(92);
    if size_is_current && u32_at(28) * page_bytes > source.len() {
        let expected = format!("{} pages of {page_bytes} bytes", u32_at(28));
        let found = format!("a file of {} bytes", source.len());
        return Err(ReadError::unexpected(path, source.len(), expected, found, COPY_OR_SALVAGE));
    }
    for log in ["-wal", "-journal"] {
        let mut beside = path.as_os_str().to_owned();
        beside.push(log);
        if std::fs::metadata(&beside).is_ok_and(|log| log.len() > 0) {
            let expected = "a database that its recorder closed";
            let found = format!("changes in a log beside it, {}", beside.display());
            let advice = "stop the recorder; if it is gone, merge the log in a copy of both: \
                `sqlite3 COPY 'PRAGMA wal_checkpoint(TRUNCATE)'`";
            return Err(ReadError::unexpected(path, 18, expected, found, advice));
        }
    }
    Ok(Header { bytes: source.len(), is_write_ahead: header[18] == 2 || header[19] == 2 })
}
