//! One reported input, and what is right.

use crate::support::command::quoted;
use crate::support::store::Store;
use serde_json::Value;
use std::path::Path;
use std::process::Output;

/// How far a length may be from the truth: the best odometry's error over so few frames is below 1 %.
const WITHIN: f64 = 0.02;

/// The ways in which an input may end rightly.
#[derive(Debug, Clone, Copy)]
enum Right {
    /// Read: pairs, and the true length in metres.
    Read(u64, f64),
    /// Refused, nothing entered: exit code 1 or 3.
    Refused,
    /// Read so, or refused so.
    Either(u64, f64),
}

/// One input.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Recordings below the folder of cases, separated by `;`.
    paths: &'static str,
    /// Options as typed; `{}` stands for the case's folder, `{cases}` for that of all cases.
    options: &'static str,
    /// The profile by which it is imported; ingested without.
    profile: Option<&'static str>,
    right: Right,
    /// What notes or the refusal must name, in any letter case.
    words: &'static [&'static str],
}

/// Read whole, as so many pairs over so many true metres.
pub const fn read(paths: &'static str, pairs: u64, metres: f64) -> Case {
    Case { paths, options: "", profile: None, right: Right::Read(pairs, metres), words: &[] }
}

/// Refused, with these words.
pub const fn refused(paths: &'static str, words: &'static [&'static str]) -> Case {
    Case { paths, options: "", profile: None, right: Right::Refused, words }
}

/// Read whole, or refused with these words.
pub const fn read_or_refused(paths: &'static str, pairs: u64, metres: f64, words: &'static [&'static str]) -> Case {
    Case { paths, options: "", profile: None, right: Right::Either(pairs, metres), words }
}

impl Case {
    /// With options as typed.
    pub const fn with(self, options: &'static str) -> Self {
        Self { options, ..self }
    }

    /// Imported by a profile.
    pub const fn by(self, profile: &'static str) -> Self {
        Self { profile: Some(profile), ..self }
    }

    /// With notes that hold these words.
    pub const fn noting(self, words: &'static [&'static str]) -> Self {
        Self { words, ..self }
    }

    /// Ingests it into a store of its own; what is wrong, where something is.
    pub fn try_in(&self, folder: &Path) -> Result<(), String> {
        let store = Store::new();
        let output = self.ingest(folder, &store);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        let fault = |what: String| Err(format!("{} {}: {what}\n    {}", self.paths, self.options, last_line(&stderr)));
        if stderr.contains("panicked") {
            return fault("a panic".to_owned());
        }
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        let said = match (self.right, output.status.code()) {
            (Right::Read(pairs, metres) | Right::Either(pairs, metres), Some(0)) => {
                let length_m = summary["trajectory"]["length_m"].as_f64().unwrap_or(-1.0);
                let failed = &summary["trajectory"]["failed_steps"];
                let is_right = summary["pairs"] == pairs && failed == 0 && (length_m - metres).abs() <= WITHIN * metres;
                if !is_right {
                    let (pairs_read, notes) = (&summary["pairs"], &summary["notes"]);
                    return fault(format!(
                        "expected {pairs} pairs over {metres} m, read {pairs_read} over {length_m:.2} m, {failed} failed, notes {notes}"
                    ));
                }
                match self.right {
                    Right::Either(..) => return Ok(()),
                    _ => summary["notes"].to_string(),
                }
            }
            (Right::Refused | Right::Either(..), Some(1 | 3)) => {
                store.assert_intact();
                match store.json("ls")["traversals"].as_array().map_or(0, Vec::len) {
                    0 => stderr.clone(),
                    traversals => return fault(format!("it was refused and {traversals} traversals entered")),
                }
            }
            (right, code) => {
                let length_m = &summary["trajectory"]["length_m"];
                return fault(format!("expected {right:?}, ended with {code:?}, {length_m} m"));
            }
        };
        let missing = self.words.iter().find(|word| !said.to_lowercase().contains(&word.to_lowercase()));
        missing.map_or(Ok(()), |word| fault(format!("expected '{word}' in: {said}")))
    }

    fn ingest(&self, folder: &Path, store: &Store) -> Output {
        let first = self.paths.split(';').next().unwrap_or_default();
        let case = first.split('/').next().unwrap_or_default();
        let options = self.options.replace("{}", &quoted(folder.join(case)).to_string());
        let options = options.replace("{cases}", &quoted(folder).to_string());
        let verb = if self.profile.is_some() { "import" } else { "ingest" };
        let labels = "--site s --route r --slot 10:00 --purpose experience --json";
        let mut command = store.furrow(format!("{verb} {labels} {options}")).into_command();
        // Options that take several values end here; paths may hold bytes that no line can.
        command.arg("--").args(self.profile).args(self.paths.split(';').map(|path| folder.join(path)));
        command.output().expect("furrow starts")
    }
}

fn last_line(text: &str) -> &str {
    text.lines().rev().find(|line| line.starts_with("furrow:")).unwrap_or_default()
}
