//! The project's promises, one module each. They use the command as a user does, and judge it by independent means.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod appearance;
mod arrows;
mod browse;
mod browser;
mod cluster;
mod command;
mod contract;
mod evaluation;
mod exported;
mod exports;
mod generated;
mod hostile;
mod interrupted;
mod live;
mod matrices;
mod memory;
mod pages;
mod recognisers;
mod road;
mod simulated;
mod single_camera;
mod slurm;
mod translators;

#[path = "field_views.rs"]
mod field_views;
#[path = "golden_data.rs"]
mod golden_data;
#[path = "likeness.rs"]
#[allow(dead_code, reason = "the benchmark uses the rest")]
mod likeness;
