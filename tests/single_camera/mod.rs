//! A single camera takes the same road: image folders with a given spacing or given poses, verified by two views.

mod answers;
mod places;
mod refused;
mod seasons;
