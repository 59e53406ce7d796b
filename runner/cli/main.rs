//! The command `furrow`: the only home of argument parsing, stdout and exit codes. A tour:
//! - `args`: the command line; `options`: arguments that several commands share;
//! - `commands`: one file or folder per command, its doc comment is the help text;
//! - `views`: what several commands print of cells, contrasts and generators;
//! - `ingesting`: options and summary of what brings a recording into the store;
//! - `context`, `output`, `progress`, `ending`: the store, stdout, the progress bar, exit codes;
//! - `choosing`: ids as a user types them.

mod args;
mod choosing;
mod commands;
mod context;
mod ending;
mod ingesting;
mod options;
mod output;
mod progress;
mod views;

use args::{Args, Command};
use clap::{CommandFactory, Parser};
use context::Context;
use ending::{Ending, Failure};
use std::process::ExitCode;

fn main() -> ExitCode {
    match dispatch(Args::parse()) {
        Ok(ending) => ending.code(),
        Err(failure) => {
            eprintln!("furrow: {failure}");
            failure.code()
        }
    }
}

fn dispatch(args: Args) -> Result<Ending, Failure> {
    let context = Context { store: args.store, json: args.json };
    match args.command {
        Command::Init(command) => command.run(&context),
        Command::Ingest(command) => command.run(&context),
        Command::Import(command) => command.run(&context),
        Command::AttachTruth(command) => command.run(&context),
        Command::Site(command) => command.run(&context),
        Command::Ls(command) => command.run(&context),
        Command::Export(command) => command.run(&context),
        Command::CompareTrajectory(command) => command.run(&context),
        Command::Features(command) => command.run(),
        Command::Generator(command) => command.run(&context),
        Command::Generate(command) => command.run(&context),
        Command::Plan(command) => command.run(&context),
        Command::Run(command) => command.run(&context),
        Command::Collect(command) => command.run(&context),
        Command::Worker(command) => command.run(&context),
        Command::Live(command) => command.run(&context),
        Command::Status(command) => command.run(&context),
        Command::Reproduce(command) => command.run(&context),
        Command::Compare(command) => command.run(&context),
        Command::Report(command) => command.run(&context),
        Command::Browse(command) => command.run(&context),
        Command::Explain(command) => command.run(&context),
        Command::Claims(command) => command.run(&context),
        Command::Fsck(command) => command.run(&context),
        Command::Simulate(command) => command.run(&context),
        Command::Completions(command) => command.run(Args::command()),
        Command::Man(command) => command.run(Args::command()),
    }
}
