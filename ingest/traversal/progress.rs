//! How far an ingest has come.

/// What an ingest is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IngestStage {
    /// Reading every byte once, for the recording's digest.
    Digest,
    /// Reading frames, storing them and computing the chain through them.
    Frames,
}

/// How far an ingest has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IngestProgress {
    /// What is being done.
    pub stage: IngestStage,
    /// Bytes done; images, where a folder of images is read.
    pub bytes: u64,
    /// Bytes in all; images, where a folder of images is read.
    pub bytes_total: u64,
    /// Frames stored.
    pub frames: u64,
}
