//! The table of events, frame by frame.

use crate::RunError;
use crate::inputs::table::strings;
use furrow_catalog::{CatalogError, Objects, tables};
use furrow_model::outcome::event;
use furrow_model::{ExperienceId, ObjectId, Outcome};
use polars::prelude::DataFrame;
use std::str::FromStr;

/// What one experience's candidate came to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    /// Which of the outcome's members, from 0.
    pub member: usize,
    pub rank: u32,
    /// Stamp and left image; none for a new place.
    pub node: Option<(i64, ObjectId)>,
    pub log_likelihood: f64,
    pub new_place_log_likelihood: f64,
    pub posterior: f64,
    pub matches: Option<u32>,
    pub inliers: Option<u32>,
    pub decision: String,
    pub error_m: Option<f64>,
    pub correct: Option<bool>,
}

/// All answers to one live frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Answers {
    pub stamp_ns: i64,
    pub places: Vec<Place>,
}

impl Answers {
    /// The localisation, else the verified place with most inliers.
    pub fn best(&self) -> Option<&Place> {
        let verified = || self.places.iter().filter(|place| place.inliers.is_some());
        // Of equals the last is kept: the first, from behind.
        let most = verified().rev().max_by_key(|place| place.inliers);
        self.accepted().or(most)
    }

    /// The localisation.
    pub fn accepted(&self) -> Option<&Place> {
        self.places.iter().find(|place| place.decision == event::ACCEPTED)
    }

    /// What became of the frame, in the words of the table.
    pub fn decision(&self) -> &str {
        let unseen = self.places.first().map_or("no answer", |place| &place.decision);
        self.best().map_or(unseen, |place| &place.decision)
    }
}

/// The answers of an outcome, in the order of its table.
pub(super) fn read(objects: &Objects, outcome: &Outcome) -> Result<Vec<Answers>, RunError> {
    let table = tables::from_parquet("events", objects.read(outcome.events)?)?;
    let stamps = tables::i64s(&table, event::LIVE_STAMP_NS)?;
    let members = members(&table, outcome)?;
    let ranks = tables::u32s(&table, event::RANK)?;
    let nodes = nodes(&table)?;
    let likelihoods = tables::f64s(&table, event::LOG_LIKELIHOOD)?;
    let new_places = tables::f64s(&table, event::NEW_PLACE_LOG_LIKELIHOOD)?;
    let posteriors = tables::f64s(&table, event::POSTERIOR)?;
    let matches = tables::optional_u32s(&table, event::MATCHES)?;
    let inliers = tables::optional_u32s(&table, event::INLIERS)?;
    let decisions = strings(&table, event::DECISION)?;
    let errors = tables::optional_f64s(&table, event::ERROR_M)?;
    let wrong = CatalogError::table(event::CORRECT);
    let correct: Vec<Option<bool>> =
        table.column(event::CORRECT).and_then(|column| column.bool()).map_err(wrong)?.iter().collect();
    let mut answers: Vec<Answers> = Vec::new();
    for (row, decision) in decisions.into_iter().enumerate() {
        let place = Place {
            member: members[row],
            rank: ranks[row],
            node: nodes[row],
            log_likelihood: likelihoods[row],
            new_place_log_likelihood: new_places[row],
            posterior: posteriors[row],
            matches: matches[row],
            inliers: inliers[row],
            decision,
            error_m: errors[row],
            correct: correct[row],
        };
        match answers.last_mut().filter(|last| last.stamp_ns == stamps[row]) {
            Some(last) => last.places.push(place),
            None => answers.push(Answers { stamp_ns: stamps[row], places: vec![place] }),
        }
    }
    Ok(answers)
}

fn members(table: &DataFrame, outcome: &Outcome) -> Result<Vec<usize>, RunError> {
    let number = |text: &String| {
        let id = ExperienceId::from_str(text).ok();
        let found = outcome.members.iter().position(|member| Some(member.id) == id);
        found.ok_or_else(|| damaged(event::EXPERIENCE, format!("'{text}' is none of the outcome's experiences")))
    };
    strings(table, event::EXPERIENCE)?.iter().map(number).collect()
}

fn nodes(table: &DataFrame) -> Result<Vec<Option<(i64, ObjectId)>>, RunError> {
    let of = |name: &'static str| table.column(name).map_err(CatalogError::table(name));
    let stamps = of(event::NODE_STAMP_NS)?.i64().map_err(CatalogError::table(event::NODE_STAMP_NS))?;
    let images = of(event::NODE_IMAGE)?.str().map_err(CatalogError::table(event::NODE_IMAGE))?;
    let node = |(stamp, image): (Option<i64>, Option<&str>)| {
        let (Some(stamp), Some(image)) = (stamp, image) else { return Ok(None) };
        let image = image.parse().map_err(|_| damaged(event::NODE_IMAGE, format!("'{image}' is no image's id")))?;
        Ok(Some((stamp, image)))
    };
    stamps.iter().zip(images.iter()).map(node).collect()
}

fn damaged(what: &str, reason: String) -> RunError {
    RunError::Catalog(CatalogError::Table { what: what.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(inliers: Option<u32>, decision: &str) -> Place {
        Place {
            member: 0,
            rank: 0,
            node: None,
            log_likelihood: 0.0,
            new_place_log_likelihood: 0.0,
            posterior: 0.0,
            matches: inliers,
            inliers,
            decision: decision.to_owned(),
            error_m: None,
            correct: None,
        }
    }

    #[test]
    fn the_localisation_is_shown_else_the_first_with_most_inliers() {
        let of = |places: &[Place]| Answers { stamp_ns: 0, places: places.to_vec() };
        let (few, many) = (place(Some(7), event::REJECTED), place(Some(9), event::REJECTED));
        let (won, unseen) = (place(Some(8), event::ACCEPTED), place(None, event::NOT_VERIFIED));
        assert_eq!(of(&[many.clone(), won.clone()]).best(), Some(&won));
        let other = Place { rank: 1, ..many.clone() };
        assert_eq!(of(&[few, many.clone(), other]).best(), Some(&many));
        assert_eq!((of(std::slice::from_ref(&unseen)).best(), of(&[unseen]).decision()), (None, event::NOT_VERIFIED));
        assert_eq!(of(&[]).decision(), "no answer");
    }
}
