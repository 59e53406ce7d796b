//! Where the nouns live. A tour, from the disk upwards:
//! - [`objects`]: immutable bytes named by their BLAKE3 digest, and pointers from a derivation's key to its result;
//! - [`staging`]: the objects of one ingest, until they enter the store together;
//! - [`records`]: every stored record, with its kind and format version;
//! - [`views`]: rectified views of stored images;
//! - [`tables`]: Parquet tables: chains, frames;
//! - [`images`]: stored images, and how they become rectified ones; the only home of OpenCV;
//! - [`index`]: SQLite rows that find the records by place, slot and purpose;
//! - [`catalog`]: a store, opened: the one door to all of these;
//! - [`browsing`]: parts of the index for those who look around in it;
//! - [`fsck`]: whether everything is still what its name says.
//!
//! Only the submitting process opens the store's index; workers open the store detached from it ([`Catalog::detached`]).

pub mod browsing;
pub mod catalog;
pub mod error;
pub mod fsck;
pub mod images;
pub mod index;
pub mod objects;
pub mod records;
pub mod staging;
mod syncing;
pub mod tables;
pub mod views;

pub use catalog::Catalog;
pub use error::CatalogError;
pub use objects::{Objects, digest, digest_of, to_json, write_file, write_file_by};
pub use staging::Staging;
pub use views::{Cameras, ViewError, Views, ViewsRecord};
