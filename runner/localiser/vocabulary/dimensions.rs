//! What words are made of.

/// Numbers in a descriptor.
pub const DIMENSIONS: usize = 64;

/// A SURF descriptor, usually of unit length.
pub use crate::surf::Descriptor;
