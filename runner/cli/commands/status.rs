use super::chosen_run;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_runner::slurm::Tasks;
use serde_json::json;

/// Show the runs of the store and how many of their cells are finished.
#[derive(Debug, clap::Args)]
pub struct Status {
    /// One run: its id, the beginning of it, or `latest`. All where left out.
    run: Option<String>,
}

impl Status {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let wanted = self.run.map(|typed| chosen_run(&catalog, &typed)).transpose()?;
        let failures = catalog.failures()?;
        let mut listing = Vec::new();
        let mut text = String::new();
        for row in catalog.runs()?.into_iter().filter(|row| wanted.is_none_or(|id| id == row.id)) {
            let record = catalog.run(row.id)?;
            let mut finished = 0;
            let mut failed = Vec::new();
            for cell in &record.cells {
                finished += usize::from(catalog.outcome(cell.key)?.is_some());
                let failure = failures.iter().find(|failure| failure.cell == cell.key);
                failed.extend(failure.map(|failure| (cell, &failure.reason)));
            }
            let (cells, blocked) = (record.cells.len(), record.blocked.len());
            text += &format!(
                "{}  {:<30} {finished} of {cells} cells finished, {blocked} blocked\n",
                row.id.short(),
                record.name
            );
            let tasks = furrow_runner::slurm::tasks(&catalog, row.id);
            if let Some(Tasks { round, all, done, failed }) = tasks {
                text +=
                    &format!("{:14}on the cluster, round {round}: {done} of {all} tasks done, {failed} failed\n", "");
            }
            for (cell, reason) in &failed {
                text += &format!("{:14}failed: live {} against {}: {reason}\n", "", cell.live, cell.experience);
            }
            let failed: Vec<_> = failed
                .iter()
                .map(|(cell, reason)| json!({ "live": cell.live, "experience": cell.experience, "setting": cell.setting, "reason": reason }))
                .collect();
            listing.push(json!({ "failed": failed, "run": row.id, "matrix": record.name, "site": record.site, "cells": cells, "finished": finished, "blocked": record.blocked, "cluster": tasks }));
        }
        if context.json {
            print_json(&json!({ "runs": listing }))?;
        } else if text.is_empty() {
            print("no run yet: `furrow run MATRIX.toml` makes one\n")?;
        } else {
            print(&text)?;
        }
        Ok(Ending::Done)
    }
}
