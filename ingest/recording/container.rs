//! What every container of messages can do.

use super::block::Block;
use super::error::ReadError;
use super::topic::Topic;
use std::fmt::Debug;

/// A file of messages whose structure was found sound.
pub(crate) trait Container: Debug + Send + Sync {
    /// Its topics.
    fn topics(&self) -> &[Topic];

    /// Its length in bytes.
    fn bytes(&self) -> u64;

    /// When its first message was received, nanoseconds since 1970; `None` where it has none.
    fn first_ns(&self) -> Option<i64>;

    /// When its last message was received, nanoseconds since 1970; `None` where it has none.
    fn last_ns(&self) -> Option<i64>;

    /// The messages of the topics that are `wanted`, by their place in [`Container::topics`].
    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError>;
}

/// A container's messages, block by block.
pub(crate) trait Blocks {
    /// The next block; `None` at the end. The memory of one that was `used` is used again.
    fn next(&mut self, used: Block) -> Result<Option<Block>, ReadError>;

    /// How much of the file has been read, in bytes.
    fn bytes_read(&self) -> u64;
}
