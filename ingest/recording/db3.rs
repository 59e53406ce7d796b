//! rosbag2's SQLite files. Opened read-only; nothing is ever written beside them.

use super::block::{Block, Blocks, Entry};
use super::chunk::{MOST_CHUNK_BYTES, unpack_message};
use super::error::{COPY_OR_SALVAGE, DAMAGED, ReadError};
use super::file::Source;
use super::topic::{self, Encoding, Topic};
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteRow};
use sqlx::{AssertSqlSafe, ConnectOptions, Connection, Executor, Row};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

/// The first bytes of a database.
pub(crate) const MAGIC: &[u8] = b"SQLite format 3\0";
/// Rows are handed over in blocks of about this size.
const BLOCK_BYTES: usize = 1 << 24;
const BLOCK_ROWS: usize = 4096;
/// Steps of SQLite's machine between two looks at the budget.
const STEPS: i32 = 10_000;

/// A database whose tables are those of rosbag2.
#[derive(Debug)]
pub(crate) struct Db3 {
    path: PathBuf,
    pub(crate) bytes: u64,
    pub(crate) first_ns: Option<i64>,
    pub(crate) topics: Vec<Topic>,
    /// Topic of each row of `topics`.
    ids: BTreeMap<i64, usize>,
    /// An index on the time, where there is one.
    time_index: Option<String>,
    write_ahead: bool,
}

