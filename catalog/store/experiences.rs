//! Experiences, recorded and generated.

use super::catalog::Catalog;
use crate::CatalogError;
use crate::index::ExperienceRow;
use crate::records::{self, encode};
use furrow_model::{Experience, ExperienceId, ObjectId};

/// What a site holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiteCounts {
    /// The site.
    pub site: String,
    /// Recorded experiences.
    pub recorded: u32,
    /// Generated ones.
    pub generated: u32,
    /// Nodes of all of them.
    pub nodes: u64,
}

impl Catalog {
    /// Enters a generated experience together with its parent, whose version need not have been entered before.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_generated(&self, parent: &Experience, child: &Experience) -> Result<ExperienceId, CatalogError> {
        let entered = |experience| Ok::<_, CatalogError>(ExperienceId(self.objects().write(&encode(experience)?)?.0));
        let (parent_id, id) = (entered(parent)?, entered(child)?);
        self.index().enter_experiences(&[(parent_id, parent), (id, child)])?;
        Ok(id)
    }

    /// All experiences, by site, slot, route and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn experiences(&self) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.index().experiences()
    }

    /// An experience's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn experience(&self, id: ExperienceId) -> Result<Experience, CatalogError> {
        records::read(self.objects(), ObjectId(id.0))
    }

    /// An experience's row; `None` where there is no such experience.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn experience_row(&self, id: ExperienceId) -> Result<Option<ExperienceRow>, CatalogError> {
        self.index().experience(id)
    }

    /// The experiences that were generated from one, by slot and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn children(&self, parent: ExperienceId) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.index().children(parent)
    }

    /// Experiences and nodes of every site that has any, by name.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn site_counts(&self) -> Result<Vec<SiteCounts>, CatalogError> {
        let counted = |(site, recorded, generated, nodes): (String, u32, u32, i64)| SiteCounts {
            site,
            recorded,
            generated,
            nodes: nodes.unsigned_abs(),
        };
        Ok(self.index().experiences_by_site()?.into_iter().map(counted).collect())
    }
}
