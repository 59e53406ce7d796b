//! The index' rows.

use super::Index;
use crate::CatalogError;
use furrow_model::{
    CellKey, CodebookId, Experience, ExperienceId, ExperienceKind, ObjectId, Purpose, RecordingId, RunId, TimeSlot,
    TraversalId,
};
use serde::Serialize;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{FromRow, Row};
use std::str::FromStr;

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

/// A traversal in the index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TraversalRow {
    /// Its id.
    pub id: TraversalId,
    /// Its recording.
    pub recording: RecordingId,
    /// Where.
    pub site: String,
    /// Along which route.
    pub route: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// The experience made from it.
    pub experience: Option<ExperienceId>,
}

/// An experience in the index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExperienceRow {
    /// Its id.
    pub id: ExperienceId,
    /// Where.
    pub site: String,
    /// Along which route.
    pub route: String,
    /// At, or mimicking, what time of day.
    pub slot: TimeSlot,
    /// Whether a camera recorded it.
    pub recorded: bool,
    /// Its nodes.
    pub nodes: u32,
}

/// A run in the index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RunRow {
    /// Its id.
    pub id: RunId,
    /// The matrix' name.
    pub matrix: String,
    /// Its record.
    pub object: ObjectId,
    /// Rises with every run: the latest has the greatest.
    pub number: i64,
}

/// Reads a column's text as a value of the model.
pub(super) fn parsed<T: FromStr<Err: std::fmt::Display>>(row: &SqliteRow, column: &str) -> Result<T, sqlx::Error> {
    let text: String = row.try_get(column)?;
    text.parse().map_err(|error: T::Err| sqlx::Error::ColumnDecode {
        index: column.to_owned(),
        source: error.to_string().into(),
    })
}

fn parsed_optional<T: FromStr<Err: std::fmt::Display>>(
    row: &SqliteRow,
    column: &str,
) -> Result<Option<T>, sqlx::Error> {
    let text: Option<String> = row.try_get(column)?;
    text.map(|_| parsed(row, column)).transpose()
}

/// A row's pointer: its table, and the object it speaks of.
pub(crate) type Reference = (&'static str, ObjectId);

impl FromRow<'_, SqliteRow> for TraversalRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: parsed(row, "id")?,
            recording: parsed(row, "recording")?,
            site: row.try_get("site")?,
            route: row.try_get("route")?,
            slot: parsed(row, "slot")?,
            purpose: parsed(row, "purpose")?,
            experience: parsed_optional(row, "experience")?,
        })
    }
}

impl FromRow<'_, SqliteRow> for ExperienceRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: parsed(row, "id")?,
            site: row.try_get("site")?,
            route: row.try_get("route")?,
            slot: parsed(row, "slot")?,
            recorded: row.try_get::<String, _>("kind")? == "recorded",
            nodes: row.try_get("nodes")?,
        })
    }
}

impl FromRow<'_, SqliteRow> for RunRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: parsed(row, "id")?,
            matrix: row.try_get("matrix")?,
            object: parsed(row, "object")?,
            number: row.try_get("number")?,
        })
    }
}

impl FromRow<'_, SqliteRow> for RecordingPart {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        let bytes: i64 = row.try_get("bytes")?;
        Ok(Self { digest: parsed(row, "digest")?, name: row.try_get("name")?, bytes: bytes.unsigned_abs() })
    }
}

impl Index {
    /// The traversal that answers a request, if it was ever ingested.
    pub(crate) fn traversal_of_request(&self, request: ObjectId) -> Result<Option<TraversalId>, CatalogError> {
        self.run(async |db| {
            let row = sqlx::query("SELECT id FROM traversals WHERE request = ?")
                .bind(request.to_string())
                .fetch_optional(db)
                .await?;
            row.map(|row| parsed(&row, "id")).transpose()
        })
    }

