//! A mailbox with room for one letter: a newer one replaces what still waits, so that nobody works on what is stale.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

#[derive(Debug)]
struct State<T> {
    letter: Option<T>,
    at_work: bool,
    closed: bool,
}

/// One writer, one reader.
#[derive(Debug)]
pub(super) struct Mailbox<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

impl<T> Mailbox<T> {
    pub fn new() -> Self {
        Self { state: Mutex::new(State { letter: None, at_work: false, closed: false }), changed: Condvar::new() }
    }

    /// Puts a letter in; whether one that nobody took was thrown away for it.
    pub fn put(&self, letter: T) -> bool {
        let mut state = self.state();
        let replaced = state.letter.replace(letter).is_some();
        self.changed.notify_all();
        replaced
    }

    /// Waits for a letter; `None` once the box is closed. The reader is at work until it comes back for more.
    pub fn take(&self) -> Option<T> {
        let mut state = self.state();
        state.at_work = false;
        self.changed.notify_all();
        loop {
            if state.closed {
                return None;
            }
            if let Some(letter) = state.letter.take() {
                state.at_work = true;
                return Some(letter);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Ends the reader's work after the letter it has, if any.
    pub fn close(&self) {
        self.state().closed = true;
        self.changed.notify_all();
    }

    /// Waits until every letter is answered, or the box closed.
    pub fn settle(&self) {
        let mut state = self.state();
        while !state.closed && (state.at_work || state.letter.is_some()) {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn state(&self) -> MutexGuard<'_, State<T>> {
        // The state is whole between any two statements above: a panic elsewhere cannot have torn it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
