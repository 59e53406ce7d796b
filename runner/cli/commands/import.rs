use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::ingesting::{IngestOptions, ingest_and_print};
use crate::output::{print, print_json};
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use furrow_ingest::import::builtin::{BUILTIN, parse_profile};
use furrow_ingest::import::find_profile;
use furrow_ingest::traversal::request_of_dataset;
use std::path::PathBuf;

/// Ingest a dataset of others, laid out as a profile tells.
///
/// A profile is a file that tells where images, stamps, calibration and true poses lie and how they are written; the
/// rest is `furrow ingest`: the same checks, the same options, the same store. --list names those that are built in,
/// --show prints one to start your own from.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
furrow import --list\n  \
furrow import euroc MH_01_easy/mav0 --site hall --route loop --slot 10:00 --purpose experience\n  \
furrow import kitti-raw 2011_09_26/2011_09_26_drive_0001_sync --site karlsruhe --route street --slot 13:00 --purpose evaluation\n  \
furrow import mono autumn/ --site park --route loop --slot 12:00 --purpose experience --spacing-m 5\n  \
furrow import --show euroc > mine.toml && furrow import ./mine.toml DATA --site hall --route loop --slot 10:00 --purpose experience")]
pub struct Import {
    /// A built-in profile, or a file ending in .toml.
    #[arg(required_unless_present_any = ["list", "show"], value_name = "PROFILE")]
    profile: Option<String>,
    /// The dataset: the folder of one sequence, or a bag.
    #[arg(required_unless_present_any = ["list", "show"], value_name = "PATH")]
    path: Option<PathBuf>,
    /// List the built-in profiles.
    #[arg(long, conflicts_with_all = ["profile", "path", "show"])]
    list: bool,
    /// Print a built-in profile.
    #[arg(long, conflicts_with_all = ["profile", "path"], value_name = "PROFILE")]
    show: Option<String>,
    #[command(flatten)]
    wanted: Wanted,
}

impl Import {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if self.list {
            return list(context);
        }
        if let Some(name) = &self.show {
            return print(&find_profile(name)?.1).map(|()| Ending::Done);
        }
        let (Some(name), Some(path), Some(options)) = (self.profile, self.path, self.wanted.0) else {
            return Err(Failure::usage("name a profile and a path: `furrow import --list` tells the profiles"));
        };
        options.check()?;
        let (profile, _) = find_profile(&name)?;
        let catalog = context.catalog()?;
        let scratch = tempfile::tempdir()
            .map_err(|error| Failure::new(format!("cannot make a temporary folder: {error}; is TMPDIR full?")))?;
        let asked = options.request(Vec::new());
        let request = request_of_dataset(&name, &profile, &path, asked, scratch.path())?;
        ingest_and_print(&catalog, &request, context)
    }
}

fn list(context: &Context) -> Result<Ending, Failure> {
    let mut profiles = Vec::new();
    for builtin in BUILTIN {
        profiles.push((builtin.name, parse_profile(builtin.name, builtin.text)?));
    }
    if context.json {
        let entry = |(name, profile): &(&str, _)| {
            let furrow_ingest::import::Profile { title, documentation, unconfirmed, .. } = profile;
            serde_json::json!({
                "profile": name, "title": title, "documentation": documentation, "unconfirmed": unconfirmed,
            })
        };
        print_json(&profiles.iter().map(entry).collect::<Vec<_>>())?;
    } else {
        let lines = profiles.iter().map(|(name, profile)| format!("{name:15} {}\n", profile.title));
        print(&lines.collect::<String>())?;
    }
    Ok(Ending::Done)
}

/// The options of an ingest, none of which is needed to list or show profiles.
#[derive(Debug)]
struct Wanted(Option<IngestOptions>);

impl Wanted {
    const REQUIRED: [&str; 4] = ["site", "route", "slot", "purpose"];

    fn lift(command: Command) -> Command {
        let lifted = |arg: Arg| arg.required(false).required_unless_present_any(["list", "show"]);
        Self::REQUIRED.into_iter().fold(command, |command, name| command.mut_arg(name, lifted))
    }
}

impl FromArgMatches for Wanted {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let is_whole = Self::REQUIRED.iter().all(|name| matches.contains_id(name));
        is_whole.then(|| IngestOptions::from_arg_matches(matches)).transpose().map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Wanted {
    fn augment_args(command: Command) -> Command {
        Self::lift(IngestOptions::augment_args(command))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::lift(IngestOptions::augment_args_for_update(command))
    }
}
