//! The header that stamped messages begin with.

use super::cursor::{Cursor, MessageError};
use crate::recording::Encoding;

/// `std_msgs/Header`: when and in which frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header<'a> {
    /// The moment of capture, nanoseconds since 1970: frames are paired and named by it.
    pub stamp_ns: i64,
    /// The coordinate frame's name.
    pub frame_id: &'a str,
}

impl<'a> Header<'a> {
    /// Decodes the header that a stamped message begins with, whatever follows.
    pub(crate) fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        Self::read(&mut Cursor::new("std_msgs/Header", encoding, bytes)?, encoding)
    }

    /// Reads a header. ROS1's has a sequence number before the stamp.
    pub(super) fn read(cursor: &mut Cursor<'a>, encoding: Encoding) -> Result<Self, MessageError> {
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
