//! The catalogue: one store, opened by the submitting process.

use crate::index::{
    ExperienceRow, FailureRow, GateRow, GeneratorRow, Index, RecordingRow, RunRow, TimingRow, TraversalRow,
};
use crate::objects::sync_folder;
use crate::records::{self, CodebookRecord, GeneratorRecord, RunRecord, TraversalRecord, encode};
use crate::{CatalogError, Objects, Staging};
use furrow_model::{CellKey, CodebookId, Experience, ExperienceId, ObjectId, Outcome, RunId, TraversalId};
use std::fs;
use std::path::{Path, PathBuf};

/// An open store.
#[derive(Debug)]
pub struct Catalog {
    root: PathBuf,
    objects: Objects,
    index: Index,
}

/// The file that makes a folder a store.
const DATABASE: &str = "catalogue.db";
/// The store's folders.
const FOLDERS: [&str; 7] = ["objects", "derived", "recordings", "quarantine", "runs", "reports", "tmp"];

impl Catalog {
    /// Makes a store in `root`, or opens the one that is there.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the folders cannot be made.
    pub fn init(root: &Path) -> Result<Self, CatalogError> {
        for name in FOLDERS {
            let folder = root.join(name);
            fs::create_dir_all(&folder).map_err(CatalogError::file("make folder", &folder))?;
        }
        for shelves in ["objects", "derived"].map(|name| root.join(name)) {
            for shelf in (0..=u8::MAX).map(|number| shelves.join(format!("{number:02x}"))) {
                fs::create_dir_all(&shelf).map_err(CatalogError::file("make folder", &shelf))?;
            }
            sync_folder(&shelves)?;
        }
        let catalog = Self::with_index(root, Index::open(&root.join(DATABASE), true)?);
        sync_folder(root)?;
        Ok(catalog)
    }

    /// Opens the store in `root`.
    ///
    /// # Errors
    /// [`CatalogError::NoStore`] where there is none.
    pub fn open(root: &Path) -> Result<Self, CatalogError> {
        if !root.join(DATABASE).is_file() {
            return Err(CatalogError::NoStore { path: root.to_owned() });
        }
        Ok(Self::with_index(root, Index::open(&root.join(DATABASE), false)?))
    }

    /// Opens the store in `root` to look at it. Its index cannot be written; while no other process writes to it, no file appears or changes,
    /// either.
    ///
    /// # Errors
    /// [`CatalogError::NoStore`] where there is none, [`CatalogError::OtherFormat`] where its index is of another format.
    pub fn open_to_read(root: &Path) -> Result<Self, CatalogError> {
        if !root.join(DATABASE).is_file() {
            return Err(CatalogError::NoStore { path: root.to_owned() });
        }
        Ok(Self::with_index(root, Index::open_to_read(&root.join(DATABASE))?))
    }

    /// The store in `root` as a worker sees it: its objects, and of its rows only those of these passes and generators, in memory. The
    /// store's own index is not touched; what a worker enters is in the objects, and the submitting process enters the rows.
    ///
    /// # Errors
    /// Where a record cannot be read.
    pub fn detached(root: &Path, passes: &[TraversalId], generators: &[ObjectId]) -> Result<Self, CatalogError> {
        let catalog = Self::with_index(root, Index::scratch()?);
        for id in passes {
            let record = catalog.traversal(*id)?;
            let experience =
                record.experience.map(|id| Ok::<_, CatalogError>((id, catalog.experience(id)?))).transpose()?;
            let recording = RecordingRow { id: record.recording, name: String::new(), bytes: 0, parts: Vec::new() };
            let of = experience.as_ref().map(|(id, experience)| (*id, experience));
            // Nothing is ingested here: the pass' own id stands for the request that led to it.
            catalog.index.enter_outing(&recording, of, &row_of(*id, &record), ObjectId(id.0))?;
        }
        for id in generators {
            let record = catalog.generator(*id)?;
            catalog.index.enter_generator(*id, &record.name, &record.kind)?;
        }
        Ok(catalog)
    }

