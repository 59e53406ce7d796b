//! What is said of sites.

use super::connection::Index;
use crate::CatalogError;
use serde::Serialize;
use sqlx::FromRow;

/// A site of which something is said.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, FromRow)]
pub struct SiteRow {
    /// The site.
    pub name: String,
    /// Minutes that its clocks are ahead of UTC.
    pub utc_offset_min: i32,
}

impl Index {
    /// Says how far a site's clocks are ahead of UTC, in place of what was said before.
    pub(crate) fn enter_site(&self, site: &SiteRow) -> Result<(), CatalogError> {
        self.transact(async |db| {
            sqlx::query("INSERT OR REPLACE INTO sites (name, utc_offset_min) VALUES (?, ?)")
                .bind(&site.name)
                .bind(site.utc_offset_min)
                .execute(db)
                .await?;
            Ok(())
        })
    }

    /// The sites of which something is said, by name.
    pub(crate) fn sites(&self) -> Result<Vec<SiteRow>, CatalogError> {
        self.run(async |db| sqlx::query_as("SELECT name, utc_offset_min FROM sites ORDER BY name").fetch_all(db).await)
    }
}
