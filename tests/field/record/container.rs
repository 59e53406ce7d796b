//! What MCAP files and bags have in common.

use super::error::RecordError;
use super::fresh::FreshFile;
use super::messages::Message;

/// A container that takes messages in the order of their receive times.
pub trait Container {
    /// Writes one message, received at `received_ns`.
    fn put(&mut self, received_ns: i64, message: &Message) -> Result<(), RecordError>;
    /// Writes the index and gives the file back, ready to be named.
    fn finish(self: Box<Self>) -> Result<FreshFile, RecordError>;
}
