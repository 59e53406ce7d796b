//! Later versions of traversals, which stand in every listing in place of the earlier ones.

use super::columns::parsed;
use super::connection::Index;
use super::traversals::{TraversalRow, insert_traversal};
use crate::{CatalogError, digest};
use furrow_model::{ObjectId, TraversalId};
use sqlx::sqlite::SqliteConnection;

impl Index {
    /// Enters a version of traversal `earlier` that takes its place: in listings, and as the answer to the request that
    /// led to it. All of it or nothing; false where another version has taken its place already.
    pub(crate) fn supersede_traversal(&self, earlier: TraversalId, later: &TraversalRow) -> Result<bool, CatalogError> {
        let mut is_current = true;
        self.transact(async |db| {
            let by: Option<String> = sqlx::query_scalar("SELECT by FROM superseded WHERE traversal = ?")
                .bind(earlier.to_string())
                .fetch_optional(&mut *db)
                .await?;
            is_current = by.is_none();
            if !is_current {
                return Ok(());
            }
            let row = sqlx::query("SELECT request FROM traversals WHERE id = ?")
                .bind(earlier.to_string())
                .fetch_one(&mut *db)
                .await?;
            let request: ObjectId = parsed(&row, "request")?;
            // Requests are unique, and a version that lost its place answers none.
            let unasked = digest(format!("superseded {earlier}").as_bytes());
            set_request(db, earlier, unasked).await?;
            insert_traversal(db, later, request).await?;
            set_request(db, later.id, request).await?;
            // True poses that came back make an earlier version the latest again.
            sqlx::query("DELETE FROM superseded WHERE traversal = ?")
                .bind(later.id.to_string())
                .execute(&mut *db)
                .await?;
            sqlx::query("INSERT INTO superseded VALUES (?, ?)")
                .bind(earlier.to_string())
                .bind(later.id.to_string())
                .execute(db)
                .await?;
            Ok(())
        })?;
        Ok(is_current)
    }

    /// Traversals whose place another version took, each with that version.
    pub(crate) fn superseded(&self) -> Result<Vec<(TraversalId, TraversalId)>, CatalogError> {
        self.run(async |db| {
            let rows = sqlx::query("SELECT traversal, by FROM superseded ORDER BY traversal").fetch_all(db).await?;
            rows.iter().map(|row| Ok((parsed(row, "traversal")?, parsed(row, "by")?))).collect()
        })
    }
}

async fn set_request(db: &mut SqliteConnection, id: TraversalId, request: ObjectId) -> Result<(), sqlx::Error> {
    sqlx::query("UPDATE traversals SET request = ? WHERE id = ?")
        .bind(request.to_string())
        .bind(id.to_string())
        .execute(db)
        .await?;
    Ok(())
}
