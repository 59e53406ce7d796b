//! ROS messages from bytes: the few types that ingest needs, in ROS1's serialisation and in CDR. Every length is
//! checked against the bytes that are left, and image data stay where they are. No file is read here.

mod camera_info;
mod cursor;
mod header;
mod image;
mod motion;
mod sensor_part;
mod sensor_region;
mod sensor_told;

pub use camera_info::CameraInfo;
pub use cursor::MessageError;
pub use header::Header;
pub use image::{CompressedImage, Image};
pub use motion::{Imu, NavSatFix, Odometry};
pub use sensor_part::SensorPart;
pub use sensor_told::PartCalibration;
