//! What several commands print of cells, contrasts and generators, for people and as JSON.
//! No command and no argument is known here.

pub mod cells;
pub mod contrasts;
pub mod generators;
pub mod listing;
