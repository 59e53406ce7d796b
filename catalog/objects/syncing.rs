//! Files made durable while others are still being written: a disk's answer takes milliseconds, and nobody computes
//! meanwhile where it is waited for at the end.

use crate::CatalogError;
use std::fs::File;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// Threads that wait for the disk at once: file systems answer those that wait together together.
const WAITING: usize = 4;

/// Threads that fsync the files that are pushed.
#[derive(Debug)]
pub(crate) struct Syncing {
    files: Sender<PathBuf>,
    threads: Vec<JoinHandle<Result<(), CatalogError>>>,
}

impl Syncing {
    pub fn begin() -> Self {
        let (files, queue) = channel();
        let queue = Arc::new(Mutex::new(queue));
        let spawn = |queue: Arc<Mutex<Receiver<PathBuf>>>| std::thread::spawn(move || sync_each(&queue));
        Self { files, threads: (0..WAITING).map(|_| spawn(Arc::clone(&queue))).collect() }
    }

    /// Has a written file made durable. [`Syncing::finish`] says whether that succeeded.
    pub fn push(&self, file: PathBuf) {
        // A thread that failed takes no more, and its error is returned at the end.
        let _ = self.files.send(file);
    }

    /// Waits until every file is durable.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the disk refuses one.
    pub fn finish(self) -> Result<(), CatalogError> {
        drop(self.files);
        let join = |thread: JoinHandle<_>| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        self.threads.into_iter().try_for_each(join)
    }
}

fn sync_each(queue: &Mutex<Receiver<PathBuf>>) -> Result<(), CatalogError> {
    loop {
        let next = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(path) = next else { return Ok(()) };
        File::open(&path).and_then(|file| file.sync_all()).map_err(CatalogError::file("fsync", &path))?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_made_durable_is_named_at_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let there = folder.path().join("there");
        std::fs::write(&there, "bytes").unwrap();
        let syncing = Syncing::begin();
        (0..20).for_each(|_| syncing.push(there.clone()));
        assert!(syncing.finish().is_ok());
        let syncing = Syncing::begin();
        syncing.push(there);
        syncing.push(folder.path().join("gone"));
        let error = syncing.finish().unwrap_err().to_string();
        assert!(error.contains("gone") && error.contains("fsync"), "{error}");
    }
}