    /// The nearest folder upwards from `start` that holds a store.
    ///
    /// # Errors
    /// [`CatalogError::NoneAbove`] where none does.
    pub fn find(start: &Path) -> Result<PathBuf, CatalogError> {
        start
            .ancestors()
            .find(|folder| folder.join(DATABASE).is_file())
            .map(Path::to_owned)
            .ok_or_else(|| CatalogError::NoneAbove { start: start.to_owned() })
    }

    fn with_index(root: &Path, index: Index) -> Self {
        Self { root: root.to_owned(), objects: Objects::new(root), index }
    }

    /// The store's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Where the state of a job that may be killed lies until it is done. The next ingest clears it away: a job that finds nothing starts anew.
    pub fn unfinished(&self, name: &str) -> PathBuf {
        self.root.join("tmp").join(name)
    }

    /// Where what workers tell of a run lies: logs and reports, for people and for the submitting process. No result depends on them.
    pub fn run_folder(&self, run: RunId) -> PathBuf {
        self.root.join("runs").join(run.to_string())
    }

    /// The objects, for reading and for workers.
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    pub(crate) fn index(&self) -> &Index {
        &self.index
    }

    /// Where a recording's file lies, or would lie.
    pub fn recording_path(&self, digest: ObjectId) -> PathBuf {
        self.root.join("recordings").join(digest.to_string())
    }

    /// Begins an ingest. Nothing is in the store until [`Catalog::enter_outing`].
    ///
    /// # Errors
    /// [`CatalogError::File`] where `tmp/` cannot be written.
    pub fn begin(&self) -> Result<Staging, CatalogError> {
        Staging::begin(&self.root, &self.objects)
    }

