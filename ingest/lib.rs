//! From recordings to recorded experiences. A tour, in the data's way:
//! - [`recording`]: containers: ROS1 bags, MCAP, rosbag2 databases and folders; [`folder`]: loose image folders;
//! - [`message`]: ROS messages from bytes;
//! - [`topics`]: which topics are the stereo pair;
//! - [`pairing`]: left and right frames by header stamp;
//! - [`traversal`]: the story: one traversal through storage, rectification and [`odometry`] into the catalogue, as one transaction.

pub mod folder;
pub mod message;
pub mod traversal;
pub mod pairing;
pub mod recording;
pub mod topics;

pub use furrow_odometry as odometry;
