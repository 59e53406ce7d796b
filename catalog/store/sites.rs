//! Sites: what is said of them beside their traversals.

use super::catalog::Catalog;
use crate::CatalogError;
use crate::index::SiteRow;

impl Catalog {
    /// Says how far a site's clocks are ahead of UTC, in place of what was said before.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn set_utc_offset(&self, site: &str, utc_offset_min: i32) -> Result<(), CatalogError> {
        self.index().enter_site(&SiteRow { name: site.to_owned(), utc_offset_min })
    }

    /// How far a site's clocks are ahead of UTC, in minutes; `None` where nothing is said.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn utc_offset_min(&self, site: &str) -> Result<Option<i32>, CatalogError> {
        let known = self.index().sites()?.into_iter().find(|row| row.name == site);
        Ok(known.map(|row| row.utc_offset_min))
    }
}
