//! Immutable objects named by the BLAKE3 digest of their bytes, and the small pointers from a derivation's key to its
//! result. Both are plain files, so that workers on any machine that sees the folder can read and add without the
//! index, which is unknown here, as is what the bytes mean.
//!
//! - `names`: digests of bytes and values; `files`: files written whole or not at all;
//! - `object_store`: objects and pointers;
//! - `staging`: the objects of one ingest, until they enter the store together; `syncing`: made durable meanwhile.

mod files;
mod names;
mod object_store;
mod staging;
mod syncing;

pub(crate) use files::sync_folder;
pub use files::{write_file, write_file_by};
pub use names::{digest, digest_of, to_json};
pub use object_store::Objects;
pub use staging::Staging;
