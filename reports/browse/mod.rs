//! The read-only catalogue browser: pages over a store, on loopback. A tour, from the socket inwards:
//! - `server`: [`Browser`]: listens on 127.0.0.1, checks every request, knows the routes;
//! - `store`: the store as pages see it, opened afresh for each page and never written to; what was read lately is kept in memory;
//! - [`insight`]: what pages ask of the crates that compute; the command hands it in;
//! - `start`, `site`, `outing` (with `facts`), `experience`, `run`, `kept`: a page each;
//! - `player`: what the outing's page asks for while someone scrubs: positions, keypoints, matches, answers of a run;
//! - `family`: the same for an experience and its children;
//! - `cards`: outings in a word and a picture; `track`, `map`: where they went;
//! - `pictures`: rectified views as JPEG;
//! - `answer`, `template`, `error`: what goes back.
//!
//! Invariants: no byte of the store changes; nothing is asked of another machine; only GET is answered, and only to who asked for this
//! very address; names are shown, never executed.

mod answer;
mod cards;
mod error;
mod experience;
mod facts;
mod family;
pub mod insight;
mod kept;
mod map;
mod outing;
mod pictures;
mod player;
mod run;
mod server;
mod site;
mod start;
mod store;
mod template;
mod track;

pub use error::BrowseError;
pub use insight::{Agreement, GateReading, Insight, TrueTrack, ViewPoint};
pub use server::Browser;
