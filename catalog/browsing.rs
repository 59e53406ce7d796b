//! Parts of the index for those who look around in a large store.

use crate::index::{ExperienceRow, PlaceRow, RecordingRow, RunRow, TraversalRow};
use crate::{Catalog, CatalogError};
use furrow_model::{CellKey, ExperienceId, RecordingId, RunId, TimeSlot, TraversalId};
use std::collections::BTreeSet;
use std::path::PathBuf;

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
    /// How many outings there are by site, slot and purpose, in that order.
    ///
    /// # Errors
    /// [`CatalogError::Index`], as of all questions here.
    pub fn places(&self) -> Result<Vec<PlaceRow>, CatalogError> {
        self.index().places()
    }

    /// At most `most` outings of a site and slot behind the first `skipped`, by purpose, route and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversals_at(
        &self,
        site: &str,
        slot: TimeSlot,
        (skipped, most): (u32, u32),
    ) -> Result<Vec<TraversalRow>, CatalogError> {
        self.index().traversals_at(site, slot, (skipped, most))
    }

    /// A traversal's row; `None` where there is no such traversal.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversal_row(&self, id: TraversalId) -> Result<Option<TraversalRow>, CatalogError> {
        self.index().traversal(id)
    }

    /// The traversals that an experience was made from.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversals_of(&self, experience: ExperienceId) -> Result<Vec<TraversalRow>, CatalogError> {
        self.index().traversals_of(experience)
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

    /// A recording and its parts; `None` where there is no such recording.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn recording(&self, id: RecordingId) -> Result<Option<RecordingRow>, CatalogError> {
        self.index().recording(id)
    }

    /// A run's row; `None` where there is no such run.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn run_row(&self, id: RunId) -> Result<Option<RunRow>, CatalogError> {
        self.index().run_row(id)
    }

    /// Which of some cells are finished, as far as the index knows.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn finished(&self, cells: &[CellKey]) -> Result<BTreeSet<CellKey>, CatalogError> {
        self.index().finished(cells)
    }

    /// The folder for pages that a user keeps with the store.
    pub fn reports_folder(&self) -> PathBuf {
        self.root().join("reports")
    }
}
