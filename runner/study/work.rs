//! What a run does and how long it takes, seen by its progress: stages by kind, so that the next plan can say what it
//! will cost.

use crate::progress::{Progress, Stage, StageProgress, Subject};
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

/// Listens to progress on its way to the user.
pub(crate) struct Clock<'a> {
    progress: Progress<'a>,
    state: Mutex<State>,
}

struct State {
    work: BTreeMap<Stage, Work>,
    /// The stage that reported last, and what it works on.
    at: Option<(Stage, Subject<'static>)>,
    done: u64,
    last: Instant,
}

impl<'a> Clock<'a> {
    /// Starts now.
    pub fn new(progress: Progress<'a>) -> Self {
        let state = State { work: BTreeMap::new(), at: None, done: 0, last: Instant::now() };
        Self { progress, state: Mutex::new(state) }
    }

    /// Takes note and passes on.
    pub fn hear(&self, progress: StageProgress<'_>) {
        let mut state = self.state();
        let now = Instant::now();
        let took_s = now.duration_since(state.last).as_secs_f64();
        let goes_on = state.at.as_ref().is_some_and(|(stage, of)| *stage == progress.stage && *of == progress.of);
        let begins = !goes_on || progress.done == 0;
        let before = if begins { 0 } else { state.done };
        // Cells are counted one by one, wherever in the matrix they stand; other stages tell how many units are behind.
        let units = if progress.stage == Stage::Cells { 1 } else { progress.done.saturating_sub(before) };
        let work = state.work.entry(progress.stage).or_default();
        (work.units, work.seconds) = (work.units + units, work.seconds + took_s);
        state.done = before.max(progress.done);
        state.last = now;
        if begins {
            state.at = Some((progress.stage, progress.of.clone().into_owned()));
        }
        drop(state);
        (self.progress)(progress);
    }

    /// What was done by now, by the stages' names.
    pub fn work(&self) -> BTreeMap<String, Work> {
        self.state().work.iter().map(|(stage, work)| (stage.name().to_owned(), *work)).collect()
    }

    /// What was done of one stage by now.
    pub fn work_of(&self, stage: Stage) -> Work {
        self.state().work.get(&stage).copied().unwrap_or_default()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Plain numbers stay sound, whoever panicked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
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
        let say = |stage, of, done| clock.hear(StageProgress { stage, of, done, total: 3 });
        for done in [0, 1, 3, 2] {
            say(Stage::Words, Subject::Live("08:00".parse().unwrap()), done);
        }
        for done in [0, 1, 2, 3] {
            say(Stage::Words, Subject::experience("10:00"), done);
        }
        for done in [0, 3, 0, 3] {
            say(Stage::Verification, Subject::Whole, done);
        }
        for done in [4, 9] {
            say(Stage::Cells, Subject::Whole, done);
        }
        let units: Vec<(String, u64)> = clock.work().into_iter().map(|(kind, work)| (kind, work.units)).collect();
        let expected = [("cells", 2), ("verifying", 6), ("words of", 6)];
        assert_eq!(units, expected.map(|(kind, units)| (kind.to_owned(), units)));
    }
}
