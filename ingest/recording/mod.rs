//! Reading recordings: ROS1 bags, MCAP files, rosbag2 `.db3` files and rosbag2 folders, as raw messages. What messages
//! mean is for `message` and `topics`.
//!
//! [`open`] finds the container by its first bytes and walks its structure once, without decompressing: every record
//! must lie inside the file, or the file is refused with the byte offset and what to do. [`Recording::read`] then
//! streams messages in order of receive time with a few chunks in memory, decompressed on all cores.

mod block;
mod chunk;
mod container;
mod db3;
mod error;
mod file;
mod mcap;
mod open;
mod read_ahead;
mod ros1;
mod rosbag2_folder;
mod stream;
mod topic;

pub use error::ReadError;
pub use open::{open, open_many};
pub use stream::{Progress, RawMessage, Recording};
pub use topic::{Encoding, Topic};
