//! What people ask of the index while they look around: parts of it, each answered without reading the rest.

use super::Index;
use super::rows::{ExperienceRow, RecordingRow, RunRow, TraversalRow, parsed, recording_of};
use crate::CatalogError;
use furrow_model::{CellKey, ExperienceId, Purpose, RecordingId, RunId, TimeSlot, TraversalId};
use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};
use std::collections::BTreeSet;

/// How many outings there are of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceRow {
    /// Where.
    pub site: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// Outings.
    pub outings: u32,
}

impl FromRow<'_, SqliteRow> for PlaceRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            site: row.try_get("site")?,
            slot: parsed(row, "slot")?,
            purpose: parsed(row, "purpose")?,
            outings: row.try_get("outings")?,
        })
    }
}

impl Index {
    /// What there is, by site, slot and purpose.
    pub(crate) fn places(&self) -> Result<Vec<PlaceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as(
                "SELECT site, slot, purpose, count(*) AS outings FROM traversals GROUP BY site, purpose, slot ORDER BY site, slot, purpose",
            )
            .fetch_all(db)
            .await
        })
    }

    /// At most `most` outings of a site and slot behind the first `skipped`, by purpose, route and id.
    pub(crate) fn traversals_at(
        &self,
        site: &str,
        slot: TimeSlot,
        (skipped, most): (u32, u32),
    ) -> Result<Vec<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as(
                "SELECT * FROM traversals WHERE site = ? AND purpose IN ('experience', 'evaluation', 'vocabulary') AND slot = ? ORDER BY purpose, route, id LIMIT ? OFFSET ?",
            )
            .bind(site)
            .bind(slot.to_string())
            .bind(most)
            .bind(skipped)
            .fetch_all(db)
            .await
        })
    }

    /// One traversal's row.
    pub(crate) fn traversal(&self, id: TraversalId) -> Result<Option<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM traversals WHERE id = ?").bind(id.to_string()).fetch_optional(db).await
        })
    }

    /// The traversals that an experience was made from, by id.
    pub(crate) fn traversals_of(&self, experience: ExperienceId) -> Result<Vec<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM traversals WHERE experience = ? ORDER BY id")
                .bind(experience.to_string())
                .fetch_all(db)
                .await
        })
    }

    /// One experience's row.
    pub(crate) fn experience(&self, id: ExperienceId) -> Result<Option<ExperienceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM experiences WHERE id = ?").bind(id.to_string()).fetch_optional(db).await
        })
    }

    /// The experiences generated from one, by slot and id.
    pub(crate) fn children(&self, parent: ExperienceId) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM experiences WHERE parent = ? ORDER BY slot, id")
                .bind(parent.to_string())
                .fetch_all(db)
                .await
        })
    }

    /// Experiences and nodes of each site: (site, recorded, generated, nodes).
    pub(crate) fn experiences_by_site(&self) -> Result<Vec<(String, u32, u32, i64)>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as(
                "SELECT site, sum(kind = 'recorded'), sum(kind <> 'recorded'), sum(nodes) FROM experiences GROUP BY site ORDER BY site",
            )
            .fetch_all(db)
            .await
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

    /// One run's row.
    pub(crate) fn run_row(&self, id: RunId) -> Result<Option<RunRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM runs WHERE id = ?").bind(id.to_string()).fetch_optional(db).await
        })
    }

    /// Which of some cells are finished.
    pub(crate) fn finished(&self, cells: &[CellKey]) -> Result<BTreeSet<CellKey>, CatalogError> {
        self.run(async |db| {
            let mut found = BTreeSet::new();
            for cell in cells {
                let row = sqlx::query("SELECT 1 FROM outcomes WHERE cell = ?").bind(cell.to_string());
                if row.fetch_optional(&mut *db).await?.is_some() {
                    found.insert(*cell);
                }
            }
            Ok(found)
        })
    }
}
