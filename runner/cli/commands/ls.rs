use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_catalog::Catalog;
use furrow_model::{ExperienceKind, ObjectId};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// List the traversals and experiences of the store; generated experiences in a table of their own.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow ls\n  furrow ls --json | jq '.traversals[] | select(.slot == \"08:00\")'")]
pub struct Ls {}

impl Ls {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        if context.json {
            print_json(&json!({
                "traversals": list_traversals(&catalog)?, "experiences": list_experiences(&catalog)?,
                "recordings": catalog.recordings()?, "generators": catalog.generators()?,
            }))?;
        } else {
            print(&(traversal_table(&catalog)? + &generated_table(&catalog)?))?;
        }
        Ok(Ending::Done)
    }
}

fn list_traversals(catalog: &Catalog) -> Result<Vec<Value>, Failure> {
    let mut list = Vec::new();
    for row in catalog.traversals()? {
        let record = catalog.traversal(row.id)?;
        let mut fields = json!(record);
        fields["traversal"] = json!(row.id);
        fields["pass"] = json!(record.purpose);
        list.push(fields);
    }
    Ok(list)
}

fn list_experiences(catalog: &Catalog) -> Result<Vec<Value>, Failure> {
    let mut list = Vec::new();
    for row in catalog.experiences()? {
        let record = catalog.experience(row.id)?;
        let mut fields = json!(record);
        fields["experience"] = json!(row.id);
        fields["nodes"] = json!(record.nodes.len());
        fields["generated"] = json!(record.kind != ExperienceKind::Recorded);
        list.push(fields);
    }
    Ok(list)
}

fn traversal_table(catalog: &Catalog) -> Result<String, Failure> {
    let traversals = catalog.traversals()?;
    if traversals.is_empty() {
        return Ok("nothing yet: `furrow ingest FILE …` brings in a recording\n".to_owned());
    }
    let mut text = format!(
        "{:<13} {:<12} {:<14} {:<14} {:<6} {:>7} {:>9} {:>7}  {}\n",
        "traversal", "purpose", "site", "route", "slot", "frames", "length", "failed", "experience"
    );
    for row in traversals {
        let record = catalog.traversal(row.id)?;
        let experience = row.experience.map_or_else(String::new, |id| id.short());
        text += &format!(
            "{:<13} {:<12} {:<14} {:<14} {:<6} {:>7} {:>7.1} m {:>7}  {experience}\n",
            row.id.short(),
            row.purpose.to_string(),
            row.site,
            row.route,
            row.slot.to_string(),
            record.counts.frames,
            record.counts.length_m,
            record.counts.failed_steps,
        );
    }
    Ok(text)
}

/// The generated experiences; empty if there are none.
fn generated_table(catalog: &Catalog) -> Result<String, Failure> {
    let names: BTreeMap<ObjectId, String> = catalog.generators()?.into_iter().map(|row| (row.id, row.name)).collect();
    let mut text = String::new();
    for row in catalog.experiences()?.into_iter().filter(|row| !row.recorded) {
        if let ExperienceKind::Generated { parent, generator, domainness, mimics } = catalog.experience(row.id)?.kind {
            let name = names.get(&generator).cloned().unwrap_or_else(|| generator.short());
            text += &format!(
                "{:<13} {:<14} {:<14} {:<6} {:<13} {:>6}  {name}\n",
                row.id.short(),
                row.site,
                row.route,
                mimics.to_string(),
                parent.short(),
                domainness.0
            );
        }
    }
    if !text.is_empty() {
        let titles = ("generated", "site", "route", "mimics", "parent", "z");
        text = format!(
            "\n{:<13} {:<14} {:<14} {:<6} {:<13} {:>6}  generator\n{text}",
            titles.0, titles.1, titles.2, titles.3, titles.4, titles.5
        );
    }
    Ok(text)
}
