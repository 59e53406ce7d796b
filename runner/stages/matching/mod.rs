//! The matching stage: which nodes of an experience each live frame may show. Each place recogniser is a file here and
//! a line in `registry`; nothing outside of its file knows its name.

mod external;
mod fabmap;
mod registry;
mod sequences;
mod table;

pub(crate) use registry::open;
pub use registry::read_matrix;

#[cfg(test)]
mod toy;
