//! Jobs of reading: some chunks each, done by the thread that comes first.

use super::block::Block;
use super::chunk::ChunkAt;
use super::error::ReadError;
use super::file::SharedFile;
use super::unpack::Unpacker;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Finds the messages in a chunk's data.
pub(crate) trait DecodeChunk: Send + Sync + 'static {
    /// Adds entries for the wanted messages of a chunk, whose data are those of the block from `start` on.
    fn decode(&self, at: &ChunkAt, start: usize, block: &mut Block) -> Result<(), ReadError>;
}

/// Reads chunks of a file, for several threads at once.
pub(crate) struct ChunkReader<D> {
    file: SharedFile,
    decoder: D,
    /// Those that no thread uses now.
    unpackers: Mutex<Vec<Unpacker>>,
}

impl<D: DecodeChunk> ChunkReader<D> {
    /// Reads from `file`.
    pub(crate) fn new(file: SharedFile, decoder: D) -> Self {
        Self { file, decoder, unpackers: Mutex::default() }
    }

    /// Fills a block with the messages of chunks, chunk by chunk; before an error, with those of the chunks before.
    fn read(&self, chunks: &[ChunkAt], block: &mut Block) -> Result<(), ReadError> {
        let mut unpacker = lock(&self.unpackers).pop().unwrap_or_default();
        let read = chunks.iter().try_for_each(|at| {
            let (start, first) = (block.bytes.len(), block.entries.len());
            let decoded = unpacker.unpack(&self.file, at, &mut block.bytes);
            let decoded = decoded.and_then(|()| self.decoder.decode(at, start, block));
            decoded.inspect_err(|_| block.entries.truncate(first))?;
            block.put_in_order(first);
            Ok(())
        });
        lock(&self.unpackers).push(unpacker);
        read
    }
}

/// Chunks to be read into one block.
pub(crate) struct Job {
    chunks: Vec<ChunkAt>,
    state: Mutex<State>,
    ended: Condvar,
}

enum State {
    /// Nobody has begun; the block is the memory to read into.
    Waiting(Block),
    /// A thread is at it, or the block was taken.
    Busy,
    Ended(Block, Result<(), ReadError>),
}

impl Job {
    /// Chunks to be read into the memory of `block`.
    pub(crate) fn new(chunks: Vec<ChunkAt>, block: Block) -> Self {
        Self { chunks, state: Mutex::new(State::Waiting(block)), ended: Condvar::new() }
    }

    /// Bytes that it takes, packed and unpacked.
    pub(crate) fn bytes(&self) -> u64 {
        self.chunks.iter().map(ChunkAt::bytes_taken).sum()
    }

    /// Bytes of its chunks in the file.
    pub(crate) fn packed_bytes(&self) -> u64 {
        self.chunks.iter().map(|at| at.bytes).sum()
    }

    /// Where in the file its last chunk ends.
    pub(crate) fn end(&self) -> u64 {
        self.chunks.last().map_or(0, |at| at.offset + at.bytes)
    }

    /// Does it, unless a thread has begun already: whether this one did.
    pub(crate) fn run<D: DecodeChunk>(&self, reader: &ChunkReader<D>) -> bool {
        let mut state = lock(&self.state);
        if !matches!(&*state, State::Waiting(_)) {
            return false;
        }
        let State::Waiting(mut block) = std::mem::replace(&mut *state, State::Busy) else { return false };
        drop(state);
        block.clear();
        let read = reader.read(&self.chunks, &mut block);
        *lock(&self.state) = State::Ended(block, read);
        self.ended.notify_all();
        true
    }

    /// What was read; `None` where it has not ended.
    pub(crate) fn take(&self) -> Option<(Block, Result<(), ReadError>)> {
        let mut state = lock(&self.state);
        if !matches!(&*state, State::Ended(..)) {
            return None;
        }
        match std::mem::replace(&mut *state, State::Busy) {
            State::Ended(block, read) => Some((block, read)),
            _ => None,
        }
    }

    /// Waits for the thread that is at it.
    pub(crate) fn wait(&self) {
        let is_busy = |state: &mut State| matches!(state, State::Busy);
        drop(self.ended.wait_while(lock(&self.state), is_busy).unwrap_or_else(PoisonError::into_inner));
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
