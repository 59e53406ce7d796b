//! The connection to the index: opened to write, to read only, or in memory.

use crate::CatalogError;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous};
use sqlx::{ConnectOptions, Connection};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::TempDir;

/// An open index. What it is asked lies beside its rows, in the files of this folder.
#[derive(Debug)]
pub(crate) struct Index {
    runtime: tokio::runtime::Runtime,
    connection: Mutex<SqliteConnection>,
    path: PathBuf,
    /// Where the copy lies that is read in place of an index that cannot be opened where it is.
    _copy: Option<TempDir>,
}

/// SQLite's answer to a write where only reading is possible.
const READ_ONLY: i32 = 8;

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

    /// Opens an index on a medium that cannot be written, in whatever format: where SQLite cannot read it there,
    /// because its last changes are still in a log beside it or its format is an older one, a copy of it is read.
    pub(crate) fn open_unwritable(path: &Path) -> Result<Self, CatalogError> {
        Self::open_to_read(path).or_else(|_| Self::open_copy(path))
    }

    fn open_copy(path: &Path) -> Result<Self, CatalogError> {
        let folder = tempfile::tempdir().map_err(CatalogError::file("copy the index of", path))?;
        let copy = folder.path().join("catalogue.db");
        for suffix in ["", "-wal"] {
            let (from, to) = (with_suffix(path, suffix), with_suffix(&copy, suffix));
            if from.is_file() {
                fs::copy(&from, &to).map_err(CatalogError::file("copy", &from))?;
                let mut permissions = fs::metadata(&to).map_err(CatalogError::file("read", &to))?.permissions();
                make_writable(&mut permissions);
                fs::set_permissions(&to, permissions).map_err(CatalogError::file("write", &to))?;
            }
        }
        let mut index = Self::open(&copy, false)?;
        index.run(async |db| sqlx::query("PRAGMA query_only = ON").execute(db).await.map(|_| ()))?;
        index.path = path.to_owned();
        index._copy = Some(folder);
        Ok(index)
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
        Ok(Self { runtime, connection: Mutex::new(connection), path: path.to_owned(), _copy: None })
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
        self.runtime.block_on(work(&mut connection)).map_err(|error| match &error {
            sqlx::Error::Database(refusal) if is_read_only(refusal.code().as_deref()) => {
                CatalogError::ReadOnly { path: self.path.parent().unwrap_or(Path::new("")).to_owned() }
            }
            _ => error.into(),
        })
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

/// Whether SQLite's code, whose lower byte is the kind, says that the database cannot be written.
fn is_read_only(code: Option<&str>) -> bool {
    code.and_then(|code| code.parse::<i32>().ok()).is_some_and(|code| code & 0xff == READ_ONLY)
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// A copy keeps the permissions of what it was copied from, which nobody may write.
fn make_writable(permissions: &mut fs::Permissions) {
    #[cfg(unix)]
    std::os::unix::fs::PermissionsExt::set_mode(permissions, 0o600);
    #[cfg(not(unix))]
    permissions.set_readonly(false);
}
