use super::offset_text;
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

/// Reads hours and minutes ahead of UTC, in minutes.
fn parse_offset(text: &str) -> Result<i32, String> {
    let wrong = || format!("'{text}' is no offset from UTC: expected +HH:MM between -12:00 and +14:00, as in +12:00");
    let (sign, digits) = match text.strip_prefix(['-', '−']) {
        Some(digits) => (-1, digits),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let (hours, minutes) = digits.split_once(':').unwrap_or((digits, "00"));
    let number = |part: &str, most: i32| {
        let is_short = matches!(part.len(), 1..=2) && part.bytes().all(|byte| byte.is_ascii_digit());
        is_short.then(|| part.parse::<i32>().ok()).flatten().filter(|number| *number <= most)
    };
    let minutes = number(hours, 14).zip(number(minutes, 59)).map(|(hours, minutes)| sign * (60 * hours + minutes));
    minutes.filter(|minutes| (-12 * 60..=14 * 60).contains(minutes)).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_read_as_people_write_them() {
        for (text, minutes) in
            [("+12:00", 720), ("12", 720), ("-3:30", -210), ("+00:00", 0), ("0", 0), ("+14:00", 840), ("-12:00", -720)]
        {
            assert_eq!(parse_offset(text), Ok(minutes), "{text}");
            assert_eq!(parse_offset(&offset_text(minutes)), Ok(minutes));
        }
        for text in ["", "+", "14:01", "-12:01", "1:60", "Pacific/Auckland", "+1:2:3", "+-1", "120", "1.5"] {
            assert!(parse_offset(text).is_err(), "{text}");
        }
    }
}
