//! What the promises stand on: the command, stores, recordings, matrix files, a browser, a cluster. It judges nothing
//! itself, and uses no promise. The benchmarks and other crates' golden tests include single files of it with
//! `#[path]`.

pub mod browser;
pub mod command;
pub mod events;
pub mod field_views;
pub mod golden_data;
pub mod http;
pub mod kill;
#[allow(dead_code, reason = "the benchmark uses the rest")]
pub mod likeness;
pub mod matrix;
pub mod peak_memory;
pub mod python;
pub mod recordings;
pub mod repeated;
pub mod slurm;
pub mod store;
