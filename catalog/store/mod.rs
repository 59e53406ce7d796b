//! The catalogue: one store, opened; the one door to its objects and rows. What is entered is durable as a whole or not
//! at all. Nothing here knows SQL or how an image is decoded.
//!
//! - [`catalog`]: the store itself: made, opened, found; the folders in it;
//! - [`traversals`], [`experiences`], [`generators`], [`runs`]: what is entered and asked, by noun;
//! - [`sites`]: what is said of a site beside its traversals;
//! - [`worker`]: the store as a worker sees it, without its index.

pub mod catalog;
pub mod experiences;
pub mod generators;
pub mod runs;
pub mod sites;
pub mod traversals;
pub mod worker;
