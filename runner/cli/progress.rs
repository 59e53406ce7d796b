//! Progress on stderr: a bar on a terminal, else a line per stage.

use furrow_runner::{Progress, Stage, StageProgress, Subject};
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
    let done = work(&|progress| bar.show(&stage_text(&progress), progress.done, progress.total));
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

/// What is being done, in words.
fn stage_text(progress: &StageProgress<'_>) -> String {
    let what = match progress.stage {
        Stage::VocabularyFeatures => "features of the vocabulary images",
        Stage::VocabularyTraining => "training the vocabulary",
        Stage::Words => "words",
        Stage::SmallImages => "small images",
        Stage::Calibration => "calibrating the threshold",
        Stage::NodeFeatures => "features of candidate nodes",
        Stage::Verification => "verifying",
        Stage::Painting => "painting",
        Stage::Colours => "colours",
        Stage::SwitchIndex => "moving the generator from z = 0 to 1",
        Stage::GeneratorMeasures => "measuring the generator",
        Stage::Cells => "cells",
        Stage::Export => "exporting",
        Stage::Reingestion => "ingesting again",
        Stage::ClusterTasks => "tasks on the cluster",
    };
    match &progress.of {
        Subject::Whole => what.to_owned(),
        Subject::Live(slot) => format!("{what} of the live traversal at {slot}"),
        Subject::Experience(label) => format!("{what} of the experience {label}"),
        Subject::Slot(slot) => format!("{what} at {slot}"),
        Subject::Mimicked(slot, domainness) => format!("{what} {slot} at z = {domainness}"),
        Subject::Running(tasks) => format!("{what}, {tasks} running"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_says_what_it_works_on() {
        let text = |stage, of| stage_text(&StageProgress { stage, of, done: 0, total: 1 });
        let slot = || "08:00".parse().unwrap();
        assert_eq!(text(Stage::Cells, Subject::Whole), "cells");
        assert_eq!(text(Stage::Words, Subject::Live(slot())), "words of the live traversal at 08:00");
        assert_eq!(text(Stage::Words, Subject::experience("10:00 #2")), "words of the experience 10:00 #2");
        assert_eq!(text(Stage::Colours, Subject::Slot(slot())), "colours at 08:00");
        assert_eq!(text(Stage::Painting, Subject::Mimicked(slot(), 0.5)), "painting 08:00 at z = 0.5");
        assert_eq!(text(Stage::ClusterTasks, Subject::Running(3)), "tasks on the cluster, 3 running");
    }
}
