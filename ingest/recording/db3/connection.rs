//! A connection to a database, with a budget of work, and its errors.

use super::header::Header;
use crate::recording::error::{DAMAGED, ReadError};
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteRow};
use sqlx::{ConnectOptions, Row};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Steps of SQLite's virtual machine between two looks at the budget.
const STEPS: i32 = 10_000;

/// A database file.
#[derive(Debug, Clone)]
pub(super) struct Database {
    /// Its path.
    pub(super) path: PathBuf,
    /// What its header says.
    pub(super) header: Header,
}

impl Database {
    /// Connects for reading.
    pub(super) async fn connect(&self) -> Result<SqliteConnection, ReadError> {
        let path = std::path::absolute(&self.path).map_err(ReadError::io(&self.path, "finding"))?;
        // A file in write-ahead mode without its log cannot be locked for reading unless SQLite may create one beside
        // it.
        let options = SqliteConnectOptions::new().filename(path).read_only(true).immutable(self.header.is_write_ahead);
        let options = options.busy_timeout(Duration::from_secs(1)).row_buffer_size(2).pragma("cell_size_check", "ON");
        let opened = options.disable_statement_logging().connect().await;
        let mut connection = opened.map_err(|error| self.sql_error("opening", &error))?;
        // A sound file needs some ten steps a row, and a row ten bytes; a file whose pages form a loop would never end.
        let mut budget = self.header.bytes.saturating_mul(8) / STEPS as u64 + 10_000;
        let spend = move || {
            budget = budget.saturating_sub(1);
            budget > 0
        };
        let handle = connection.lock_handle().await;
        handle.map_err(|error| self.sql_error("opening", &error))?.set_progress_handler(STEPS, spend);
        Ok(connection)
    }

    /// All rows of a query.
    pub(super) async fn rows(
        &self,
        connection: &mut SqliteConnection,
        sql: &'static str,
    ) -> Result<Vec<SqliteRow>, ReadError> {
        sqlx::query(sql).fetch_all(connection).await.map_err(|error| self.sql_error(sql, &error))
    }

    /// The one row of a query.
    pub(super) async fn row(
        &self,
        connection: &mut SqliteConnection,
        sql: &'static str,
    ) -> Result<SqliteRow, ReadError> {
        sqlx::query(sql).fetch_one(connection).await.map_err(|error| self.sql_error(sql, &error))
    }

    /// A column of a row, as the type that rosbag2 writes there.
    pub(super) fn cell<'r, T>(&self, row: &'r SqliteRow, column: usize) -> Result<T, ReadError>
    where
        T: sqlx::Decode<'r, sqlx::Sqlite> + sqlx::Type<sqlx::Sqlite>,
    {
        row.try_get(column).map_err(|error| self.sql_error("reading a row", &error))
    }

    /// SQLite's error while `doing`.
    pub(super) fn sql_error(&self, doing: &str, error: &sqlx::Error) -> ReadError {
        let text = error.to_string();
        let advice = if text.contains("locked") || text.contains("busy") {
            "stop the program that is writing it, or read a copy"
        } else {
            DAMAGED
        };
        self.error(doing, &text, advice)
    }

    /// What was found while `doing`.
    pub(super) fn error(&self, doing: &str, found: &str, advice: &'static str) -> ReadError {
        ReadError::Database { path: self.path.clone(), doing: doing.to_owned(), found: found.to_owned(), advice }
    }
}

/// Runs `work` to its end on this thread.
pub(super) fn block_on<T>(work: impl Future<Output = Result<T, ReadError>>) -> Result<T, ReadError> {
    let runtime = tokio::runtime::Builder::new_current_thread().build();
    runtime.map_err(ReadError::io(Path::new(""), "starting to read a database"))?.block_on(work)
}
