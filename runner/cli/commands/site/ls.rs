use super::offset::offset_text;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_runner::inputs::zone::SiteClock;
use serde_json::json;
use std::collections::BTreeMap;

/// List the sites, and how far their clocks are ahead of UTC: as given, as estimated from satellite fixes, or unknown.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow site ls\n  furrow site ls --json")]
pub struct ListSites {}

impl ListSites {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let mut sites: BTreeMap<String, (u32, SiteClock)> = BTreeMap::new();
        for row in catalog.traversals()? {
            let (count, clock) = sites.entry(row.site).or_insert((0, SiteClock::Unknown));
            *count += 1;
            if *clock == SiteClock::Unknown {
                *clock = SiteClock::of(&catalog, &catalog.traversal(row.id)?)?;
            }
        }
        if context.json {
            let list = sites.iter().map(|(site, (traversals, clock))| {
                let (minutes, source) = of_clock(*clock);
                json!({
                    "site": site, "traversals": traversals, "utc_offset_min": minutes, "utc_offset": source,
                })
            });
            print_json(&json!({ "sites": list.collect::<Vec<_>>() }))?;
            return Ok(Ending::Done);
        }
        let mut text = format!("{:<14} {:>10}  clocks ahead of UTC\n", "site", "traversals");
        for (site, (traversals, clock)) in &sites {
            let (minutes, source) = of_clock(*clock);
            let ahead = minutes.map_or(String::new(), |minutes| offset_text(minutes) + ", ");
            text += &format!("{:<14} {traversals:>10}  {ahead}{source}\n", furrow_model::shown(site));
        }
        print(&text)?;
        Ok(Ending::Done)
    }
}

/// Minutes ahead of UTC and where they are from.
fn of_clock(clock: SiteClock) -> (Option<i32>, &'static str) {
    match clock {
        SiteClock::Given(minutes) => (Some(minutes), "given"),
        SiteClock::Estimated(minutes) => (Some(minutes), "estimated from satellite fixes"),
        SiteClock::Unknown => (None, "unknown"),
    }
}