impl Db3 {
    /// Checks the file's header and size, then asks for its topics, counts and first time.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let (bytes, write_ahead) = check_file(path)?;
        let mut file = Db3 {
            path: path.to_owned(),
            bytes,
            first_ns: None,
            topics: Vec::new(),
            ids: BTreeMap::new(),
            time_index: None,
            write_ahead,
        };
        // A thread of its own, so that a caller inside an async runtime can call this too.
        let looked = std::thread::scope(|scope| scope.spawn(|| run(file.look())).join());
        looked.unwrap_or_else(|_| Err(file.error("asking for topics", "the reader stopped", DAMAGED)))?;
        Ok(file)
    }

    async fn look(&mut self) -> Result<(), ReadError> {
        let mut connection = self.connect().await?;
        let tables = "SELECT COUNT(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', 'messages') \
            AND sql NOT LIKE 'CREATE VIRTUAL%'";
        let tables: i64 = cell(&self.row(&mut connection, tables).await?, 0, self)?;
        if tables != 2 {
            let advice = "give a file that `ros2 bag record` wrote";
            return Err(self.error("looking for the tables topics and messages", "not both are there", advice));
        }
        let topics = "SELECT id, name, type, serialization_format FROM topics ORDER BY id";
        for row in &self.rows(&mut connection, topics).await? {
            let (name, type_name): (String, String) = (cell(row, 1, self)?, cell(row, 2, self)?);
            let encoding = Encoding::named(&cell::<String>(row, 3, self)?);
            let (id, place) = (cell(row, 0, self)?, topic::place(&mut self.topics, &name, &type_name, encoding));
            self.ids.insert(id, place);
        }
        for row in &self.rows(&mut connection, "SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id").await? {
            let (id, messages): (i64, i64) = (cell(row, 0, self)?, cell(row, 1, self)?);
            let found =
                || self.error("counting messages", &format!("messages of topic {id}, which is unknown"), DAMAGED);
            let place = *self.ids.get(&id).ok_or_else(found)?;
            topic::count(&mut self.topics[place], u64::try_from(messages).ok());
        }
        let index =
            "SELECT name FROM sqlite_schema WHERE type = 'index' AND tbl_name = 'messages' AND sql LIKE '%(timestamp%'";
        let index = self.rows(&mut connection, index).await?;
        self.time_index = index.first().map(|row| cell(row, 0, self)).transpose()?;
        self.first_ns = cell(&self.row(&mut connection, "SELECT MIN(timestamp) FROM messages").await?, 0, self)?;
        let closed = connection.close().await;
        closed.map_err(|error| self.error("closing", &error.to_string(), DAMAGED))
    }

    /// The messages of the topics that are `wanted`, by time where an index allows, else as they were written.
    pub(crate) fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let topics: BTreeMap<i64, usize> =
            self.ids.iter().filter(|&(_, &place)| wanted[place]).map(|(&id, &place)| (id, place)).collect();
        let list = topics.keys().map(i64::to_string).collect::<Vec<_>>().join(", ");
        let (from, order) = match &self.time_index {
            Some(index) => (format!("INDEXED BY \"{}\"", index.replace('"', "\"\"")), "timestamp, id"),
            None => (String::new(), "id"),
        };
        let sql = format!(
            "SELECT topic_id, timestamp, data FROM messages {from} WHERE timestamp >= {} AND topic_id IN ({list}) ORDER BY {order}",
            i64::MIN
        );
        let (send, receive) = sync_channel(1);
        let reader = Db3 { path: self.path.clone(), topics: Vec::new(), ids: topics, time_index: None, ..*self };
        let read = move || {
            let mut hand_over = |block| send.send(Ok(Some(block))).is_ok();
            let end = run(reader.stream(sql, &mut hand_over)).map(|()| None);
            // A receiver that is gone wants no end either.
            let _ = send.send(end);
        };
        let thread = std::thread::Builder::new().name("db3 reader".to_owned()).spawn(read);
        thread.map_err(ReadError::io(&self.path, "starting a thread to read"))?;
        Ok(Box::new(Pages { path: self.path.clone(), receive, bytes_read: 0 }))
    }

    async fn stream(&self, sql: String, hand_over: &mut dyn FnMut(Block) -> bool) -> Result<(), ReadError> {
        let mut connection = self.connect().await?;
        let mut rows = connection.fetch(sqlx::query(AssertSqlSafe(sql)));
        let (mut bytes, mut entries, mut total) = (Vec::new(), Vec::new(), 0_u64);
        while let Some(row) = std::future::poll_fn(|context| rows.as_mut().poll_next(context)).await {
            let row = row.map_err(|error| self.refused("reading messages", &error))?;
            let (id, receive_ns): (i64, i64) = (cell(&row, 0, self)?, cell(&row, 1, self)?);
            let data: &[u8] = row.try_get(2).map_err(|error| self.refused("reading a message's data", &error))?;
            total += data.len() as u64;
            if total > self.bytes {
                let found = format!("more than {} bytes of messages, the file's size", self.bytes);
                return Err(self.error("reading messages", &found, DAMAGED));
            }
            let Some(&topic) = self.ids.get(&id) else { continue };
            let start = bytes.len();
            match unpack_message(data, MOST_CHUNK_BYTES) {
                None => bytes.extend_from_slice(data),
                Some(Ok(plain)) => bytes.extend_from_slice(&plain),
                Some(Err(error)) => {
                    let found = format!("{error} (message at {receive_ns} ns)");
                    return Err(self.error("unpacking a zstd message", &found, DAMAGED));
                }
            }
            entries.push(Entry { topic, receive_ns, bytes: start..bytes.len() });
            if bytes.len() >= BLOCK_BYTES || entries.len() >= BLOCK_ROWS {
                let block = Block::in_order(std::mem::take(&mut bytes), std::mem::take(&mut entries));
                if !hand_over(block) {
                    return Ok(());
                }
            }
        }
        hand_over(Block::in_order(bytes, entries));
        Ok(())
    }

    async fn connect(&self) -> Result<SqliteConnection, ReadError> {
        let path = std::path::absolute(&self.path).map_err(ReadError::io(&self.path, "finding"))?;
        // A file in write-ahead mode without its log cannot be locked for reading unless SQLite may create one beside it.
        let options = SqliteConnectOptions::new().filename(path).read_only(true).immutable(self.write_ahead);
        let options = options.busy_timeout(Duration::from_secs(1)).row_buffer_size(2).pragma("cell_size_check", "ON");
        let opened = options.disable_statement_logging().connect().await;
        let mut connection = opened.map_err(|error| self.refused("opening", &error))?;
        // A sound file needs some ten steps a row, and a row ten bytes; a file whose pages form a loop would never end.
        let mut budget = self.bytes.saturating_mul(8) / STEPS as u64 + 10_000;
        let spend = move || {
            budget = budget.saturating_sub(1);
            budget > 0
        };
        let handle = connection.lock_handle().await;
        handle.map_err(|error| self.refused("opening", &error))?.set_progress_handler(STEPS, spend);
        Ok(connection)
    }

    async fn rows(&self, connection: &mut SqliteConnection, sql: &'static str) -> Result<Vec<SqliteRow>, ReadError> {
        sqlx::query(sql).fetch_all(connection).await.map_err(|error| self.refused(sql, &error))
    }

    async fn row(&self, connection: &mut SqliteConnection, sql: &'static str) -> Result<SqliteRow, ReadError> {
        sqlx::query(sql).fetch_one(connection).await.map_err(|error| self.refused(sql, &error))
    }

    fn refused(&self, doing: &str, error: &sqlx::Error) -> ReadError {
        let text = error.to_string();
        let advice = if text.contains("locked") || text.contains("busy") {
            "stop the program that is writing it, or read a copy"
        } else {
            DAMAGED
        };
        self.error(doing, &text, advice)
    }

    fn error(&self, doing: &str, found: &str, advice: &'static str) -> ReadError {
        ReadError::Database { path: self.path.clone(), doing: doing.to_owned(), found: found.to_owned(), advice }
    }
}

