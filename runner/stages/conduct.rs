//! How a run goes about failures and memory.

/// What its caller chooses.
#[derive(Debug, Clone, Copy, Default)]
pub struct Conduct {
    /// Cells that do not hang on what failed are computed all the same.
    pub keep_going: bool,
    /// Bytes that the work in flight stays within; default: [`usual`](crate::stages::memory::usual). Results do not
    /// depend on it.
    pub memory: Option<u64>,
}
