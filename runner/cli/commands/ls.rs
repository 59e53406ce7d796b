use crate::{Context, Ending, Failure, print, print_json};
use furrow_catalog::Catalog;
use furrow_model::{ExperienceKind, ObjectId};
use serde_json::json;
use std::collections::BTreeMap;

/// List every traversal and experience in the store; generated ones apart.
#[derive(Debug, clap::Args)]
pub struct Ls {}

impl Ls {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        if context.json {
            let listing = json!({ "traversals": traversals(&catalog)?, "experiences": experiences(&catalog)?, "recordings": catalog.recordings()?, "generators": catalog.generators()? });
            print_json(&listing)?;
        } else {
            print(&for_people(&catalog)?)?;
        }
        Ok(Ending::Done)
    }
}

fn traversals(catalog: &Catalog) -> Result<Vec<serde_json::Value>, Failure> {
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

fn experiences(catalog: &Catalog) -> Result<Vec<serde_json::Value>, Failure> {
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

fn for_people(catalog: &Catalog) -> Result<String, Failure> {
    let traversals = catalog.traversals()?;
    if traversals.is_empty() {
        return Ok("nothing yet: `furrow ingest FILE …` brings in a recording\n".to_owned());
    }
    let mut text = format!(
        "{:<13} {:<12} {:<14} {:<14} {:<6} {:>7} {:>9} {:>7}  {}\n",
        "traversal", "pass", "site", "route", "slot", "frames", "length", "failed", "experience"
    );
    for row in traversals {
        let record = catalog.traversal(row.id)?;
        let experience = row.experience.map(|id| super::short(ObjectId(id.0))).unwrap_or_default();
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
    Ok(text + &generated(catalog)?)
}

/// The generated experiences; empty where there are none.
fn generated(catalog: &Catalog) -> Result<String, Failure> {
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
