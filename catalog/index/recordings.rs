//! Rows of recordings and their files.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{ObjectId, RecordingId};
use serde::Serialize;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{FromRow, Row};

/// A recording: a file, or the parts of a split one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RecordingRow {
    /// The digest of its bytes.
    pub id: RecordingId,
    /// The name it first came under.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Its files.
    pub parts: Vec<RecordingPart>,
}

/// A file of a recording.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RecordingPart {
    /// The digest of the file's bytes; names it in `recordings/`.
    pub digest: ObjectId,
    /// The file's name.
    pub name: String,
    /// The file's size.
    pub bytes: u64,
}

impl FromRow<'_, SqliteRow> for RecordingPart {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        let bytes: i64 = row.try_get("bytes")?;
        Ok(Self { digest: parsed(row, "digest")?, name: row.try_get("name")?, bytes: bytes.unsigned_abs() })
    }
}

impl Index {
    /// All recordings with their parts, by id.
    pub(crate) fn recordings(&self) -> Result<Vec<RecordingRow>, CatalogError> {
        self.run(async |db| {
            let mut recordings = Vec::new();
            for row in sqlx::query("SELECT * FROM recordings ORDER BY id").fetch_all(&mut *db).await? {
                recordings.push(recording_of(db, &row).await?);
            }
            Ok(recordings)
        })
    }

    /// One recording with its parts.
    pub(crate) fn recording(&self, id: RecordingId) -> Result<Option<RecordingRow>, CatalogError> {
        self.run(async |db| {
            let row =
                sqlx::query("SELECT * FROM recordings WHERE id = ?").bind(id.to_string()).fetch_optional(&mut *db);
            match row.await? {
                Some(row) => recording_of(db, &row).await.map(Some),
                None => Ok(None),
            }
        })
    }
}

/// A recording's row with its parts.
async fn recording_of(db: &mut SqliteConnection, row: &SqliteRow) -> Result<RecordingRow, sqlx::Error> {
    let id: RecordingId = parsed(row, "id")?;
    let parts = sqlx::query_as("SELECT * FROM recording_parts WHERE recording = ? ORDER BY ordinal")
        .bind(id.to_string())
        .fetch_all(db)
        .await?;
    let bytes: i64 = row.try_get("bytes")?;
    Ok(RecordingRow { id, name: row.try_get("name")?, bytes: bytes.unsigned_abs(), parts })
}

pub(super) async fn insert_recording(db: &mut SqliteConnection, recording: &RecordingRow) -> Result<(), sqlx::Error> {
    sqlx::query("INSERT OR IGNORE INTO recordings VALUES (?, ?, ?)")
        .bind(recording.id.to_string())
        .bind(&recording.name)
        .bind(recording.bytes as i64)
        .execute(&mut *db)
        .await?;
    for (ordinal, part) in recording.parts.iter().enumerate() {
        sqlx::query("INSERT OR IGNORE INTO recording_parts VALUES (?, ?, ?, ?, ?)")
            .bind(recording.id.to_string())
            .bind(ordinal as i64)
            .bind(part.digest.to_string())
            .bind(&part.name)
            .bind(part.bytes as i64)
            .execute(&mut *db)
            .await?;
    }
    Ok(())
}
