//! Rows of traversals.

use super::columns::{parsed, parsed_optional};
use super::connection::Index;
use super::experiences::insert_experience;
use super::recordings::{RecordingRow, insert_recording};
use crate::CatalogError;
use furrow_model::{Experience, ExperienceId, ObjectId, Purpose, RecordingId, TimeSlot, TraversalId};
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{FromRow, Row};

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

/// How many traversals there are of one site, slot and purpose.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceRow {
    /// Where.
    pub site: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// Traversals.
    pub traversals: u32,
}

impl FromRow<'_, SqliteRow> for PlaceRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            site: row.try_get("site")?,
            slot: parsed(row, "slot")?,
            purpose: parsed(row, "purpose")?,
            traversals: row.try_get("traversals")?,
        })
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

    /// Enters an ingested traversal, its recording and its experience in one transaction.
    pub(crate) fn enter_traversal(
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
            insert_traversal(db, traversal, request).await
        })
    }

    /// All traversals that no later version supersedes, by site, purpose, slot, route and id.
    pub(crate) fn traversals(&self) -> Result<Vec<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM traversals WHERE id NOT IN (SELECT traversal FROM superseded) ORDER BY site, purpose, slot, route, id").fetch_all(db).await
        })
    }

    /// At most `most` traversals of a site and slot behind the first `skipped`, by purpose, route and id.
    pub(crate) fn traversals_at(
        &self,
        site: &str,
        slot: TimeSlot,
        (skipped, most): (u32, u32),
    ) -> Result<Vec<TraversalRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as(
                "SELECT * FROM traversals WHERE site = ? AND purpose IN ('experience', 'evaluation', 'vocabulary') AND slot = ? AND id NOT IN (SELECT traversal FROM superseded) ORDER BY purpose, route, id LIMIT ? OFFSET ?",
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
            sqlx::query_as("SELECT * FROM traversals WHERE experience = ? AND id NOT IN (SELECT traversal FROM superseded) ORDER BY id")
                .bind(experience.to_string())
                .fetch_all(db)
                .await
        })
    }

    /// How many traversals there are, by site, slot and purpose.
    pub(crate) fn places(&self) -> Result<Vec<PlaceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as(
                "SELECT site, slot, purpose, count(*) AS traversals FROM traversals WHERE id NOT IN (SELECT traversal FROM superseded) GROUP BY site, purpose, slot ORDER BY site, slot, purpose",
            )
            .fetch_all(db)
            .await
        })
    }
}

/// Adds a traversal's row, if there is none of its id.
pub(super) async fn insert_traversal(
    db: &mut SqliteConnection,
    traversal: &TraversalRow,
    request: ObjectId,
) -> Result<(), sqlx::Error> {
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
}
