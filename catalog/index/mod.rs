//! The SQLite index: which records exist, by place, slot and purpose. Only this module speaks SQL; only the submitting process opens the
//! store's; workers have one of their own in memory.

mod generators;
mod rows;
mod work;

pub use generators::{GateRow, GeneratorRow};
pub use rows::{ExperienceRow, RecordingPart, RecordingRow, RunRow, TraversalRow};
pub use work::{FailureRow, TimingRow};

use crate::CatalogError;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous};
use sqlx::{ConnectOptions, Connection};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// An open index.
#[derive(Debug)]
pub(crate) struct Index {
    runtime: tokio::runtime::Runtime,
    connection: Mutex<SqliteConnection>,
}

/// How long to wait for another process that writes.
const BUSY: Duration = Duration::from_secs(60);

impl Index {
    /// Opens the index, bringing it to this program's format.
    pub(crate) fn open(path: &Path, create: bool) -> Result<Self, CatalogError> {
        let options = SqliteConnectOptions::new()
            .filename(path)
            .create_if_missing(create)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full)
            .foreign_keys(true)
            .busy_timeout(BUSY);
        Self::connect(options, path)
    }

    /// An empty index in memory, gone with the process.
    pub(crate) fn scratch() -> Result<Self, CatalogError> {
        Self::connect(SqliteConnectOptions::new().in_memory(true).foreign_keys(true), Path::new("memory"))
    }

    fn connect(options: SqliteConnectOptions, path: &Path) -> Result<Self, CatalogError> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(CatalogError::file("start the database thread for", path))?;
        let connection = runtime.block_on(async {
            let mut connection = options.disable_statement_logging().connect().await?;
            sqlx::migrate!("./migrations").run(&mut connection).await?;
            Ok::<_, CatalogError>(connection)
        })?;
        Ok(Self { runtime, connection: Mutex::new(connection) })
    }

    /// Runs one piece of database work to its end.
    pub(crate) fn run<T>(
        &self,
        work: impl AsyncFnOnce(&mut SqliteConnection) -> Result<T, sqlx::Error>,
    ) -> Result<T, CatalogError> {
        let mut connection = self.connection();
        Ok(self.runtime.block_on(work(&mut connection))?)
    }

    /// Runs work as one transaction: all of it or nothing.
    pub(crate) fn transact(
        &self,
        work: impl AsyncFnOnce(&mut SqliteConnection) -> Result<(), sqlx::Error>,
    ) -> Result<(), CatalogError> {
        self.run(async |connection| {
            let mut transaction = connection.begin_with("BEGIN IMMEDIATE").await?;
            work(&mut transaction).await?;
            transaction.commit().await
        })
    }

    fn connection(&self) -> MutexGuard<'_, SqliteConnection> {
        // A panic elsewhere leaves the connection itself sound: an unfinished transaction rolls back.
        self.connection.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