    /// The traversal that answers this very request, if it was ingested before.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversal_of_request(&self, request: ObjectId) -> Result<Option<TraversalId>, CatalogError> {
        self.index.traversal_of_request(request)
    }

    /// Ends an ingest: the staged objects become durable, then the rows that speak of them are entered in one transaction.
    ///
    /// # Errors
    /// Where the disk or the index refuses; the catalogue then is as it was.
    pub fn enter_outing(
        &self,
        staging: &Staging,
        recording: &RecordingRow,
        experience: Option<&Experience>,
        traversal: &TraversalRecord,
        request: ObjectId,
    ) -> Result<TraversalId, CatalogError> {
        let experience = match experience {
            Some(experience) => Some((ExperienceId(staging.write(&encode(experience))?.0), experience)),
            None => None,
        };
        let id = TraversalId(staging.write(&encode(traversal))?.0);
        staging.publish()?;
        self.index.enter_outing(recording, experience, &row_of(id, traversal), request)?;
        Ok(id)
    }

    /// All traversals, by site, purpose, slot, route and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn traversals(&self) -> Result<Vec<TraversalRow>, CatalogError> {
        self.index.traversals()
    }

    /// All experiences, by site, slot, route and id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn experiences(&self) -> Result<Vec<ExperienceRow>, CatalogError> {
        self.index.experiences()
    }

    /// All recordings, by id.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn recordings(&self) -> Result<Vec<RecordingRow>, CatalogError> {
        self.index.recordings()
    }

    /// All runs, the latest last.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn runs(&self) -> Result<Vec<RunRow>, CatalogError> {
        self.index.runs()
    }

    /// A traversal's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn traversal(&self, id: TraversalId) -> Result<TraversalRecord, CatalogError> {
        records::read(&self.objects, ObjectId(id.0))
    }

    /// An experience's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn experience(&self, id: ExperienceId) -> Result<Experience, CatalogError> {
        records::read(&self.objects, ObjectId(id.0))
    }

    /// Enters a codebook that was trained.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_codebook(&self, record: &CodebookRecord) -> Result<CodebookId, CatalogError> {
        let id = CodebookId(self.objects.write(&encode(record))?.0);
        self.index.enter_codebook(id, &record.site, record.words)?;
        Ok(id)
    }

    /// Enters a generator; it then answers to its name.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_generator(&self, record: &GeneratorRecord) -> Result<ObjectId, CatalogError> {
        let id = self.objects.write(&encode(record))?;
        self.index.enter_generator(id, &record.name, &record.kind)?;
        Ok(id)
    }

    /// All generators, by name, the latest of each name last.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn generators(&self) -> Result<Vec<GeneratorRow>, CatalogError> {
        self.index.generators()
    }

    /// A generator's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn generator(&self, id: ObjectId) -> Result<GeneratorRecord, CatalogError> {
        records::read(&self.objects, id)
    }

    /// Enters a generated experience together with its parent, whose version need not have been entered before.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_generated(&self, parent: &Experience, child: &Experience) -> Result<ExperienceId, CatalogError> {
        let entered = |experience| Ok::<_, CatalogError>(ExperienceId(self.objects.write(&encode(experience))?.0));
        let (parent_id, id) = (entered(parent)?, entered(child)?);
        self.index.enter_experiences(&[(parent_id, parent), (id, child)])?;
        Ok(id)
    }

    /// Enters what the quality gate measured, its record and its parent experience being stored.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_gate(&self, gate: &GateRow) -> Result<(), CatalogError> {
        self.index.enter_gate(gate)
    }

    /// What the quality gate measured of a generator, by experience and domainness.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn gates(&self, generator: ObjectId) -> Result<Vec<GateRow>, CatalogError> {
        self.index.gates(generator)
    }

    /// Enters the outcome of a cell. It is remembered among the derivations too: so the submitting process finds what workers finished.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_outcome(&self, outcome: &Outcome) -> Result<ObjectId, CatalogError> {
        let object = self.objects.write(&encode(outcome))?;
        self.objects.remember(ObjectId(outcome.key.0), object)?;
        self.index.enter_outcomes(&[(outcome.key, object)])?;
        Ok(object)
    }

    /// Enters the outcomes that workers finished of these cells; how many that are.
    ///
    /// # Errors
    /// Where a pointer cannot be read, or the index refuses.
    pub fn collect_outcomes(&self, cells: &[CellKey]) -> Result<usize, CatalogError> {
        let found = cells.iter().map(|cell| Ok((*cell, self.objects.derived(ObjectId(cell.0))?)));
        let found = found.collect::<Result<Vec<_>, CatalogError>>()?;
        let found: Vec<(CellKey, ObjectId)> =
            found.into_iter().filter_map(|(cell, object)| Some((cell, object?))).collect();
        self.index.enter_outcomes(&found)?;
        Ok(found.len())
    }

    /// The outcome of a cell, if it was ever finished and is whole.
    ///
    /// # Errors
    /// Where the index or the record cannot be read.
    pub fn outcome(&self, cell: CellKey) -> Result<Option<Outcome>, CatalogError> {
        match self.index.outcome(cell)? {
            Some(object) if self.objects.contains(object) => records::read(&self.objects, object).map(Some),
            _ => Ok(None),
        }
    }

    /// Enters a run.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_run(&self, record: &RunRecord) -> Result<RunId, CatalogError> {
        let object = self.objects.write(&encode(record))?;
        let id = RunId(object.0);
        self.index.enter_run(id, &record.name, object)?;
        Ok(id)
    }

    /// A run's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn run(&self, id: RunId) -> Result<RunRecord, CatalogError> {
        records::read(&self.objects, ObjectId(id.0))
    }

    /// Enters what the stages of a run took.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_timings(&self, timings: &[TimingRow]) -> Result<(), CatalogError> {
        self.index.enter_timings(timings)
    }

    /// What a stage took lately, the latest first.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn timings(&self, stage: &str, most: u32) -> Result<Vec<TimingRow>, CatalogError> {
        self.index.timings(stage, most)
    }

    /// Enters which of the cells that were tried failed; the others did not, as far as is known.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_failures(&self, tried: &[CellKey], failed: &[FailureRow]) -> Result<(), CatalogError> {
        self.index.enter_failures(tried, failed)
    }

    /// All cells that failed when they were last tried.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn failures(&self) -> Result<Vec<FailureRow>, CatalogError> {
        self.index.failures()
    }
}

fn row_of(id: TraversalId, record: &TraversalRecord) -> TraversalRow {
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
