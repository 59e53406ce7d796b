//! What other sensors say about motion and place.

use super::cursor::{Cursor, MessageError};
use super::header::Header;
use crate::recording::Encoding;

/// `sensor_msgs/Imu`.
#[derive(Debug, Clone, PartialEq)]
pub struct Imu<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// Orientation as a quaternion x, y, z, w.
    pub orientation_xyzw: [f64; 4],
    /// 3x3 by rows, rad^2; a first value of -1 means that there is no orientation.
    pub orientation_covariance: [f64; 9],
    /// Turn rates about x, y, z.
    pub angular_velocity_rad_s: [f64; 3],
    /// 3x3 by rows.
    pub angular_velocity_covariance: [f64; 9],
    /// Accelerations along x, y, z.
    pub linear_acceleration_m_s2: [f64; 3],
    /// 3x3 by rows.
    pub linear_acceleration_covariance: [f64; 9],
}

impl<'a> Imu<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "sensor_msgs/Imu";

    /// Decodes a message.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        Ok(Self {
            header: Header::read(&mut cursor, encoding)?,
            orientation_xyzw: cursor.f64s("orientation")?,
            orientation_covariance: cursor.f64s("orientation_covariance")?,
            angular_velocity_rad_s: cursor.f64s("angular_velocity")?,
            angular_velocity_covariance: cursor.f64s("angular_velocity_covariance")?,
            linear_acceleration_m_s2: cursor.f64s("linear_acceleration")?,
            linear_acceleration_covariance: cursor.f64s("linear_acceleration_covariance")?,
        })
    }
}

/// `sensor_msgs/NavSatFix`.
#[derive(Debug, Clone, PartialEq)]
pub struct NavSatFix<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// -1 no fix, 0 fix, 1 satellite-based, 2 ground-based augmentation.
    pub status: i8,
    /// The satellite systems used, as bits.
    pub service: u16,
    /// Latitude, WGS 84, positive north.
    pub latitude_deg: f64,
    /// Longitude, WGS 84, positive east.
    pub longitude_deg: f64,
    /// Altitude above the ellipsoid; NaN where there is none.
    pub altitude_m: f64,
    /// East, north, up: 3x3 by rows, m^2.
    pub position_covariance_m2: [f64; 9],
    /// 0 unknown, 1 approximated, 2 diagonal known, 3 known.
    pub position_covariance_type: u8,
}

impl<'a> NavSatFix<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "sensor_msgs/NavSatFix";

    /// Decodes a message.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        Ok(Self {
            header: Header::read(&mut cursor, encoding)?,
            status: cursor.i8("status.status")?,
            service: cursor.u16("status.service")?,
            latitude_deg: cursor.f64("latitude")?,
            longitude_deg: cursor.f64("longitude")?,
            altitude_m: cursor.f64("altitude")?,
            position_covariance_m2: cursor.f64s("position_covariance")?,
            position_covariance_type: cursor.u8("position_covariance_type")?,
        })
    }
}

/// `nav_msgs/Odometry`: the pose of `child_frame_id` in the header's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Odometry<'a> {
    /// When and in which frame.
    pub header: Header<'a>,
    /// The moving frame.
    pub child_frame_id: &'a str,
    /// Position, metres.
    pub position_m: [f64; 3],
    /// Orientation as a quaternion x, y, z, w.
    pub orientation_xyzw: [f64; 4],
    /// 6x6 by rows: x, y, z, then turns about x, y, z.
    pub pose_covariance: [f64; 36],
    /// Velocity in the moving frame.
    pub linear_velocity_m_s: [f64; 3],
    /// Turn rate in the moving frame.
    pub angular_velocity_rad_s: [f64; 3],
    /// 6x6 by rows.
    pub twist_covariance: [f64; 36],
}

impl<'a> Odometry<'a> {
    /// The message's type.
    pub const TYPE: &'static str = "nav_msgs/Odometry";

    /// Decodes a message.
    pub fn decode(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let mut cursor = Cursor::new(Self::TYPE, encoding, bytes)?;
        Ok(Self {
            header: Header::read(&mut cursor, encoding)?,
            child_frame_id: cursor.text("child_frame_id")?,
            position_m: cursor.f64s("pose.position")?,
            orientation_xyzw: cursor.f64s("pose.orientation")?,
            pose_covariance: cursor.f64s("pose.covariance")?,
            linear_velocity_m_s: cursor.f64s("twist.linear")?,
            angular_velocity_rad_s: cursor.f64s("twist.angular")?,
            twist_covariance: cursor.f64s("twist.covariance")?,
        })
    }
}
