//! What `fsck` asks of the index.

use super::columns::parsed;
use super::connection::Index;
use crate::CatalogError;
use furrow_model::ObjectId;

/// A row's pointer: its table, and the object it speaks of.
pub(crate) type Reference = (&'static str, ObjectId);

impl Index {
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
