//! The messages of a database, read by a thread of its own.

use super::connection::{Database, block_on};
use crate::recording::block::{Block, Entry};
use crate::recording::chunk::MOST_CHUNK_BYTES;
use crate::recording::container::Blocks;
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::unpack::unpack_message;
use sqlx::{AssertSqlSafe, Executor, Row};
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, sync_channel};

/// Rows are handed over in blocks of about this size.
const BLOCK_BYTES: usize = 1 << 24;
const BLOCK_ROWS: usize = 4096;

/// Which messages are read.
pub(super) struct Query {
    /// The topic of each row of the table `topics` that is wanted.
    pub(super) topics: BTreeMap<i64, usize>,
    /// An index on the time, where there is one.
    pub(super) time_index: Option<String>,
}

/// Starts reading: by time where an index allows, else as the messages were written.
pub(super) fn start(database: Database, query: Query) -> Result<Box<dyn Blocks>, ReadError> {
    let (send, receive) = sync_channel(1);
    let reader = database.clone();
    let read = move || {
        let mut hand_over = |block| send.send(Ok(Some(block))).is_ok();
        let end = block_on(stream(&reader, &query, &mut hand_over)).map(|()| None);
        // Where the receiver is gone, nobody waits for the end.
        let _ = send.send(end);
    };
    let thread = std::thread::Builder::new().name("db3 reader".to_owned()).spawn(read);
    thread.map_err(ReadError::io(&database.path, "starting a thread to read"))?;
    Ok(Box::new(ThreadBlocks { database, receive, bytes_read: 0 }))
}

async fn stream(database: &Database, query: &Query, hand_over: &mut dyn FnMut(Block) -> bool) -> Result<(), ReadError> {
    let mut connection = database.connect().await?;
    let mut rows = connection.fetch(sqlx::query(AssertSqlSafe(query.sql())));
    let (mut block, mut total) = (Block::default(), 0_u64);
    while let Some(row) = std::future::poll_fn(|context| rows.as_mut().poll_next(context)).await {
        let row = row.map_err(|error| database.sql_error("reading messages", &error))?;
        let (id, receive_ns): (i64, i64) = (database.cell(&row, 0)?, database.cell(&row, 1)?);
        let data: &[u8] = row.try_get(2).map_err(|error| database.sql_error("reading a message's data", &error))?;
        total += data.len() as u64;
        if total > database.header.bytes {
            let found = format!("more than {} bytes of messages, the file's size", database.header.bytes);
            return Err(database.error("reading messages", &found, DAMAGED));
        }
        let Some(&topic) = query.topics.get(&id) else { continue };
        let start = block.bytes.len();
        match unpack_message(data, MOST_CHUNK_BYTES) {
            None => block.bytes.extend_from_slice(data),
            Some(Ok(plain)) => block.bytes.extend_from_slice(&plain),
            Some(Err(error)) => {
                let found = format!("{error} (message at {receive_ns} ns)");
                return Err(database.error("unpacking a zstd message", &found, DAMAGED));
            }
        }
        let bytes = start..block.bytes.len();
        block.entries.push(Entry { topic, receive_ns, bytes });
        if block.bytes.len() >= BLOCK_BYTES || block.entries.len() >= BLOCK_ROWS {
            block.put_in_order(0);
            if !hand_over(std::mem::take(&mut block)) {
                return Ok(());
            }
        }
    }
    block.put_in_order(0);
    hand_over(block);
    Ok(())
}

impl Query {
    fn sql(&self) -> String {
        let list = self.topics.keys().map(i64::to_string).collect::<Vec<_>>().join(", ");
        let (from, order) = match &self.time_index {
            Some(index) => (format!("INDEXED BY \"{}\"", index.replace('"', "\"\"")), "timestamp, id"),
            None => (String::new(), "id"),
        };
        format!(
            "SELECT topic_id, timestamp, data FROM messages {from} \
             WHERE timestamp >= {} AND topic_id IN ({list}) ORDER BY {order}",
            i64::MIN
        )
    }
}

/// Blocks that the reading thread hands over.
struct ThreadBlocks {
    database: Database,
    receive: Receiver<Result<Option<Block>, ReadError>>,
    bytes_read: u64,
}

impl Blocks for ThreadBlocks {
    fn next(&mut self, _used: Block) -> Result<Option<Block>, ReadError> {
        let stopped = |_| self.database.error("reading messages", "the reader stopped", DAMAGED);
        let block = self.receive.recv().map_err(stopped)??;
        self.bytes_read += block.as_ref().map_or(0, |block| block.bytes.len() as u64);
        Ok(block)
    }

    fn bytes_read(&self) -> u64 {
        self.bytes_read
    }
}
