//! A database whose tables are those of rosbag2: its topics, counts, first and last time.

use super::connection::{Database, block_on};
use super::header::read_header;
use super::messages::{Query, start};
use crate::recording::container::{Blocks, Container};
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::topic::{self, Encoding, Topic};
use sqlx::Connection;
use sqlx::sqlite::SqliteConnection;
use std::collections::BTreeMap;
use std::path::Path;

/// A database of rosbag2.
#[derive(Debug)]
pub(crate) struct Db3 {
    database: Database,
    /// When its first and last message were received, nanoseconds.
    span_ns: Option<(i64, i64)>,
    topics: Vec<Topic>,
    /// The topic of each row of the table `topics`.
    ids: BTreeMap<i64, usize>,
    /// An index on the time, where there is one.
    time_index: Option<String>,
}

impl Db3 {
    /// Checks the file's header and size, then asks for its topics, counts, first and last time.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let database = Database { path: path.to_owned(), header: read_header(path)? };
        let mut file = Self { database, span_ns: None, topics: Vec::new(), ids: BTreeMap::new(), time_index: None };
        // A thread of its own, so that a caller inside an async runtime can call this too.
        let asked = std::thread::scope(|scope| scope.spawn(|| block_on(file.ask())).join());
        let stopped = |_| Err(file.database.error("asking for topics", "the reader stopped", DAMAGED));
        asked.unwrap_or_else(stopped)?;
        Ok(file)
    }

    async fn ask(&mut self) -> Result<(), ReadError> {
        let mut connection = self.database.connect().await?;
        self.check_tables(&mut connection).await?;
        self.ask_for_topics(&mut connection).await?;
        let database = &self.database;
        let index =
            "SELECT name FROM sqlite_schema WHERE type = 'index' AND tbl_name = 'messages' AND sql LIKE '%(timestamp%'";
        let index = database.rows(&mut connection, index).await?;
        self.time_index = index.first().map(|row| database.cell(row, 0)).transpose()?;
        let span = database.row(&mut connection, "SELECT MIN(timestamp), MAX(timestamp) FROM messages").await?;
        let (first_ns, last_ns): (Option<i64>, Option<i64>) = (database.cell(&span, 0)?, database.cell(&span, 1)?);
        self.span_ns = first_ns.zip(last_ns);
        connection.close().await.map_err(|error| database.error("closing", &error.to_string(), DAMAGED))
    }

    /// Refuses a database without rosbag2's tables, and views in their place, which may never end.
    async fn check_tables(&self, connection: &mut SqliteConnection) -> Result<(), ReadError> {
        let tables = "SELECT COUNT(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', 'messages') \
            AND sql NOT LIKE 'CREATE VIRTUAL%'";
        let row = self.database.row(connection, tables).await?;
        if self.database.cell::<i64>(&row, 0)? == 2 {
            return Ok(());
        }
        let advice = "give a file that `ros2 bag record` wrote";
        Err(self.database.error("looking for the tables topics and messages", "not both are there", advice))
    }

    async fn ask_for_topics(&mut self, connection: &mut SqliteConnection) -> Result<(), ReadError> {
        let database = &self.database;
        let topics = "SELECT id, name, type, serialization_format FROM topics ORDER BY id";
        for row in &database.rows(connection, topics).await? {
            let (name, type_name): (String, String) = (database.cell(row, 1)?, database.cell(row, 2)?);
            let encoding = Encoding::from_name(&database.cell::<String>(row, 3)?);
            let place = topic::find_or_add(&mut self.topics, &name, &type_name, encoding);
            self.ids.insert(database.cell(row, 0)?, place);
        }
        let counts = "SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id";
        for row in &database.rows(connection, counts).await? {
            let (id, messages): (i64, i64) = (database.cell(row, 0)?, database.cell(row, 1)?);
            let unknown_topic =
                || database.error("counting messages", &format!("messages of topic {id}, which is unknown"), DAMAGED);
            let place = *self.ids.get(&id).ok_or_else(unknown_topic)?;
            topic::add_messages(&mut self.topics[place], u64::try_from(messages).ok());
        }
        Ok(())
    }
}

impl Container for Db3 {
    fn topics(&self) -> &[Topic] {
        &self.topics
    }

    fn bytes(&self) -> u64 {
        self.database.header.bytes
    }

    fn first_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.0)
    }

    fn last_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.1)
    }

    /// By time where an index allows, else as they were written.
    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let wanted_ids = self.ids.iter().filter(|&(_, &place)| wanted[place]);
        let topics = wanted_ids.map(|(&id, &place)| (id, place)).collect();
        start(self.database.clone(), Query { topics, time_index: self.time_index.clone() })
    }
}
