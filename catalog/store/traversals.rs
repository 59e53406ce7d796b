//! Recordings and traversals: what an ingest enters.

use super::catalog::{Catalog, can_be_written};
use crate::CatalogError;
use crate::index::{PlaceRow, RecordingRow, TraversalRow};
use crate::objects::Staging;
use crate::records::{self, TraversalRecord, encode};
use furrow_model::{Experience, ExperienceId, ObjectId, RecordingId, TimeSlot, TraversalId};

impl Catalog {
    /// Begins an ingest. Nothing is in the store until [`Catalog::enter_traversal`].
    ///
    /// # Errors
    /// [`CatalogError::ReadOnly`] where the store can only be looked at, [`CatalogError::File`] where `tmp/` cannot be
    /// written for another reason.
    pub fn begin_ingest(&self) -> Result<Staging, CatalogError> {
        Staging::begin(self.root(), self.objects()).map_err(|error| match error {
            _ if !can_be_written(&self.root().join("tmp")) => CatalogError::ReadOnly { path: self.root().to_owned() },
            other => other,
        })
    }

    /// The traversal that answers this very request, if it was ingested before.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversal_of_request(&self, request: ObjectId) -> Result<Option<TraversalId>, CatalogError> {
        self.index().traversal_of_request(request)
    }

    /// Ends an ingest: the staged objects become durable, then the rows that speak of them are entered in one
    /// transaction.
    ///
    /// # Errors
    /// Where the disk or the index refuses; the catalogue then is as it was.
    pub fn enter_traversal(
        &self,
        staging: &Staging,
        recording: &RecordingRow,
        experience: Option<&Experience>,
        traversal: &TraversalRecord,
        request: ObjectId,
    ) -> Result<TraversalId, CatalogError> {
        let experience = match experience {
            Some(experience) => Some((ExperienceId(staging.write(&encode(experience)?)?.0), experience)),
            None => None,
        };
        let id = TraversalId(staging.write(&encode(traversal)?)?.0);
        staging.publish()?;
        self.index().enter_traversal(recording, experience, &row_of(id, traversal), request)?;
        Ok(id)
    }

    /// Enters the version of traversal `earlier` with other true poses. It takes the earlier one's place in listings
    /// and for requests; the earlier one stays for what rests on it. `truth` is durable before a row speaks of it.
    ///
    /// # Errors
    /// [`CatalogError::NotFound`] where another version has taken its place already; where the disk or the index
    /// refuses. The catalogue then is as it was.
    pub fn attach_truth(&self, earlier: TraversalId, truth: &[u8]) -> Result<TraversalId, CatalogError> {
        let ground_truth = Some(self.objects().write(truth)?);
        let record = TraversalRecord { ground_truth, ..self.traversal(earlier)? };
        let later = TraversalId(self.objects().write(&encode(&record)?)?.0);
        if later != earlier && !self.index().supersede_traversal(earlier, &row_of(later, &record))? {
            return Err(CatalogError::NotFound(format!(
                "traversal {} has a later version already: `furrow ls` lists it",
                earlier.short()
            )));
        }
        Ok(later)
    }

    /// Traversals whose place another version took, each with that version, which may have lost its place as well.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn superseded(&self) -> Result<Vec<(TraversalId, TraversalId)>, CatalogError> {
        self.index().superseded()
    }

    /// All traversals that no later version supersedes, by site, purpose, slot, route and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversals(&self) -> Result<Vec<TraversalRow>, CatalogError> {
        self.index().traversals()
    }

    /// A traversal's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn traversal(&self, id: TraversalId) -> Result<TraversalRecord, CatalogError> {
        records::read(self.objects(), ObjectId(id.0))
    }

    /// How many traversals there are by site, slot and purpose, in that order.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn places(&self) -> Result<Vec<PlaceRow>, CatalogError> {
        self.index().places()
    }

    /// At most `most` traversals of a site and slot behind the first `skipped`, by purpose, route and id.
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

    /// All recordings, by id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn recordings(&self) -> Result<Vec<RecordingRow>, CatalogError> {
        self.index().recordings()
    }

    /// A recording and its parts; `None` where there is no such recording.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn recording(&self, id: RecordingId) -> Result<Option<RecordingRow>, CatalogError> {
        self.index().recording(id)
    }
}

/// A traversal's row in the index.
pub(super) fn row_of(id: TraversalId, record: &TraversalRecord) -> TraversalRow {
    TraversalRow {
        id,
        recording: record.recording,
        site: record.site.clone(),
        route: record.route.clone(),
        slot: record.slot,
        purpose: record.purpose,
        experience: record.experience,
    }
}