    /// Enters an ingested outing: recording, experience and traversal in one transaction.
    pub(crate) fn enter_outing(
        &self,
        recording: &RecordingRow,
        experience: Option<(ExperienceId, &Experience)>,
        traversal: &TraversalRow,
        request: ObjectId,
    ) -> Result<(), CatalogError> {
        self.transact(async |db| {
            insert_recording(db, recording).await?;
            if let Some((id, experience)) = experience {
                insert_experience(db, id, experience).await?;
            }
            sqlx::query("INSERT OR IGNORE INTO traversals VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
                .bind(traversal.id.to_string())
                .bind(traversal.recording.to_string())
                .bind(&traversal.site)
                .bind(&traversal.route)
                .bind(traversal.slot.to_string())
                .bind(traversal.purpose.to_string())
                .bind(request.to_string())
                .bind(traversal.experience.map(|id| id.to_string()))
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// All traversals, by site, purpose, slot, route and id.
    pub(crate) fn traversals(&self) -> Result<Vec<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM traversals ORDER BY site, purpose, slot, route, id").fetch_all(db).await
        })
    }

    /// All experiences, by site, slot, route and id.
    pub(crate) fn experiences(&self) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM experiences ORDER BY site, slot, route, id").fetch_all(db).await
        })
    }

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

    /// Enters a codebook.
    pub(crate) fn enter_codebook(&self, id: CodebookId, site: &str, words: u32) -> Result<(), CatalogError> {
        self.transact(async |db| {
            sqlx::query("INSERT OR IGNORE INTO codebooks VALUES (?, ?, ?)")
                .bind(id.to_string())
                .bind(site)
                .bind(words)
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// Enters outcomes of cells, all at once.
    pub(crate) fn enter_outcomes(&self, outcomes: &[(CellKey, ObjectId)]) -> Result<(), CatalogError> {
        self.transact(async |db| {
            for (cell, object) in outcomes {
                sqlx::query("INSERT OR REPLACE INTO outcomes VALUES (?, ?)")
                    .bind(cell.to_string())
                    .bind(object.to_string())
                    .execute(&mut *db)
                    .await?;
            }
            Ok(())
        })
    }

    /// The outcome of a cell, if it was ever finished.
    pub(crate) fn outcome(&self, cell: CellKey) -> Result<Option<ObjectId>, CatalogError> {
        self.run(async |db| {
            let row = sqlx::query("SELECT object FROM outcomes WHERE cell = ?")
                .bind(cell.to_string())
                .fetch_optional(db)
                .await?;
            row.map(|row| parsed(&row, "object")).transpose()
        })
    }

    /// Enters a run, or makes it the latest again.
    pub(crate) fn enter_run(&self, id: RunId, matrix: &str, object: ObjectId) -> Result<(), CatalogError> {
        self.transact(async |db| {
            sqlx::query("INSERT INTO runs (id, matrix, object, number) VALUES (?, ?, ?, (SELECT coalesce(max(number), 0) + 1 FROM runs)) ON CONFLICT (id) DO UPDATE SET number = excluded.number")
                .bind(id.to_string())
                .bind(matrix)
                .bind(object.to_string())
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// All runs, the latest last.
    pub(crate) fn runs(&self) -> Result<Vec<RunRow>, CatalogError> {
        self.run(async |db| sqlx::query_as("SELECT * FROM runs ORDER BY number").fetch_all(db).await)
    }

    /// Every (table, object) that rows point at, and the number of rows.
    pub(crate) fn references(&self) -> Result<(u64, Vec<Reference>), CatalogError> {
        const POINTERS: [(&str, &str); 7] = [
            ("experiences", "SELECT id FROM experiences"),
            ("traversals", "SELECT id FROM traversals"),
            ("codebooks", "SELECT id FROM codebooks"),
            ("generators", "SELECT id FROM generators"),
            ("gates", "SELECT object AS id FROM gates"),
            ("outcomes", "SELECT object AS id FROM outcomes"),
            ("runs", "SELECT object AS id FROM runs"),
        ];
        self.run(async |db| {
            let mut references = Vec::new();
            for (table, query) in POINTERS {
                for row in sqlx::query(query).fetch_all(&mut *db).await? {
                    references.push((table, parsed(&row, "id")?));
                }
            }
            let others: i64 =
                sqlx::query_scalar("SELECT (SELECT count(*) FROM recordings) + (SELECT count(*) FROM recording_parts)")
                    .fetch_one(&mut *db)
                    .await?;
            Ok((references.len() as u64 + others.unsigned_abs(), references))
        })
    }

    /// What SQLite's own check finds; empty where all is well.
    pub(crate) fn integrity(&self) -> Result<Vec<String>, CatalogError> {
        let words: Vec<String> =
            self.run(async |db| sqlx::query_scalar("PRAGMA integrity_check").fetch_all(db).await)?;
        Ok(words.into_iter().filter(|word| word != "ok").collect())
    }
}

/// A recording's row with its parts.
pub(super) async fn recording_of(db: &mut SqliteConnection, row: &SqliteRow) -> Result<RecordingRow, sqlx::Error> {
    let id: RecordingId = parsed(row, "id")?;
    let parts = sqlx::query_as("SELECT * FROM recording_parts WHERE recording = ? ORDER BY ordinal")
        .bind(id.to_string())
        .fetch_all(db)
        .await?;
    let bytes: i64 = row.try_get("bytes")?;
    Ok(RecordingRow { id, name: row.try_get("name")?, bytes: bytes.unsigned_abs(), parts })
}

async fn insert_recording(db: &mut SqliteConnection, recording: &RecordingRow) -> Result<(), sqlx::Error> {
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

pub(super) async fn insert_experience(
    db: &mut SqliteConnection,
    id: ExperienceId,
    experience: &Experience,
) -> Result<(), sqlx::Error> {
    let (kind, parent, slot) = match &experience.kind {
        ExperienceKind::Recorded => ("recorded", None, experience.slot),
        ExperienceKind::Generated { parent, mimics, .. } => ("generated", Some(parent.to_string()), *mimics),
    };
    sqlx::query("INSERT OR IGNORE INTO experiences VALUES (?, ?, ?, ?, ?, ?, ?)")
        .bind(id.to_string())
        .bind(&experience.site)
        .bind(&experience.route)
        .bind(slot.to_string())
        .bind(kind)
        .bind(parent)
        .bind(experience.nodes.len() as i64)
        .execute(db)
        .await?;
    Ok(())
}
