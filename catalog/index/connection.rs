//! The connection to the index: opened to write, to read only, or in memory.

use crate::CatalogError;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous};
use sqlx::{ConnectOptions, Connection};
use std::fs;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// An open index. What it is asked lies beside its rows, in the files of this folder.
#[derive(Debug)]
pub(crate) struct Index {
    runtime: tokio::runtime::Runtime,
    connection: Mutex<SqliteConnection>,
}

/// The formats that an index went through.
static MIGRATIONS: sqlx::migrate::Migrator = sqlx::migrate!("./migrations");

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
        Self::connect(options, path)?.migrated()
    }

    /// Opens the index to read it; nothing is brought to another format. What another process commits afterwards need
    /// not be seen.
    pub(crate) fn open_to_read(path: &Path) -> Result<Self, CatalogError> {
        // SQLite makes files beside a database in WAL mode even to read it, unless it is told that nobody writes. Where
        // someone does, they are there.
        let idle = fs::metadata(path.with_extension("db-wal")).map_or(true, |log| log.len() == 0);
        let options = SqliteConnectOptions::new().filename(path).read_only(true).immutable(idle).busy_timeout(BUSY);
        let index = Self::connect(options, path)?;
        let found: Option<i64> = index
            .run(async |db| sqlx::query_scalar("SELECT max(version) FROM _sqlx_migrations").fetch_one(db).await)?;
        let expected = MIGRATIONS.iter().map(|migration| migration.version).max();
        if found == expected {
            return Ok(index);
        }
        let (found, expected) = (found.unwrap_or_default(), expected.unwrap_or_default());
        Err(CatalogError::OtherFormat { path: path.to_owned(), found, expected })
    }

    /// An empty index in memory, gone with the process.
    pub(crate) fn scratch() -> Result<Self, CatalogError> {
        Self::connect(SqliteConnectOptions::new().in_memory(true).foreign_keys(true), Path::new("memory"))?.migrated()
    }

    fn connect(options: SqliteConnectOptions, path: &Path) -> Result<Self, CatalogError> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(CatalogError::file("start the database thread for", path))?;
        let connection = runtime.block_on(options.disable_statement_logging().connect())?;
        Ok(Self { runtime, connection: Mutex::new(connection) })
    }

    /// The same, brought to this program's format.
    fn migrated(self) -> Result<Self, CatalogError> {
        self.runtime.block_on(MIGRATIONS.run(&mut *self.connection()))?;
        Ok(self)
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
