//! What a run does and how long it takes, seen by its progress: stages by kind, so that the next plan can say what it will cost.

use crate::progress::{Progress, StageProgress};
use furrow_catalog::index::TimingRow;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// What was done of one kind of stage.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Images, frames, nodes, rounds or cells that were computed; what was found in the store does not count.
    pub units: u64,
    /// Wall clock, seconds.
    pub seconds: f64,
}

/// Kinds of stages: how their names begin. Slots and labels behind tell stages of one kind apart.
const KINDS: [&str; 9] = [FEATURES, TRAINING, WORDS, PAINTING, VERIFYING, NODES, CELLS, "small images", "colours at"];
pub(crate) const FEATURES: &str = "features of the vocabulary images";
pub(crate) const TRAINING: &str = "training the vocabulary";
pub(crate) const WORDS: &str = "words of";
pub(crate) const PAINTING: &str = "painting";
pub(crate) const VERIFYING: &str = "verifying";
pub(crate) const NODES: &str = "features of candidate nodes";
pub(crate) const CELLS: &str = "cells";

/// Listens to progress on its way to the user.
pub(crate) struct Clock<'a> {
    told: Progress<'a>,
    state: Mutex<State>,
}

struct State {
    work: BTreeMap<String, Work>,
    stage: String,
    done: u64,
    last: Instant,
}

impl<'a> Clock<'a> {
    /// Starts now.
    pub fn new(told: Progress<'a>) -> Self {
        let state = State { work: BTreeMap::new(), stage: String::new(), done: 0, last: Instant::now() };
        Self { told, state: Mutex::new(state) }
    }

    /// Takes note and passes on.
    pub fn hear(&self, progress: StageProgress<'_>) {
        let mut state = self.state();
        let (now, kind) = (Instant::now(), kind(progress.stage));
        let took_s = now.duration_since(state.last).as_secs_f64();
        let begins = state.stage != progress.stage || progress.done == 0;
        let before = if begins { 0 } else { state.done };
        let cells = kind == CELLS;
        // Cells are counted one by one, wherever in the matrix they stand; other stages tell how many units are behind.
        let units = if cells { 1 } else { progress.done.saturating_sub(before) };
        let work = state.work.entry(kind.to_owned()).or_default();
        (work.units, work.seconds) = (work.units + units, work.seconds + took_s);
        state.done = before.max(progress.done);
        state.last = now;
        if begins {
            progress.stage.clone_into(&mut state.stage);
        }
        drop(state);
        (self.told)(progress);
    }

    /// What was done by now, by kind.
    pub fn work(&self) -> BTreeMap<String, Work> {
        self.state().work.clone()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Plain numbers stay sound, whoever panicked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The kind of a stage, by its name.
fn kind(stage: &str) -> &str {
    KINDS.into_iter().find(|kind| stage.starts_with(kind)).unwrap_or(stage)
}

/// As rows of the catalogue.
pub(crate) fn rows(work: &BTreeMap<String, Work>) -> Vec<TimingRow> {
    let threads = rayon::current_num_threads() as u32;
    let row = |(stage, work): (&String, &Work)| TimingRow {
        stage: stage.clone(),
        subject: String::new(),
        units: work.units,
        seconds: work.seconds,
        threads,
    };
    work.iter().filter(|(_, work)| work.units > 0).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_counted_by_kind_whatever_order_threads_speak_in() {
        let clock = Clock::new(&|_| {});
        let say = |stage, done| clock.hear(StageProgress { stage, done, total: 3 });
        for done in [0, 1, 3, 2] {
            say("words of the live pass at 08:00", done);
        }
        for done in [0, 1, 2, 3] {
            say("words of the experience 10:00", done);
        }
        say("verifying", 0);
        say("verifying", 3);
        say("verifying", 0);
        say("verifying", 3);
        say("cells", 4);
        say("cells", 9);
        let units: Vec<(String, u64)> = clock.work().into_iter().map(|(kind, work)| (kind, work.units)).collect();
        let expected = [("cells", 2), ("verifying", 6), ("words of", 6)];
        assert_eq!(units, expected.map(|(kind, units)| (kind.to_owned(), units)));
    }
}
