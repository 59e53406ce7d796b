//! Many recordings of the simulated field, from one file.

use super::recording::{record_with_bar, summary_json, summary_line};
use crate::context::Context;
use crate::ending::Failure;
use crate::output::{print, print_json};
use furrow_field::Traversal;
use furrow_field::campaign::{Campaign, Planned};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Records what is missing of a campaign, and prints the commands that ingest all of its recordings.
pub fn record_campaign(file: &Path, context: &Context) -> Result<(), Failure> {
    let (campaign, folder) = read_campaign(file)?;
    let missing = campaign.missing(&folder);
    let here = campaign.traversals.len() - missing.len();
    if here > 0 {
        eprintln!("{here} of {} traversals are recorded already", campaign.traversals.len());
    }
    let mut summaries = Vec::new();
    for (done, planned) in missing.iter().enumerate() {
        let output = folder.join(&planned.file);
        let stage = format!("recording {} of {}: {}", done + 1, missing.len(), planned.file);
        let summary = record_with_bar(&planned.traversal, &output, &stage)?;
        eprintln!("{}", summary_line(&summary, &output));
        summaries.push(summary_json(&summary));
    }
    if context.json {
        let traversals: Vec<Value> = campaign.traversals.iter().map(|planned| planned_json(planned, &folder)).collect();
        return print_json(&json!({"recorded": summaries, "passes": traversals}));
    }
    eprintln!("to ingest them:");
    print(&campaign.traversals.iter().map(|planned| ingest_command(planned, &folder)).collect::<String>())
}

/// A campaign, and the folder of its recordings, which is created.
fn read_campaign(file: &Path) -> Result<(Campaign, PathBuf), Failure> {
    let text =
        fs::read_to_string(file).map_err(|error| Failure::new(format!("cannot read {}: {error}", file.display())))?;
    let campaign = Campaign::read(&text, file).map_err(|error| Failure::new(error.to_string()))?;
    let folder = file.parent().unwrap_or(Path::new("")).join(&campaign.folder);
    fs::create_dir_all(&folder)
        .map_err(|error| Failure::new(format!("cannot create {}: {error}", folder.display())))?;
    Ok((campaign, folder))
}

fn planned_json(planned: &Planned, folder: &Path) -> Value {
    json!({
        "file": folder.join(&planned.file), "purpose": planned.purpose, "site": planned.traversal.site.to_string(),
        "route": planned.traversal.route, "slot": planned.traversal.slot,
    })
}

/// The command that ingests a recording, quoted for a shell.
fn ingest_command(planned: &Planned, folder: &Path) -> String {
    let Traversal { site, route, slot, .. } = &planned.traversal;
    let file = folder.join(&planned.file).display().to_string();
    let [site, slot, purpose] = [site.to_string(), slot.to_string(), planned.purpose.to_string()];
    let words = ["furrow", "ingest", &file, "--site", &site, "--route", route, "--slot", &slot, "--purpose", &purpose];
    // No path or name has the character that cannot be quoted.
    shlex::try_join(words).unwrap_or_default() + "\n"
}
