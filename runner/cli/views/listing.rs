//! The cells of a run or plan, listed.

use super::cells::{CellView, CellWithout, in_setting};
use crate::context::Context;
use crate::ending::Failure;
use crate::output::{print, print_json};
use furrow_model::RunId;
use furrow_runner::Study;
use serde_json::{Value, json};
use std::fmt::Write;

/// The cells of a run.
pub struct Listing<'a> {
    pub run: RunId,
    pub study: &'a Study,
    pub cells: &'a [CellView],
    pub failed: &'a [CellWithout<'a>],
}

impl Listing<'_> {
    /// Prints cells, what is blocked and what failed; `more` are further keys of the JSON document.
    pub fn print(&self, context: &Context, more: Vec<(&str, Value)>) -> Result<(), Failure> {
        let (blocked, warnings) = (blocked_cells(self.study), self.study.warnings());
        if context.json {
            let mut all = json!({ "run": self.run, "cells": self.cells, "blocked": blocked, "warnings": warnings });
            more.into_iter().for_each(|(key, value)| all[key] = value);
            return print_json(&all);
        }
        for warning in &warnings {
            eprintln!("warning: {warning}");
        }
        print(&self.text(&blocked))
    }

    fn text(&self, blocked: &[CellWithout<'_>]) -> String {
        let mut text = format!("run {} of '{}'\n", self.run.short(), self.study.matrix.name);
        let labels = self.cells.iter().map(|cell| in_setting(&cell.experience, &cell.setting));
        let others = blocked.iter().chain(self.failed).map(|cell| in_setting(cell.experience, cell.setting));
        let wide = labels.chain(others).map(|label| label.chars().count()).max().unwrap_or(0).max(22);
        let _ =
            writeln!(text, "live   {:<wide$} frames  good  % good  lost %  longest lost  correct  wrong", "experience");
        for cell in self.cells {
            let name = in_setting(&cell.experience, &cell.setting);
            let _ = writeln!(text, "{:<6} {name:<wide$} {}", cell.live.to_string(), numbers(cell));
        }
        for (cells, what) in [(blocked, "blocked"), (self.failed, "failed")] {
            for cell in cells {
                let name = in_setting(cell.experience, cell.setting);
                let _ = writeln!(text, "{:<6} {name:<wide$} {what}: {}", cell.live.to_string(), cell.reason);
            }
        }
        text
    }
}

fn blocked_cells(study: &Study) -> Vec<CellWithout<'_>> {
    let blocked = study.parts.iter().flat_map(|part| part.blocked.iter().map(move |cell| (part, cell)));
    blocked
        .map(|(part, cell)| CellWithout {
            live: cell.live,
            experience: &cell.experience,
            setting: &part.setting,
            reason: &cell.reason,
        })
        .collect()
}

/// The columns after a cell's name.
fn numbers(cell: &CellView) -> String {
    let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let cached = match (&cell.from, cell.cached) {
        (Some(from), true) => format!("  (finished in {from})"),
        (None, true) => "  (finished before)".to_owned(),
        (_, false) => String::new(),
    };
    format!(
        "{:>6} {:>5} {:>7} {:>7} {:>12} {:>8} {:>6}{cached}",
        or_dash(cell.frames.map(|n| n.to_string())),
        or_dash(cell.good.map(|n| n.to_string())),
        or_dash(cell.percent_good.map(|p| format!("{p:.1}"))),
        or_dash(cell.lost_fraction.map(|p| format!("{:.1}", 100.0 * p))),
        or_dash(cell.max_lost_m.map(|m| format!("{m:.1} m"))),
        or_dash(cell.correct.map(|n| n.to_string())),
        or_dash(cell.wrong.map(|n| n.to_string())),
    )
}
