//! ROS messages from bytes, by hand: of the few types that ingest needs, in ROS1's serialisation and in CDR, with every length
//! checked against the bytes that are left. Image data stay where they are.

mod camera_info;
mod cursor;
mod image;
mod motion;

pub use camera_info::CameraInfo;
pub use cursor::MessageError;
pub use image::{CompressedImage, Image};
pub use motion::{Imu, NavSatFix, Odometry};

use crate::recording::Encoding;
use cursor::Cursor;

/// `std_msgs/Header`: when and in which frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header<'a> {
    /// The moment of capture, nanoseconds since 1970: frames are paired and named by it.
    pub stamp_ns: i64,
    /// The coordinate frame's name.
    pub frame_id: &'a str,
}

impl<'a> Header<'a> {
    fn read(cursor: &mut Cursor<'a>, encoding: Encoding) -> Result<Self, MessageError> {
        if encoding == Encoding::Ros1 {
            let _sequence = cursor.u32("header.seq")?;
        }
        let seconds = match encoding {
            Encoding::Ros1 => i64::from(cursor.u32("header.stamp")?),
            _ => i64::from(cursor.i32("header.stamp")?),
        };
        let stamp_ns = seconds * 1_000_000_000 + i64::from(cursor.u32("header.stamp")?);
        Ok(Self { stamp_ns, frame_id: cursor.text("header.frame_id")? })
    }
}
