//! Slurm's own commands: `sbatch` submits, `squeue` tells what is still there. Their text is the same in all versions;
//! JSON and accounting are not everywhere.

use super::job::StageName;
use super::report::log_of;
use crate::RunError;
use std::path::Path;
use std::process::Command;

/// How jobs are submitted.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Queue {
    /// `--partition`.
    pub partition: Option<String>,
    /// `--time`, of a task.
    pub time: Option<String>,
    /// Tasks of an array that run at once, at the most.
    pub array_limit: Option<u32>,
    /// Threads of a task.
    pub threads: Option<usize>,
    /// Further options of `sbatch`, as they are.
    pub more: Vec<String>,
}

/// An array of tasks to submit.
pub(super) struct Array<'a> {
    pub name: &'a str,
    pub stage: StageName,
    pub tasks: usize,
    /// The job that must have ended before, and whether it must have ended well.
    pub after: Option<(&'a str, bool)>,
    /// What every task runs: the program and its arguments, but for the number of the task.
    pub command: &'a [String],
    /// Where logs go.
    pub folder: &'a Path,
}

/// What a node runs: Slurm gives the number of the task.
const SCRIPT: &str = "#!/bin/sh\nexec \"$@\" --task \"$SLURM_ARRAY_TASK_ID\"\n";

impl Queue {
    /// Submits an array; its job's number.
    pub(super) fn submit(&self, array: &Array<'_>) -> Result<String, RunError> {
        let script = array.folder.join("worker.sh");
        furrow_catalog::write_file(&script, SCRIPT.as_bytes())?;
        let log = log_of(array.folder, array.stage, 0).to_string_lossy().replace("-0.log", "-%a.log");
        let limit = self.array_limit.map_or_else(String::new, |limit| format!("%{limit}"));
        let mut command = Command::new("sbatch");
        command.args(["--parsable", "--requeue", "--open-mode=append"]);
        command.arg(format!("--job-name={}", array.name));
        command.arg(format!("--array=0-{}{limit}", array.tasks.saturating_sub(1)));
        command.arg(format!("--output={log}")).arg(format!("--cpus-per-task={}", self.threads.unwrap_or(1)));
        if let Some((job, well)) = array.after {
            let how = if well { "afterok" } else { "afterany" };
            command.arg(format!("--dependency={how}:{job}")).arg("--kill-on-invalid-dep=yes");
        }
        command.args(self.partition.iter().map(|partition| format!("--partition={partition}")));
        command.args(self.time.iter().map(|time| format!("--time={time}")));
        command.args(&self.more).arg(&script).args(array.command);
        let said = answer(&mut command)?;
        // `--parsable` answers JOB or JOB;CLUSTER.
        Ok(said.trim().split(';').next().unwrap_or_default().to_owned())
    }

    /// The tasks of jobs of a name that are waiting or running, as Slurm names their states.
    pub(super) fn active(name: &str) -> Result<Vec<String>, RunError> {
        let said = answer(Command::new("squeue").args(["--noheader", "--array", "--format=%T", "--name", name]))?;
        Ok(said.lines().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect())
    }
}

/// What a command of Slurm prints.
fn answer(command: &mut Command) -> Result<String, RunError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => RunError::Slurm(format!(
            "'{name}' is not on this machine: submit where Slurm's commands are (Debian: slurm-client), or run with --executor local"
        )),
        _ => RunError::Slurm(format!("cannot start {name}: {error}")),
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(RunError::Slurm(format!("{name} failed: {}", String::from_utf8_lossy(&output.stderr).trim())))
}
