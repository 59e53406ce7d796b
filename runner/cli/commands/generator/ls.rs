use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::views::generators::{generator_json, generator_line};
use furrow_runner::generation::named_examples;
use serde_json::{Value, json};

/// List the generators of the store.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow generator ls\n  furrow generator ls --json")]
pub struct ListGenerators {}

impl ListGenerators {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let all = catalog.generators()?.into_iter().map(|row| Ok((row.id, catalog.generator(row.id)?)));
        let all = all.collect::<Result<Vec<_>, Failure>>()?;
        if context.json {
            let all: Vec<Value> = all.iter().map(|(id, record)| generator_json(*id, record)).collect();
            print_json(&json!({ "generators": all }))?;
        } else if all.is_empty() {
            let untrained = named_examples("and");
            print(&format!("none yet: `furrow generator train` makes one; {untrained} need no training\n"))?;
        } else {
            print(&all.iter().map(|(id, record)| generator_line(*id, record)).collect::<String>())?;
        }
        Ok(Ending::Done)
    }
}
