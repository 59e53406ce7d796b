//! The store as pages see it: opened afresh for each page, never written to; what was read lately is kept in memory.

use super::cache::Cache;
use super::error::BrowseError;
use super::insight::Insight;
use super::reply::Reply;
use super::template::Templates;
use crate::chart::palette::Tone;
use crate::wording;
use axum::http::StatusCode;
use furrow_catalog::records::{self, TraversalRecord};
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects, Views};
use furrow_model::{Experience, ExperienceId, ObjectId, Trajectory, TraversalId};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What pages share.
pub(super) struct Store {
    root: PathBuf,
    name: String,
    objects: Objects,
    pub insight: Box<dyn Insight>,
    templates: Templates,
    frames: Cache<ObjectId, Vec<Frame>>,
    chains: Cache<ObjectId, Trajectory>,
    views: Cache<ObjectId, Views>,
    experiences: Cache<ExperienceId, Experience>,
    pub pictures: Cache<ViewKey, Vec<u8>>,
}

/// What tells one rectified view from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct ViewKey {
    pub image: ObjectId,
    pub calibration: ObjectId,
    /// Whether it is the right camera's.
    pub right: bool,
    /// In pixels.
    pub width: usize,
}

impl Store {
    pub fn open(root: &Path, insight: Box<dyn Insight>) -> Result<Self, BrowseError> {
        let catalog = Catalog::open_to_read(root)?;
        let name = root.canonicalize().ok().and_then(|root| Some(root.file_name()?.to_string_lossy().into_owned()));
        Ok(Self {
            root: root.to_owned(),
            name: wording::shown(&name.unwrap_or_default()),
            objects: catalog.objects().clone(),
            insight,
            templates: Templates::new()?,
            // An hour's frames are 5 MB and its chain 20; an image is at most some 150 kB.
            frames: Cache::new(64),
            chains: Cache::new(12),
            views: Cache::new(16),
            experiences: Cache::new(64),
            pictures: Cache::new(600),
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
    pub fn render(&self, template: &str, view: impl Serialize) -> Result<Reply, BrowseError> {
        Ok(Reply::page(self.templates.render(template, &self.name, view)?))
    }

    /// The style sheet, its slots coloured by hour.
    pub fn style(&self, tones: Vec<Tone>) -> Result<Reply, BrowseError> {
        Ok(Reply::style(self.templates.style(tones)?))
    }

    /// A page that says what is wrong, and what to do.
    pub fn failure(&self, error: &BrowseError) -> Reply {
        let missing = error.is_not_here();
        let (status, title) = match missing {
            true => (StatusCode::NOT_FOUND, "Not found"),
            false => (StatusCode::INTERNAL_SERVER_ERROR, "This page cannot be shown"),
        };
        let text = wording::shown(&error.to_string());
        let view = serde_json::json!({ "title": title, "text": text, "missing": missing });
        match self.render("failure.html", view) {
            Ok(page) => page.with_status(status),
            Err(error) => Reply::text(status, error.to_string()),
        }
    }

    /// A traversal that the catalogue knows, by its id as typed.
    pub fn traversal(&self, catalog: &Catalog, typed: &str) -> Result<(TraversalId, TraversalRecord), BrowseError> {
        let unknown = || BrowseError::not_here("traversal", typed);
        let id: TraversalId = typed.parse().map_err(|_| unknown())?;
        catalog.traversal_row(id)?.ok_or_else(unknown)?;
        Ok((id, catalog.traversal(id)?))
    }

    /// A traversal by its record alone, as parts of a page ask for it: no index is opened.
    pub fn record(&self, typed: &str) -> Result<TraversalRecord, BrowseError> {
        let unknown = || BrowseError::not_here("traversal", typed);
        let id: ObjectId = typed.parse().map_err(|_| unknown())?;
        if !self.objects.contains(id) {
            return Err(unknown());
        }
        Ok(records::read(&self.objects, id)?)
    }

    /// An experience, by its id as typed. A matrix' own keyframes make versions that the index need not know.
    pub fn experience(&self, typed: &str) -> Result<(ExperienceId, Arc<Experience>), BrowseError> {
        let unknown = || BrowseError::not_here("experience", typed);
        let id: ExperienceId = typed.parse().map_err(|_| unknown())?;
        // What the index knows and the disk has lost is named by what reads it.
        if !self.objects.contains(ObjectId(id.0)) && self.catalog()?.experience_row(id)?.is_none() {
            return Err(unknown());
        }
        Ok((id, self.experiences.get_or_make(id, || records::read(&self.objects, ObjectId(id.0)))?))
    }

    /// A traversal's frames.
    pub fn frames(&self, record: &TraversalRecord) -> Result<Arc<Vec<Frame>>, BrowseError> {
        let read = || Ok(tables::frames_from_parquet(self.objects.read(record.frames)?)?);
        self.frames.get_or_make(record.frames, read)
    }

    /// A traversal's chain, or an experience's.
    pub fn chain(&self, chain: ObjectId) -> Result<Arc<Trajectory>, BrowseError> {
        self.chains.get_or_make(chain, || Ok(tables::chain_from_parquet(self.objects.read(chain)?)?))
    }

    /// What rectifies the images of a calibration.
    pub fn views(&self, calibration: ObjectId) -> Result<Arc<Views>, BrowseError> {
        self.views.get_or_make(calibration, || Ok(Views::load(&self.objects, calibration)?))
    }
}
