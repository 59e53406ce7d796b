//! The project's promises, one module each. They use the command as a user does, and judge it by independent means.
//! What they stand on is in `support`; the simulated field is a crate of its own (`field`), the benchmarks are in
//! `bench`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod arrows;
mod browse;
mod browser;
mod damaged_files;
mod export;
mod field_appearance;
mod field_reports;
mod generation;
mod importing;
mod json_and_exit_codes;
mod kill_9;
mod known_recordings;
mod live;
mod matrix;
mod memory_bound;
mod real_recordings;
mod recognisers;
mod recount;
mod report;
mod simulated_site;
mod single_camera;
mod slurm;
mod support;
mod thesis_script;
