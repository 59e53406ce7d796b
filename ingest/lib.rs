//! From recordings to recorded experiences. A tour, in the order of the data:
//! - [`recording`]: containers: ROS1 bags, MCAP, rosbag2 databases and folders; [`folder`]: folders of images;
//!   [`import`]: datasets of others, laid out as a profile tells;
//! - [`message`]: ROS messages from bytes;
//! - [`topics`], [`info_topics`]: which topics are the stereo pair, and which tell its calibration (`image_topics`:
//!   which are a camera's at all; `topic_error`);
//! - [`pairing`]: left and right frames by header stamp;
//! - [`traversal`]: the story: one traversal through storage, rectification and [`odometry`] into the catalogue, as one
//!   transaction.

pub mod folder;
mod image_topics;
pub mod import;
pub mod info_topics;
pub mod message;
pub mod pairing;
pub mod recording;
mod topic_error;
pub mod topics;
pub mod traversal;

pub use furrow_odometry as odometry;
