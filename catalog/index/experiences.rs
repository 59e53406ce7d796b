//! Rows of experiences.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{Experience, ExperienceId, ExperienceKind, TimeSlot};
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{FromRow, Row};

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

impl Index {
    /// Enters some experiences, parents before their children, in one transaction.
    pub(crate) fn enter_experiences(&self, all: &[(ExperienceId, &Experience)]) -> Result<(), CatalogError> {
        self.transact(async |db| {
            for (id, experience) in all {
                insert_experience(db, *id, experience).await?;
            }
            Ok(())
        })
    }

    /// All experiences, by site, slot, route and id.
    pub(crate) fn experiences(&self) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM experiences ORDER BY site, slot, route, id").fetch_all(db).await
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
