//! Rows of runs.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{ObjectId, RunId};
use serde::Serialize;
use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

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

impl Index {
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

    /// One run's row.
    pub(crate) fn run_row(&self, id: RunId) -> Result<Option<RunRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM runs WHERE id = ?").bind(id.to_string()).fetch_optional(db).await
        })
    }
}
