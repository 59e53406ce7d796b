//! The command `furrow`: the only home of argument parsing, stdout and exit codes.

mod args;
mod commands;
mod failure;
mod progress;

use args::{Args, Command};
use clap::{CommandFactory, Parser};
use failure::Failure;
use std::io::{self, Write};
use std::process::ExitCode;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// All was done.
    Done,
    /// Finished, with faults found or cells that could not run: exit code 3.
    WithFaults,
}

/// What every command is given.
#[derive(Debug)]
pub struct Context {
    /// The store's folder, where the user named one.
    pub store: Option<std::path::PathBuf>,
    /// Whether stdout is for a program.
    pub json: bool,
}

fn main() -> ExitCode {
    let args = Args::parse();
    match dispatch(args) {
        Ok(Ending::Done) => ExitCode::SUCCESS,
        Ok(Ending::WithFaults) => ExitCode::from(3),
        Err(failure) => {
            eprintln!("furrow: {failure}");
            ExitCode::from(failure.code())
        }
    }
}

fn dispatch(args: Args) -> Result<Ending, Failure> {
    let context = Context { store: args.store, json: args.json };
    match args.command {
        Command::Init(command) => command.run(&context),
        Command::Ingest(command) => command.run(&context),
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
        Command::Claims(command) => command.run(&context),
        Command::Fsck(command) => command.run(&context),
        Command::Simulate(command) => command.run(&context),
        Command::Completions { shell } => {
            clap_complete::generate(shell, &mut Args::command(), "furrow", &mut io::stdout());
            Ok(Ending::Done)
        }
        Command::Man => {
            clap_mangen::Man::new(Args::command()).render(&mut io::stdout()).map_err(Failure::stdout)?;
            Ok(Ending::Done)
        }
    }
}

/// Prints a text on stdout.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Failure::stdout)
}

/// Prints one JSON document on stdout.
pub fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text =
        serde_json::to_string_pretty(value).map_err(|error| Failure::new(format!("cannot write JSON: {error}")))?;
    print(&(text + "\n"))
}
