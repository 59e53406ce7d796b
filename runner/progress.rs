//! How a run tells how far it is.

/// A stage's progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageProgress<'a> {
    /// What is being done.
    pub stage: &'a str,
    /// Units done.
    pub done: u64,
    /// Units in all.
    pub total: u64,
}

/// Is told about progress, from any thread.
pub type Progress<'a> = &'a (dyn Fn(StageProgress<'_>) + Sync);

/// Counts the units of one stage.
pub(crate) struct Counter<'a> {
    progress: Progress<'a>,
    stage: &'a str,
    total: u64,
    done: std::sync::atomic::AtomicU64,
}

impl<'a> Counter<'a> {
    pub fn new(progress: Progress<'a>, stage: &'a str, total: usize) -> Self {
        progress(StageProgress { stage, done: 0, total: total as u64 });
        Self { progress, stage, total: total as u64, done: 0.into() }
    }

    /// One more unit is done.
    pub fn tick(&self) {
        let done = self.done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
        (self.progress)(StageProgress { stage: self.stage, done, total: self.total });
    }
}
