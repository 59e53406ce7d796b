//! What was decided about a live frame, in furrow's own message types, for plots and tables: every field is a series.

use super::answers::{Answers, Place as Answered};
use super::message::stamp;
use super::scene::Scene;
use crate::RunError;
use foxglove::Encode;
use foxglove::messages::log::Level;
use foxglove::messages::{Log, Timestamp};
use furrow_model::outcome::event;

/// A live frame's fate. Fields of a place are those of the localisation, else of the verified place with most inliers.
#[derive(Encode)]
pub(super) struct Localisation {
    timestamp: Timestamp,
    decision: String,
    lost: bool,
    /// Metres driven since the last localisation; 0 where this is one.
    lost_m: f64,
    travelled_m: f64,
    threshold_inliers: u32,
    inliers: Option<u32>,
    matches: Option<u32>,
    /// Number of the experience, from 1; the file's metadata name it.
    experience: Option<u32>,
    node_stamp: Option<Timestamp>,
    log_likelihood: Option<f64>,
    posterior: Option<f64>,
    error_m: Option<f64>,
    correct: Option<bool>,
    /// Every row that the table of events has for this frame.
    places: Vec<Place>,
}

#[derive(Encode)]
struct Place {
    experience: u32,
    rank: u32,
    decision: String,
    new_place: bool,
    node_stamp: Option<Timestamp>,
    log_likelihood: f64,
    new_place_log_likelihood: f64,
    posterior: f64,
    matches: Option<u32>,
    inliers: Option<u32>,
    error_m: Option<f64>,
    correct: Option<bool>,
}

/// The fate of a frame; `lost_m` metres were driven since the last localisation.
pub(super) fn localisation(scene: &Scene, frame: usize, lost_m: f64) -> Result<Localisation, RunError> {
    let (answers, best) = (&scene.answers[frame], scene.answers[frame].best());
    let node_stamp = |place: &Answered| place.node.map(|(stamp_ns, _)| stamp(stamp_ns)).transpose();
    let number = |place: &Answered| scene.members[place.member].number;
    let place = |place: &Answered| {
        Ok(Place {
            experience: number(place),
            rank: place.rank,
            decision: place.decision.clone(),
            new_place: place.node.is_none(),
            node_stamp: node_stamp(place)?,
            log_likelihood: place.log_likelihood,
            new_place_log_likelihood: place.new_place_log_likelihood,
            posterior: place.posterior,
            matches: place.matches,
            inliers: place.inliers,
            error_m: place.error_m,
            correct: place.correct,
        })
    };
    Ok(Localisation {
        timestamp: stamp(answers.stamp_ns)?,
        decision: answers.decision().to_owned(),
        lost: answers.accepted().is_none(),
        lost_m,
        travelled_m: scene.poses[frame].travelled_m,
        threshold_inliers: scene.threshold,
        inliers: best.and_then(|place| place.inliers),
        matches: best.and_then(|place| place.matches),
        experience: best.map(number),
        node_stamp: best.map(node_stamp).transpose()?.flatten(),
        log_likelihood: best.map(|place| place.log_likelihood),
        posterior: best.map(|place| place.posterior),
        error_m: best.and_then(|place| place.error_m),
        correct: best.and_then(|place| place.correct),
        places: answers.places.iter().map(place).collect::<Result<_, RunError>>()?,
    })
}

/// The decision as a line of text: information where the frame was localised, a warning where not, an error where
/// wrongly.
pub(super) fn log(scene: &Scene, frame: usize) -> Result<Log, RunError> {
    let answers = &scene.answers[frame];
    let level = match answers.accepted().map(|place| place.correct) {
        Some(Some(false)) => Level::Error,
        Some(_) => Level::Info,
        None => Level::Warning,
    };
    Ok(Log {
        timestamp: Some(stamp(answers.stamp_ns)?),
        level: level as i32,
        message: describe_answers(scene, answers),
        name: "furrow".to_owned(),
        ..Log::default()
    })
}

/// `accepted: 10:00, 63 inliers of 40 needed, 0.8 m off, the right place`.
pub(super) fn describe_answers(scene: &Scene, answers: &Answers) -> String {
    let Some(best) = answers.best() else { return answers.decision().to_owned() };
    let label = &scene.members[best.member].label;
    let inliers = best.inliers.unwrap_or_default();
    let mut text = format!("{}: {label}, {inliers} inliers of {} needed", best.decision, scene.threshold);
    if let Some(error_m) = best.error_m {
        text += &format!(", {error_m:.1} m off");
    }
    text += match (best.correct, best.decision.as_str()) {
        (Some(true), _) => ", the right place",
        (Some(false), event::ACCEPTED) => ", but the wrong place",
        (Some(false), _) => ", the wrong place",
        (None, _) => "",
    };
    text
}