/// A column of a row, as the type that rosbag2 writes there.
fn cell<'r, T>(row: &'r SqliteRow, column: usize, of: &Db3) -> Result<T, ReadError>
where
    T: sqlx::Decode<'r, sqlx::Sqlite> + sqlx::Type<sqlx::Sqlite>,
{
    row.try_get(column).map_err(|error| of.refused("reading a row", &error))
}

fn run<T>(work: impl Future<Output = Result<T, ReadError>>) -> Result<T, ReadError> {
    let runtime = tokio::runtime::Builder::new_current_thread().build();
    runtime.map_err(ReadError::io(Path::new(""), "starting to read a database"))?.block_on(work)
}

/// The file's size, and whether it is in write-ahead mode. Refuses one that is shorter than its header says, and one whose
/// last changes lie in a log beside it.
fn check_file(path: &Path) -> Result<(u64, bool), ReadError> {
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
        return Err(ReadError::bad(path, source.len(), expected, found, COPY_OR_SALVAGE));
    }
    for log in ["-wal", "-journal"] {
        let mut beside = path.as_os_str().to_owned();
        beside.push(log);
        if std::fs::metadata(&beside).is_ok_and(|log| log.len() > 0) {
            let expected = "a database that its recorder closed";
            let found = format!("changes in a log beside it, {}", beside.display());
            let advice = "stop the recorder; else merge the log in a copy of both: `sqlite3 COPY 'PRAGMA wal_checkpoint(TRUNCATE)'`";
            return Err(ReadError::bad(path, 18, expected, found, advice));
        }
    }
    Ok((source.len(), header[18] == 2 || header[19] == 2))
}

/// Blocks that the reading thread hands over.
struct Pages {
    path: PathBuf,
    receive: Receiver<Result<Option<Block>, ReadError>>,
    bytes_read: u64,
}

impl Blocks for Pages {
    fn next(&mut self) -> Result<Option<Block>, ReadError> {
        let stopped = |_| ReadError::Database {
            path: self.path.clone(),
            doing: "reading messages".to_owned(),
            found: "the reader stopped".to_owned(),
            advice: DAMAGED,
        };
        let block = self.receive.recv().map_err(stopped)??;
        self.bytes_read += block.as_ref().map_or(0, |block| block.bytes.len() as u64);
        Ok(block)
    }

    fn bytes_read(&self) -> u64 {
        self.bytes_read
    }
}
