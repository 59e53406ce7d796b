//! Localisation as it happens: the same step as a run's, frame by frame, and the control hub on the frames' stamps.
//!
//! - [`Localisers`]: experiences made ready; [`Localisers::look_at`] sees a pair once, [`Localisers::answer`] asks one
//!   experience about it;
//! - [`LiveHub`]: one thread per experience, each with a mailbox for one frame, and the hub that keeps the best fresh
//!   answer.
//!
//! Nothing here reads a clock: moments are stamps of frames. With all answers in before each decision
//! ([`LiveHub::settle`]) the hub decides as it does in lockstep.

mod hub;
mod localisers;
mod mailbox;

pub use hub::LiveHub;
pub use localisers::{Localisers, Seen};
