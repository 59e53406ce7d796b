//! SURF: speeded-up robust features (Bay, Ess, Tuytelaars, Van Gool 2008), with the conventions of OpenCV's
//! implementation, so that keypoints and descriptors are the ones that the published localisers were measured with.
//!
//! A tour, in the order of the work:
//! - `integral`: sums over rectangles in four look-ups, regrouped by column phase for the coarser octaves, in
//!   `memory` used again;
//! - `response`: box filters of the second derivatives and the determinant of the Hessian, a row at a time;
//! - `detect`: maxima over place and size, band by band of the image: `peaks` of a row, refined by `newton`;
//! - `orientation`: the direction of a keypoint, with the angles of `arc_tangent`;
//! - `window`: the turned window around a keypoint (eight samples at a time in `window_avx2`),
//!   reduced by area to a `patch` of 21 x 21;
//! - `descriptor`: 64 sums of gradients;
//! - `features`: all of that in one call, [`surf`]; `keypoint`: what it looks for and finds;
//! - `matching`: [`mutual_best`], the keypoints that two images have in common.
//!
//! Every number is `f32` or `f64` arithmetic in a fixed order without fused operations. The hot loops are compiled
//! twice from one source, for any x86-64 and for AVX2, except for `window_avx2`, which a test holds to the bits of
//! `window`. So every machine and any number of threads give the same bits.

mod arc_tangent;
mod descriptor;
mod detect;
mod features;
mod integral;
mod keypoint;
mod matching;
mod memory;
mod newton;
mod orientation;
mod patch;
mod peaks;
mod response;
mod window;
#[cfg(target_arch = "x86_64")]
mod window_avx2;

pub use features::{Features, describe, detect, surf};
pub use keypoint::{Descriptor, Keypoint, SurfParams};
pub use matching::{MatchParams, SurfMatch, mutual_best};
