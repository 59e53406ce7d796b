//! The messages of a ZED-like robot: images, calibrations, IMU, GPS.

use super::definitions::{self, Definition};
use super::wire::{Layout, Wire};
use furrow_model::CameraCalibration;

/// The streams, in the order of their numbers in the containers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// Left image.
    LeftImage,
    /// Right image.
    RightImage,
    /// Left calibration.
    LeftInfo,
    /// Right calibration.
    RightInfo,
    /// Inertial measurements.
    Imu,
    /// Satellite fixes.
    Gps,
}

impl Topic {
    /// All streams.
    pub const ALL: [Topic; 6] =
        [Topic::LeftImage, Topic::RightImage, Topic::LeftInfo, Topic::RightInfo, Topic::Imu, Topic::Gps];

    /// Its number.
    pub fn number(self) -> usize {
        self as usize
    }

    /// Its name, as the ZED wrapper gives it, for `distorted` (raw) or rectified images.
    pub fn name(self, distorted: bool) -> &'static str {
        match (self, distorted) {
            (Topic::LeftImage, false) => "/zed2i/zed_node/left/image_rect_color",
            (Topic::RightImage, false) => "/zed2i/zed_node/right/image_rect_color",
            (Topic::LeftInfo, false) => "/zed2i/zed_node/left/camera_info",
            (Topic::RightInfo, false) => "/zed2i/zed_node/right/camera_info",
            (Topic::LeftImage, true) => "/zed2i/zed_node/left_raw/image_raw_color",
            (Topic::RightImage, true) => "/zed2i/zed_node/right_raw/image_raw_color",
            (Topic::LeftInfo, true) => "/zed2i/zed_node/left_raw/camera_info",
            (Topic::RightInfo, true) => "/zed2i/zed_node/right_raw/camera_info",
            (Topic::Imu, _) => "/imu/data",
            (Topic::Gps, _) => "/gps/fix",
        }
    }

    /// The type of its messages.
    pub fn definition(self) -> &'static Definition {
        match self {
            Topic::LeftImage | Topic::RightImage => &definitions::IMAGE,
            Topic::LeftInfo | Topic::RightInfo => &definitions::CAMERA_INFO,
            Topic::Imu => &definitions::IMU,
            Topic::Gps => &definitions::NAV_SAT_FIX,
        }
    }
}

/// One message.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Its stream.
    pub topic: Topic,
    /// Number within the stream, from 0.
    pub sequence: u32,
    /// Header stamp: nanoseconds since 1970, UTC.
    pub stamp_ns: i64,
    /// What it says.
    pub body: Body,
}

/// What a message says.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// `sensor_msgs/Image`, bgr8.
    Image {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Blue green red, row by row.
        pixels: Vec<u8>,
    },
    /// `sensor_msgs/CameraInfo`, plumb_bob.
    CameraInfo(Box<CameraCalibration>),
    /// `sensor_msgs/Imu`: x forward, y left, z up; no orientation.
    Imu {
        /// rad/s.
        turn_rate: [f64; 3],
        /// m/s^2, gravity included.
        acceleration: [f64; 3],
        /// Variances of the two.
        variances: [f64; 2],
    },
    /// `sensor_msgs/NavSatFix`.
    Fix {
        /// Degrees north, degrees east, metres.
        position: [f64; 3],
        /// Variances east, north, up in m^2.
        variances_m2: [f64; 3],
    },
}

impl Message {
    /// The bytes of the message.
    pub fn encode(&self, layout: Layout) -> Vec<u8> {
        let mut wire = Wire::new(layout);
        self.header(&mut wire);
        match &self.body {
            Body::Image { width, height, pixels } => {
                wire.u32(*height);
                wire.u32(*width);
                wire.string("bgr8");
                wire.u8(0);
                wire.u32(3 * width);
                wire.bytes(pixels);
            }
            Body::CameraInfo(calibration) => camera_info(&mut wire, calibration),
            Body::Imu { turn_rate, acceleration, variances } => {
                // A first covariance of -1 says that there is no orientation.
                wire.f64s(&[0.0, 0.0, 0.0, 1.0]);
                wire.f64s(&[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
                wire.f64s(turn_rate);
                wire.f64s(&diagonal([variances[0]; 3]));
                wire.f64s(acceleration);
                wire.f64s(&diagonal([variances[1]; 3]));
            }
            Body::Fix { position, variances_m2 } => {
                // Status: a fix; service: GPS; covariance type: diagonal known.
                wire.u8(0);
                wire.u16(1);
                wire.f64s(position);
                wire.f64s(&diagonal(*variances_m2));
                wire.u8(2);
            }
        }
        wire.finish()
    }

    fn header(&self, wire: &mut Wire) {
        if wire.layout() == Layout::Ros1 {
            wire.u32(self.sequence);
        }
        wire.u32(self.stamp_ns.div_euclid(1_000_000_000) as u32);
        wire.u32(self.stamp_ns.rem_euclid(1_000_000_000) as u32);
        wire.string(match self.topic {
            Topic::LeftImage | Topic::LeftInfo => "zed2i_left_camera_optical_frame",
            Topic::RightImage | Topic::RightInfo => "zed2i_right_camera_optical_frame",
            Topic::Imu => "imu_link",
            Topic::Gps => "gps_link",
        });
    }
}

fn camera_info(wire: &mut Wire, calibration: &CameraCalibration) {
    wire.u32(calibration.height);
    wire.u32(calibration.width);
    wire.string("plumb_bob");
    wire.u32(calibration.coefficients.len() as u32);
    wire.f64s(&calibration.coefficients);
    wire.f64s(&calibration.intrinsics);
    wire.f64s(&calibration.rectification);
    wire.f64s(&calibration.projection);
    // No binning, no region of interest.
    (0..6).for_each(|_| wire.u32(0));
    wire.u8(0);
}

fn diagonal([a, b, c]: [f64; 3]) -> [f64; 9] {
    [a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c]
}
