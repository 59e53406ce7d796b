use crate::ending::{Ending, Failure};
use crate::output::print;
use clap_mangen::Man as Page;
use furrow_catalog::write_file;
use std::path::{Path, PathBuf};

/// Print the manual page of furrow, or of one of its commands.
///
/// Pages are written for man: `man -l` shows one from a file.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow man | man -l -\n  furrow man ingest | man -l -\n  \
furrow man export trajectory > furrow-export-trajectory.1\n  furrow man --all ~/.local/share/man/man1")]
pub struct Man {
    /// The command. [default: furrow itself]
    command: Vec<String>,
    /// Write the pages of furrow and all its commands into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    all: Option<PathBuf>,
}

impl Man {
    pub fn run(self, furrow: clap::Command) -> Result<Ending, Failure> {
        let mut furrow = furrow.disable_help_subcommand(true);
        furrow.build();
        match &self.all {
            Some(folder) => {
                std::fs::create_dir_all(folder)
                    .map_err(|error| Failure::new(format!("cannot create {}: {error}", folder.display())))?;
                write_pages(&furrow, folder)?;
            }
            None => print(&String::from_utf8_lossy(&render(find_command(&furrow, &self.command)?)?))?,
        }
        Ok(Ending::Done)
    }
}

/// Finds the command that the words name.
fn find_command<'a>(furrow: &'a clap::Command, words: &[String]) -> Result<&'a clap::Command, Failure> {
    words.iter().try_fold(furrow, |command, word| {
        command.find_subcommand(word).ok_or_else(|| {
            let names = command.get_subcommands().filter(|sub| !sub.is_hide_set()).map(|sub| sub.get_name());
            let hint = furrow_runner::suggest::nearest(word, names);
            let whole = command.get_bin_name().unwrap_or_else(|| command.get_name());
            Failure::usage(format!("'{whole}' has no command '{word}'{hint}"))
        })
    })
}

/// Makes a command's page.
fn render(command: &clap::Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    Page::new(command.clone()).render(&mut page).map_err(|error| Failure::new(format!("manual page: {error}")))?;
    Ok(page)
}

/// Writes the pages of a command and of those below it.
fn write_pages(command: &clap::Command, folder: &Path) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    write_file(&folder.join(format!("{name}.1")), &render(command)?)?;
    command.get_subcommands().filter(|sub| !sub.is_hide_set()).try_for_each(|sub| write_pages(sub, folder))
}
