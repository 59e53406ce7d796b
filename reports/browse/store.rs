//! The store as pages see it: opened afresh for each page, never written to; what was read lately is kept in memory.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::insight::Insight;
use crate::browse::template::Templates;
use axum::http::StatusCode;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects, Views};
use furrow_model::{ExperienceId, ObjectId, Trajectory, TraversalId};
use hashlink::LruCache;
use std::hash::Hash;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// What pages share.
pub(crate) struct Store {
    root: PathBuf,
    name: String,
    objects: Objects,
    pub insight: Box<dyn Insight>,
    templates: Templates,
    frames: Kept<ObjectId, Vec<Frame>>,
    chains: Kept<ObjectId, Trajectory>,
    views: Kept<ObjectId, Views>,
    experiences: Kept<ExperienceId, furrow_model::Experience>,
    pub pictures: Kept<crate::browse::pictures::Wanted, Vec<u8>>,
}

/// What was made last, the latest used last.
pub(crate) struct Kept<K, V>(Mutex<LruCache<K, Arc<V>>>);

impl<K: Hash + Eq, V> Kept<K, V> {
    fn of(most: usize) -> Self {
        Self(Mutex::new(LruCache::new(most)))
    }

    /// What is kept under a key, or what `make` makes. Two who ask at once may both make it.
    pub fn or_made<E>(&self, key: K, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        // A panic elsewhere leaves the cache itself sound.
        let cache = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kept) = cache().get(&key) {
            return Ok(kept.clone());
        }
        let made = Arc::new(make()?);
        cache().insert(key, made.clone());
        Ok(made)
    }
}

impl Store {
    pub fn open(root: &Path, insight: Box<dyn Insight>) -> Result<Self, BrowseError> {
        let catalog = Catalog::open_to_read(root)?;
        let name = root.canonicalize().ok().and_then(|root| Some(root.file_name()?.to_string_lossy().into_owned()));
        Ok(Self {
            root: root.to_owned(),
            name: crate::wording::shown(&name.unwrap_or_default()),
            objects: catalog.objects().clone(),
            insight,
            templates: Templates::new()?,
            // An hour's frames are 5 MB and its chain 20; a picture is at most some 150 kB.
            frames: Kept::of(64),
            chains: Kept::of(12),
            views: Kept::of(16),
            experiences: Kept::of(64),
            pictures: Kept::of(600),
        })
    }

    /// The catalogue as it is now.
    pub fn catalog(&self) -> Result<Catalog, BrowseError> {
        Ok(Catalog::open_to_read(&self.root)?)
    }

    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    /// A page from its template.
    pub fn render(&self, template: &str, view: impl serde::Serialize) -> Result<Answer, BrowseError> {
        Ok(Answer::page(self.templates.render(template, &self.name, view)?))
    }

    /// The style sheet, its slots coloured by hour.
    pub fn style(&self, tones: Vec<crate::palette::Tone>) -> Result<Answer, BrowseError> {
        Ok(Answer::style(self.templates.style(tones)?))
    }

    /// A page that says what is wrong, and what to do.
    pub fn failure(&self, error: &BrowseError) -> Answer {
        let missing = error.is_not_here();
        let (status, title) = match missing {
            true => (StatusCode::NOT_FOUND, "Nothing here"),
            false => (StatusCode::INTERNAL_SERVER_ERROR, "This cannot be shown"),
        };
        let text = crate::wording::shown(&error.to_string());
        let view = serde_json::json!({ "title": title, "text": text, "missing": missing });
        match self.render("failure.html", view) {
            Ok(page) => page.with_status(status),
            Err(error) => Answer::text(status, error.to_string()),
        }
    }

    /// A pass that the catalogue knows, by its id as typed.
    pub fn pass(&self, catalog: &Catalog, typed: &str) -> Result<(TraversalId, TraversalRecord), BrowseError> {
        let unknown = || BrowseError::not_here("outing", typed);
        let id: TraversalId = typed.parse().map_err(|_| unknown())?;
        catalog.traversal_row(id)?.ok_or_else(unknown)?;
        Ok((id, catalog.traversal(id)?))
    }

    /// A pass by its record alone, as parts of a page ask for it: no index is opened.
    pub fn record(&self, typed: &str) -> Result<TraversalRecord, BrowseError> {
        let unknown = || BrowseError::not_here("outing", typed);
        let id: ObjectId = typed.parse().map_err(|_| unknown())?;
        if !self.objects.contains(id) {
            return Err(unknown());
        }
        Ok(furrow_catalog::records::read(&self.objects, id)?)
    }

    /// An experience, by its id as typed. A matrix' own keyframes make versions that the index need not know.
    pub fn experience(&self, typed: &str) -> Result<(ExperienceId, Arc<furrow_model::Experience>), BrowseError> {
        let unknown = || BrowseError::not_here("experience", typed);
        let id: ExperienceId = typed.parse().map_err(|_| unknown())?;
        // What the index knows and the disk has lost is named by what reads it.
        if !self.objects.contains(ObjectId(id.0)) && self.catalog()?.experience_row(id)?.is_none() {
            return Err(unknown());
        }
        let read = || furrow_catalog::records::read(&self.objects, ObjectId(id.0));
        Ok((id, self.experiences.or_made(id, read)?))
    }

    /// A pass' frames.
    pub fn frames(&self, record: &TraversalRecord) -> Result<Arc<Vec<Frame>>, BrowseError> {
        let read = || Ok(tables::frames_from_parquet(self.objects.read(record.frames)?)?);
        self.frames.or_made(record.frames, read)
    }

    /// A pass' chain, or an experience's.
    pub fn chain(&self, chain: ObjectId) -> Result<Arc<Trajectory>, BrowseError> {
        self.chains.or_made(chain, || Ok(tables::chain_from_parquet(self.objects.read(chain)?)?))
    }

    /// What rectifies the images of a calibration.
    pub fn views(&self, calibration: ObjectId) -> Result<Arc<Views>, BrowseError> {
        self.views.or_made(calibration, || Ok(Views::load(&self.objects, calibration)?))
    }
}
