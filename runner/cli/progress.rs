//! Progress on stderr: a bar on a terminal, else a line per stage.

use furrow_runner::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// A bar that follows the stages of a command.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    stage: Mutex<String>,
    on_terminal: bool,
}

const UNITS: &str = "{msg:.bold} {wide_bar:.green} {pos}/{len} {per_sec} {eta} left";
const BYTES: &str = "{msg:.bold} {wide_bar:.green} {bytes}/{total_bytes} {eta} left";

/// Does a stage's work with a bar that counts its units, and takes the bar away again.
pub fn with_bar<T>(work: impl FnOnce(Progress<'_>) -> T) -> T {
    let bar = Bar::units();
    let done = work(&|progress| bar.show(progress.stage, progress.done, progress.total));
    bar.finish();
    done
}

impl Bar {
    /// A bar counting units.
    pub fn units() -> Self {
        Self::with(UNITS)
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
        Self { bar, stage: Mutex::default(), on_terminal: std::io::stderr().is_terminal() }
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
            if !self.on_terminal {
                eprintln!("  {stage} …");
            }
        }
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    /// Replaces the stage's name by a longer text.
    pub fn note(&self, text: String) {
        self.bar.set_message(text);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
