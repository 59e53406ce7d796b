//! Python with other people's packages, in an environment of its own under the target folder, made once. Included by
//! the benchmarks with `#[path]`.

use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

pub struct Python(PathBuf);

impl Python {
    /// Finds or makes the environment `name` with these packages: every one that is needed, so that nothing else comes
    /// with it. The error says why there is none: no Python, or no network.
    pub fn with(name: &str, packages: &[&str]) -> Result<Self, String> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let (python, ready) = (folder.join("bin/python"), folder.join("ready"));
        let wanted = packages.join("\n");
        if std::fs::read_to_string(&ready).is_ok_and(|found| found == wanted) {
            return Ok(Self(python));
        }
        run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
        let quietly = "-m pip install --quiet --disable-pip-version-check --timeout=15 --retries=1 --no-deps";
        run(Command::new(&python).args(quietly.split(' ')).args(packages))?;
        std::fs::write(&ready, wanted).map_err(|error| error.to_string())?;
        Ok(Self(python))
    }

    /// What a script prints as JSON; else the end of what it says on stderr.
    pub fn json(&self, script: &str, arguments: &[&OsStr]) -> Result<Value, String> {
        let printed = run(Command::new(&self.0).args(["-c", script]).args(arguments))?;
        serde_json::from_slice(&printed).map_err(|error| error.to_string())
    }
}

/// What a command prints, or the last line of what it complains of.
fn run(command: &mut Command) -> Result<Vec<u8>, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(stderr.lines().last().unwrap_or("it failed").to_owned())
    }
}
