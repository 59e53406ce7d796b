//! Where the nouns live. A tour, from the disk upwards:
//! - [`objects`]: immutable bytes named by their BLAKE3 digest, and pointers from a derivation's key to its result;
//! - [`images`]: stored images, and how they become rectified ones; the only home of OpenCV;
//! - [`tables`]: Parquet tables: chains, frames;
//! - [`records`]: every stored record, with its kind and format version;
//! - [`views`]: rectified views of stored images;
//! - [`index`]: SQLite rows that find the records by place, slot and purpose;
//! - [`store`]: the catalogue: a store, opened; the one door to all of these;
//! - [`fsck`]: whether everything is still what its name says.
//!
//! Only the submitting process opens the store's index; workers open the store detached from it
//! ([`Catalog::detached`]).

pub mod error;
pub mod fsck;
pub mod images;
pub mod index;
pub mod objects;
pub mod records;
pub mod store;
pub mod tables;
pub mod views;

pub use error::CatalogError;
pub use objects::{Objects, Staging, digest, digest_of, to_json, write_file, write_file_by};
pub use store::catalog::Catalog;
pub use views::{ViewError, Views};
