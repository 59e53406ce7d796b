//! Rows about work: what stages took, and which cells failed.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{CellKey, RunId};
use serde::Serialize;
use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

/// What a stage of a run took.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimingRow {
    /// The stage, without slots and labels.
    pub stage: String,
    /// The codebook that was trained; else empty.
    pub subject: String,
    /// Images, frames, nodes or cells.
    pub units: u64,
    /// Wall clock.
    pub seconds: f64,
    /// On so many threads.
    pub threads: u32,
}

/// A cell that failed, and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FailureRow {
    /// The cell.
    pub cell: CellKey,
    /// The run that it failed in.
    pub run: RunId,
    /// Why.
    pub reason: String,
}

impl FromRow<'_, SqliteRow> for TimingRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            stage: row.try_get("stage")?,
            subject: row.try_get("subject")?,
            units: row.try_get::<i64, _>("units")?.unsigned_abs(),
            seconds: row.try_get("seconds")?,
            threads: row.try_get("threads")?,
        })
    }
}

impl FromRow<'_, SqliteRow> for FailureRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self { cell: parsed(row, "cell")?, run: parsed(row, "run")?, reason: row.try_get("reason")? })
    }
}

impl Index {
    /// Enters what stages took.
    pub(crate) fn enter_timings(&self, timings: &[TimingRow]) -> Result<(), CatalogError> {
        self.transact(async |db| {
            for timing in timings {
                sqlx::query(
                    "INSERT INTO timings VALUES (?, ?, ?, ?, ?, (SELECT coalesce(max(number), 0) + 1 FROM timings))",
                )
                .bind(&timing.stage)
                .bind(&timing.subject)
                .bind(timing.units as i64)
                .bind(timing.seconds)
                .bind(timing.threads)
                .execute(&mut *db)
                .await?;
            }
            Ok(())
        })
    }

    /// What a stage took lately, the latest first.
    pub(crate) fn timings(&self, stage: &str, most: u32) -> Result<Vec<TimingRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM timings WHERE stage = ? ORDER BY number DESC LIMIT ?")
                .bind(stage)
                .bind(most)
                .fetch_all(db)
                .await
        })
    }

    /// Replaces what is known of the failures of some cells: of those that were `tried`, these `failed`.
    pub(crate) fn enter_failures(&self, tried: &[CellKey], failed: &[FailureRow]) -> Result<(), CatalogError> {
        self.transact(async |db| {
            for cell in tried {
                sqlx::query("DELETE FROM failures WHERE cell = ?").bind(cell.to_string()).execute(&mut *db).await?;
            }
            for row in failed {
                sqlx::query("INSERT OR REPLACE INTO failures VALUES (?, ?, ?)")
                    .bind(row.cell.to_string())
                    .bind(row.run.to_string())
                    .bind(&row.reason)
                    .execute(&mut *db)
                    .await?;
            }
            Ok(())
        })
    }

    /// All cells that failed when they were last tried.
    pub(crate) fn failures(&self) -> Result<Vec<FailureRow>, CatalogError> {
        self.run(async |db| sqlx::query_as("SELECT * FROM failures ORDER BY cell").fetch_all(db).await)
    }
}
