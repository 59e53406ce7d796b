use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_model::metric::{CURVES, METRICS, Metric, RIGHT};
use serde_json::{Value, json};
use std::fmt::Write;

/// Say what a number of a cell means, in the words of the page; without a name, all of them.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow explain percent_of_frames\n  furrow explain right\n  furrow explain")]
pub struct Explain {
    /// Its name in `--json`, or the heading of its column; `right` says when a place is right.
    #[arg(value_name = "METRIC")]
    name: Option<String>,
}

impl Explain {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let all = METRICS.iter().chain(&CURVES);
        let found: Vec<&Metric> = match &self.name {
            Some(name) => all.filter(|metric| metric.name == name || metric.heading == name).collect(),
            None => all.collect(),
        };
        let right = self.name.as_deref().is_none_or(|name| name == "right" || name == "wrong");
        if found.is_empty() && !right {
            let known: Vec<&str> = METRICS.iter().chain(&CURVES).map(|metric| metric.name).collect();
            let name = self.name.unwrap_or_default();
            return Err(Failure::new(format!("no number is called '{name}': there are {}", known.join(", "))));
        }
        if context.json {
            let metric =
                |metric: &&Metric| json!({ "name": metric.name, "heading": metric.heading, "meaning": metric.meaning });
            let metrics: Vec<Value> = found.iter().map(metric).collect();
            print_json(&json!({ "metrics": metrics, "right": RIGHT }))?;
        } else {
            let mut text = String::new();
            for metric in found {
                let _ = writeln!(text, "{} ({}): {}", metric.name, metric.heading, metric.meaning);
            }
            if right {
                let _ = writeln!(text, "{RIGHT}");
            }
            print(&text)?;
        }
        Ok(Ending::Done)
    }
}
