//! Reading recordings: ROS1 bags, MCAP files, rosbag2 `.db3` files and rosbag2 folders.
//!
//! [`open`] finds the container by its first bytes and walks its structure once, without decompressing: every record must lie
//! inside the file, or the file is refused with the byte offset and what to do. [`Recording::read`] then streams messages in
//! order of receive time with a few chunks in memory, decompressed on all cores.
//!
//! The walk is our own because the bytes are hostile until checked: the crates for ROS1 and MCAP trust lengths (and one maps
//! the file, so that a pulled memory stick would kill the process). They serve as independent oracles in the tests.

mod block;
mod chunk;
mod db3;
mod error;
mod file;
mod folder;
mod mcap_file;
mod mcap_record;
mod open;
mod ros1_bag;
mod ros1_record;
mod stream;
mod topic;

pub use error::ReadError;
pub use open::{open, open_many};
pub use stream::{Progress, RawMessage, Recording};
pub use topic::{Encoding, Topic};
