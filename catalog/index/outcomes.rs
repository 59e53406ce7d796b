//! Rows of outcomes, and of the codebooks that they rest on.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::{CellKey, CodebookId, ObjectId};
use std::collections::BTreeSet;

impl Index {
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
