//! The command `furrow`, run as a user runs it: by one line, as it would be typed.

use serde_json::Value;
use std::ffi::OsStr;
use std::fmt;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A path or name as one word of a line: written with the quotes that it needs, used as the path that it is.
#[derive(Debug, Clone)]
pub struct Quoted(PathBuf);

/// `name` as one word of a line.
pub fn quoted(name: impl AsRef<Path>) -> Quoted {
    Quoted(name.as_ref().to_owned())
}

impl Quoted {
    /// The path without quotes, as JSON has it.
    pub fn text(&self) -> &str {
        self.0.to_str().expect("a path in UTF-8")
    }
}

impl fmt::Display for Quoted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shlex::try_quote(self.text()).map_err(|_| fmt::Error)?)
    }
}

impl Deref for Quoted {
    type Target = Path;
    fn deref(&self) -> &Path {
        &self.0
    }
}

impl AsRef<Path> for Quoted {
    fn as_ref(&self) -> &Path {
        &self.0
    }
}

/// One call of the command.
pub struct Furrow(Command);

/// `furrow LINE`; the line is split as a shell splits it.
#[track_caller]
pub fn furrow(line: impl AsRef<str>) -> Furrow {
    let line = line.as_ref();
    let mut command = Command::new(env!("CARGO_BIN_EXE_furrow"));
    command.args(shlex::split(line).unwrap_or_else(|| panic!("an open quote: {line}"))).env_remove("FURROW_STORE");
    Furrow(command)
}

impl Furrow {
    pub fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.0.env(name, value);
        self
    }

    /// Runs it in a folder.
    pub fn in_folder(mut self, folder: &Path) -> Self {
        self.0.current_dir(folder);
        self
    }

    /// Success: what it prints with `--json`.
    #[track_caller]
    pub fn json(self) -> Value {
        self.json_with_code(0)
    }

    /// What it prints with `--json`, and ends with this exit code.
    #[track_caller]
    pub fn json_with_code(mut self, code: i32) -> Value {
        self.0.arg("--json");
        let ended = self.ended(code);
        serde_json::from_slice(&ended.stdout).unwrap_or_else(|error| panic!("no JSON on stdout: {error}"))
    }

    /// Success: what it prints.
    #[track_caller]
    pub fn text(self) -> String {
        String::from_utf8(self.ended(0).stdout).expect("text in UTF-8")
    }

    /// Failure with this exit code, and with `words` on stderr: what stands there.
    #[track_caller]
    pub fn fails(self, code: i32, words: &[&str]) -> String {
        let stderr = String::from_utf8_lossy(&self.ended(code).stderr).into_owned();
        words.iter().for_each(|word| assert!(stderr.contains(word), "expected '{word}' in: {stderr}"));
        stderr
    }

    /// Whatever comes out.
    pub fn output(mut self) -> Output {
        self.0.output().expect("furrow starts")
    }

    /// The command itself, to be started otherwise.
    pub fn into_command(self) -> Command {
        self.0
    }

    /// The end with this exit code, without a panic on the way.
    #[track_caller]
    fn ended(self, code: i32) -> Output {
        let line = format!("{:?}", self.0);
        let output = self.output();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code), "{line} ended with {}, not {code}: {stderr}", output.status);
        assert!(!stderr.contains("panicked"), "{line}: {stderr}");
        output
    }
}
