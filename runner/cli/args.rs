//! The command line, as a user types it.

use crate::commands::{
    attach_truth, browse, claims, collect, compare, compare_trajectory, completions, explain, export, features, fsck,
    generate, generator, import, ingest, init, live, ls, man, plan, report, reproduce, run, simulate, site, status,
    worker,
};
use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Field recordings to versioned experiences, and declared experiments on them.
///
/// A store holds everything. It is the folder given by --store, else by FURROW_STORE, else the nearest store in the
/// current folder or above it.
#[derive(Debug, Parser)]
#[command(name = "furrow", version, propagate_version = true, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 finished with faults, data loss or cells that \
could not run.\n\n\
Example:\n  \
furrow init field\n  \
furrow ingest morning.bag --store field --site old-zoo --route main --slot 08:00 --purpose experience\n  \
furrow run matrix.toml --store field\n  \
furrow report latest --store field -o report.html")]
pub struct Args {
    /// The store's folder.
    #[arg(long, global = true, env = "FURROW_STORE", value_name = "DIR", display_order = 900)]
    pub store: Option<PathBuf>,
    /// Print one JSON document on stdout and nothing else there.
    #[arg(long, global = true, display_order = 901)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// A command.
#[derive(Debug, Subcommand)]
pub enum Command {
    Init(init::Init),
    Ingest(ingest::Ingest),
    Import(import::Import),
    AttachTruth(attach_truth::AttachTruth),
    #[command(subcommand)]
    Site(site::Site),
    Ls(ls::Ls),
    #[command(subcommand)]
    Export(export::Export),
    CompareTrajectory(compare_trajectory::CompareTrajectory),
    Features(features::Features),
    #[command(subcommand)]
    Generator(generator::Generator),
    Generate(generate::Generate),
    Plan(plan::PlanMatrix),
    Run(run::RunMatrix),
    Collect(collect::Collect),
    Worker(worker::Worker),
    Live(live::Live),
    Status(status::Status),
    Reproduce(reproduce::Reproduce),
    Compare(compare::Compare),
    Report(report::Report),
    Browse(browse::Browse),
    Explain(explain::Explain),
    Claims(claims::Claims),
    Fsck(fsck::Fsck),
    Simulate(simulate::Simulate),
    Completions(completions::Completions),
    Man(man::Man),
}
