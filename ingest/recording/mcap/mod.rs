//! MCAP files (<https://mcap.dev/spec>). The data section is walked and decoded here, within bounds; the `mcap` crate
//! parses record bodies and reads the summary section. Nothing outside this folder knows the format.

mod decode;
mod file;
mod record;
mod summary;
mod walk;

pub(crate) use file::{MAGIC, Mcap};
