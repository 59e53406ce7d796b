//! Recording a traversal as a robot would: a real MCAP file (ROS 2, zstd) or ROS 1 bag (lz4), and what no robot knows
//! beside it.
//!
//! Beside `a.mcap` lie `a.groundtruth.tum` (stamp, position, quaternion of the rectified left camera: world from
//! camera; world x east, y north, z up; camera x right, y down, z forward), `a.frames.csv` (sun, exposure, times and
//! losses per frame) and `a.pass.json` (what was simulated). Files appear complete or not at all.
//!
//! A frame is named by the stamp of its left image, by the camera's own clock; its pose is the true one in the middle
//! of its exposure. Where that clock runs fast, stamps and true times (`true_ns` in `frames.csv`) part; IMU and GPS
//! keep the true time.

pub mod bag;
pub mod beside;
pub mod container;
pub mod definitions;
pub mod error;
pub mod fresh;
pub mod mcap;
pub mod messages;
pub mod sensors;
pub mod wire;
pub mod write;

pub use error::RecordError;
pub use write::{Summary, record};
