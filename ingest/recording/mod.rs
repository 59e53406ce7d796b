//! Reading recordings: ROS1 bags, MCAP files, rosbag2 `.db3` files and rosbag2 folders, as they are or compressed as a
//! whole, as raw messages. What messages mean is for `message` and `topics`.
//!
//! [`open`] finds the container by its first bytes and walks its structure once, without decompressing: every record
//! must lie inside the file, or the file is refused with the byte offset and what to do (`tests/reading/damage.rs`).
//! [`Recording::read`] then streams messages in order of receive time with a few chunks in memory, decompressed on all
//! cores.
//!
//! # Why the walk is our own
//! The crate `mcap` parses record bodies here, and its `sans_io::LinearReader` reads the summary section of a file. It
//! does not read the data section, and the crate `rosbag` only checks our readers in tests, because of what they do
//! with a damaged file. `tests/reading/libraries.rs` shows each point below; a test that fails after an update says
//! that the crate has become better.
//!
//! `mcap` 0.26, with all its checks on:
//! - a hole of zeros is read as records of opcode 0, without an error;
//! - a record that is longer than its uncompressed chunk takes bytes from behind the chunk (a debug build panics);
//! - what a chunk holds beyond its declared length is lost, without an error;
//! - chunks cannot be passed over, so that opening a file would read all of it;
//! - its errors do not say where in the file.
//!
//! `rosbag` 0.6.3, whose record parsers are only reached through a file that it maps itself:
//! - it panics on truncated bags (`index_pos` past the end) and unindexed ones (`index_pos` 0);
//! - a file that becomes shorter while it is read, as on a memory stick that is pulled, kills the process;
//! - what a bz2 chunk holds beyond its declared length is lost, without an error.

mod block;
mod buffer;
mod chunk;
mod container;
mod db3;
mod error;
mod expanded;
mod file;
mod jobs;
mod lz4;
mod mcap;
mod open;
mod part_names;
mod read_ahead;
mod ros1;
mod rosbag2_folder;
mod stream;
mod topic;
mod unpack;

pub use error::ReadError;
pub use open::{open, open_many};
pub(crate) use rosbag2_folder::unlisted_parts;
pub use rosbag2_folder::{folder_of_metadata, is_recording_folder};
pub use stream::{Progress, RawMessage, Recording};
pub use topic::{Encoding, Topic};
