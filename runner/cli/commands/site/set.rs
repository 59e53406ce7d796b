use super::offset::{offset_text, parse_offset};
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use serde_json::json;

/// Say how far a site's clocks are ahead of UTC. It tells the day of its traversals, in `date = "…"` of a matrix and on
/// pages; no id depends on it.
///
/// Without a word, the day follows from the slots, and from satellite fixes where there are any: right between UTC-10
/// and UTC+13.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow site set row-7 --utc-offset +12:00\n  furrow site set ranch --utc-offset -03:30"
)]
pub struct SetSite {
    /// The site.
    site: String,
    /// Hours and minutes that its clocks are ahead of UTC; negative in the Americas.
    #[arg(long, value_name = "+HH:MM", value_parser = parse_offset, allow_hyphen_values = true)]
    utc_offset: i32,
}

impl SetSite {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if self.site.trim().is_empty() {
            return Err(Failure::usage("the site's name is empty"));
        }
        let catalog = context.catalog()?;
        catalog.set_utc_offset(&self.site, self.utc_offset)?;
        let traversals = catalog.traversals()?.iter().filter(|row| row.site == self.site).count();
        if context.json {
            let (site, minutes) = (self.site, self.utc_offset);
            print_json(&json!({ "site": site, "utc_offset_min": minutes, "traversals": traversals }))?;
        } else {
            let none = if traversals == 0 { "; it has no traversal yet" } else { "" };
            let (site, offset) = (furrow_model::shown(&self.site), offset_text(self.utc_offset));
            print(&format!("the clocks of site {site} are {offset} ahead of UTC{none}\n"))?;
        }
        Ok(Ending::Done)
    }
}
