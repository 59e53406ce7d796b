use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::RunName;
use crate::output::{print, print_json};
use furrow_catalog::Catalog;
use furrow_catalog::index::FailureRow;
use furrow_catalog::records::{RunCell, RunRecord};
use furrow_model::RunId;
use furrow_runner::slurm::{Tasks, tasks};
use serde_json::{Value, json};
use std::fmt::Write;

/// List the runs of the store, with how many of their cells are finished and why others failed.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow status\n  furrow status latest --json")]
pub struct Status {
    /// Only this run: its id, the beginning of it, or `latest`.
    run: Option<RunName>,
}

impl Status {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let wanted = self.run.map(|name| name.find(&catalog)).transpose()?;
        let failures = catalog.failures()?;
        let rows = catalog.runs()?.into_iter().filter(|row| wanted.is_none_or(|id| id == row.id));
        let states: Vec<State> = rows.map(|row| State::read(&catalog, row.id, &failures)).collect::<Result<_, _>>()?;
        if context.json {
            print_json(&json!({ "runs": states.iter().map(State::json).collect::<Vec<_>>() }))?;
        } else if states.is_empty() {
            print("no run yet: `furrow run MATRIX.toml` makes one\n")?;
        } else {
            print(&states.iter().map(State::text).collect::<String>())?;
        }
        Ok(Ending::Done)
    }
}

/// How far a run is.
struct State {
    id: RunId,
    record: RunRecord,
    finished: usize,
    /// Which cells failed, and why.
    failed: Vec<(RunCell, String)>,
    /// Its tasks on a cluster, if it was submitted to one.
    tasks: Option<Tasks>,
}

impl State {
    fn read(catalog: &Catalog, id: RunId, failures: &[FailureRow]) -> Result<Self, Failure> {
        let record = catalog.run(id)?;
        let (mut finished, mut failed) = (0, Vec::new());
        for cell in &record.cells {
            finished += usize::from(catalog.outcome(cell.key)?.is_some());
            let failure = failures.iter().find(|failure| failure.cell == cell.key);
            failed.extend(failure.map(|failure| (cell.clone(), failure.reason.clone())));
        }
        Ok(Self { id, record, finished, failed, tasks: tasks(catalog, id) })
    }

    fn json(&self) -> Value {
        let failed = |(cell, reason): &(RunCell, String)| json!({ "live": cell.live, "experience": cell.experience, "setting": cell.setting, "reason": reason });
        json!({
            "failed": self.failed.iter().map(failed).collect::<Vec<_>>(), "run": self.id, "matrix": self.record.name,
            "site": self.record.site, "cells": self.record.cells.len(), "finished": self.finished,
            "blocked": self.record.blocked, "cluster": self.tasks,
        })
    }

    fn text(&self) -> String {
        let (cells, blocked) = (self.record.cells.len(), self.record.blocked.len());
        let (id, name, finished) = (self.id.short(), &self.record.name, self.finished);
        let mut text = format!("{id}  {name:<30} {finished} of {cells} cells finished, {blocked} blocked\n");
        if let Some(Tasks { round, all, done, failed }) = self.tasks {
            let _ =
                writeln!(text, "{:14}on the cluster, round {round}: {done} of {all} tasks done, {failed} failed", "");
        }
        for (cell, reason) in &self.failed {
            let _ = writeln!(text, "{:14}failed: live {} against {}: {reason}", "", cell.live, cell.experience);
        }
        text
    }
}
