//! Rows of generators, and of what the quality gate measured of them.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{ExperienceId, ObjectId};
use serde::Serialize;
use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

/// A generator in the index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GeneratorRow {
    /// Its record.
    pub id: ObjectId,
    /// What users call it; of several with one name the latest answers to it.
    pub name: String,
    /// `otf`, `invariant`, `identity`, `gamma`, `noise`, `blur`, `command` or `onnx`.
    pub kind: String,
    /// Rises with every generator: the latest has the greatest.
    pub number: i64,
}

/// What the quality gate measured of a generator, in the index.
#[derive(Debug, Clone, PartialEq)]
pub struct GateRow {
    /// The generator.
    pub generator: ObjectId,
    /// The experience whose images it was measured on.
    pub parent: ExperienceId,
    /// The domainness.
    pub domainness: f64,
    /// The gate's record.
    pub object: ObjectId,
}

impl FromRow<'_, SqliteRow> for GeneratorRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: parsed(row, "id")?,
            name: row.try_get("name")?,
            kind: row.try_get("kind")?,
            number: row.try_get("number")?,
        })
    }
}

impl FromRow<'_, SqliteRow> for GateRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            generator: parsed(row, "generator")?,
            parent: parsed(row, "parent")?,
            domainness: row.try_get("domainness")?,
            object: parsed(row, "object")?,
        })
    }
}

impl Index {
    /// Enters a generator, or makes it the latest of its name again.
    pub(crate) fn enter_generator(&self, id: ObjectId, name: &str, kind: &str) -> Result<(), CatalogError> {
        self.transact(async |db| {
            sqlx::query("INSERT INTO generators (id, name, kind, number) VALUES (?, ?, ?, (SELECT coalesce(max(number), 0) + 1 FROM generators)) ON CONFLICT (id) DO UPDATE SET number = excluded.number")
                .bind(id.to_string())
                .bind(name)
                .bind(kind)
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// All generators, by name, the latest of each name last.
    pub(crate) fn generators(&self) -> Result<Vec<GeneratorRow>, CatalogError> {
        self.run(async |db| sqlx::query_as("SELECT * FROM generators ORDER BY name, number").fetch_all(db).await)
    }

    /// Enters what the gate measured.
    pub(crate) fn enter_gate(&self, gate: &GateRow) -> Result<(), CatalogError> {
        self.transact(async |db| {
            sqlx::query("INSERT OR REPLACE INTO gates VALUES (?, ?, ?, ?)")
                .bind(gate.generator.to_string())
                .bind(gate.parent.to_string())
                .bind(gate.domainness)
                .bind(gate.object.to_string())
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// What the gate measured of a generator, by experience and domainness.
    pub(crate) fn gates(&self, generator: ObjectId) -> Result<Vec<GateRow>, CatalogError> {
        self.run(async |db| {
            sqlx::query_as("SELECT * FROM gates WHERE generator = ? ORDER BY parent, domainness")
                .bind(generator.to_string())
                .fetch_all(db)
                .await
        })
    }
}
