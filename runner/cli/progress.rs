//! Progress on stderr: a bar where someone looks on, a line per stage where not.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// A bar that follows the stages of a command.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    stage: Mutex<String>,
    watched: bool,
}

const STAGE: &str = "{msg:.bold} {wide_bar:.green} {pos}/{len} {per_sec} {eta} left";
const BYTES: &str = "{msg:.bold} {wide_bar:.green} {bytes}/{total_bytes} {eta} left";

impl Bar {
    /// A bar counting units.
    pub fn units() -> Self {
        Self::with(STAGE)
    }

    /// A bar counting bytes.
    pub fn bytes() -> Self {
        Self::with(BYTES)
    }

    fn with(template: &str) -> Self {
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(250));
        Self { bar, stage: Mutex::default(), watched: std::io::stderr().is_terminal() }
    }

    /// Shows where the work is.
    pub fn show(&self, stage: &str, done: u64, total: u64) {
        let changed = self.stage.lock().is_ok_and(|mut current| {
            let changed = *current != stage;
            if changed {
                stage.clone_into(&mut current);
            }
            changed
        });
        if changed {
            self.bar.reset_eta();
            self.bar.set_message(stage.to_owned());
            if !self.watched {
                eprintln!("  {stage} …");
            }
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    /// Adds words to the stage's name.
    pub fn note(&self, text: String) {
        self.bar.set_message(text);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
