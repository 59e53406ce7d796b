//! Generated experiences, pixel by pixel: a left image of one time of day becomes one that mimics another. No file,
//! socket or clock is touched here, and equal input gives equal bytes on any number of threads.
//!
//! A tour, in the order of the work:
//! - [`colour`]: log-opponent colours, in which a change of light is a shift;
//! - [`bands`]: what an image holds at four scales, and the base below them;
//! - [`cells`]: the 8 x 5 parts of the image, each with colours of its own;
//! - [`moments`]: training: means and covariances of every cell, one image at a time;
//! - [`transport`]: the optimal transport between two Gaussians, and any part of the way;
//! - [`otf`]: optimal-transport flow: what training gives ([`Otf`]);
//! - `flow`: its application to an image;
//! - [`sensor`], [`shadow`], [`relight`]: optional stages: the camera's noise, the contrast of cast shadows, surfaces
//!   under another sun;
//! - [`stereo`]: the disparities that relighting rests on;
//! - [`invariant`]: the image that no light changes;
//! - [`placebo`]: changes that know nothing of any hour, so that luck among many can be told from skill;
//! - [`generator`]: all of these behind one name; [`kinds`]: the registry of them, where a new one has its line;
//! - [`quality`]: measures of generated images, and the verdict on a generator.
//!
//! *Domainness* z is how far an image travels from its own domain: 0 not at all, 1 to the target's, beyond that
//! extrapolation.

pub mod bands;
pub mod cells;
mod chance;
pub mod colour;
mod error;
mod flow;
pub mod generator;
pub mod invariant;
pub mod kinds;
mod lanes;
pub mod moments;
pub mod otf;
pub mod placebo;
mod placebo_set;
mod planes;
pub mod quality;
pub mod relight;
pub mod sensor;
pub mod shadow;
pub mod stereo;
pub mod transport;

pub use error::GenerateError;
pub use generator::{Generator, Seed};
pub use moments::Moments;
pub use otf::{Otf, Strengths};
pub use placebo_set::placebo_set;
pub use planes::Workspace;
pub use relight::{Shading, Suns};

/// The version of everything that determines a generated image; it changes whenever a result does.
pub const ALGORITHM: &str = "generator/2";
/// The least and the greatest domainness that is allowed.
pub const DOMAINNESS: [f64; 2] = [-0.5, 2.0];
