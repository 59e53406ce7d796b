//! The read-only catalogue browser: pages over a store, on loopback. It serves; it may not write to the store, nor know
//! the runner or the localiser: what must be computed it asks of [`Insight`], which the command hands in.
//!
//! A tour, from the socket inwards:
//! - `server`: [`Browser`]: listens on 127.0.0.1 and checks every request; `routes`: which address shows what;
//! - `store`, `cache`: the store as pages see it, opened afresh for each page; what was read lately is kept in memory;
//! - `start`, `site`, `traversal` (with `facts`), `experience`, `runs`, `run`, `kept`: a page each;
//! - `player`, `answers`: what the traversal's page asks for: positions, keypoints, matches, answers of a run;
//! - `family`, `nearest`: the same for an experience and its children;
//! - `places`, `coverage`, `slots`, `cards`: what there is by site and slot; `track`, `map`: where it was recorded;
//! - `pictures`: rectified views as JPEG;
//! - `reply`, `template`, `error`: what goes back.
//!
//! Invariants: no byte of the store changes; nothing is asked of another machine; only GET is answered, and only to who
//! asked for this very address; names are shown, never executed.

mod answers;
mod cache;
mod cards;
mod coverage;
mod error;
mod experience;
mod facts;
mod family;
pub mod insight;
mod kept;
mod map;
mod nearest;
mod pictures;
mod places;
mod player;
mod reply;
mod routes;
mod run;
mod runs;
mod server;
mod site;
mod slots;
mod start;
mod store;
mod template;
mod track;
mod traversal;

pub use error::BrowseError;
pub use insight::{Agreement, GateReading, Insight, TrueTrack, ViewPoint};
pub use server::Browser;
