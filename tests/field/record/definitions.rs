//! The definitions of the message types, for readers that decode by them. The MD5 sums are those of ROS 1.

/// A message type.
#[derive(Debug, PartialEq, Eq)]
pub struct Definition {
    /// Package.
    pub package: &'static str,
    /// Name in the package.
    pub name: &'static str,
    /// MD5 sum of the ROS 1 definition.
    pub md5: &'static str,
    fields: &'static str,
    uses: &'static [(&'static str, &'static str)],
}

const VECTOR3: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: (&str, &str) = ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
const REGION: (&str, &str) = (
    "sensor_msgs/RegionOfInterest",
    "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n",
);
const STATUS: (&str, &str) = (
    "sensor_msgs/NavSatStatus",
    "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nint8 status\n\
     uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\n\
     uint16 service\n",
);

/// `sensor_msgs/Image`.
pub const IMAGE: Definition = Definition {
    package: "sensor_msgs",
    name: "Image",
    md5: "060021388200f6f0f447d0fcd9c64743",
    fields: "uint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n",
    uses: &[],
};

/// `sensor_msgs/CameraInfo`; ROS 2 writes the matrices' names small.
pub const CAMERA_INFO: Definition = Definition {
    package: "sensor_msgs",
    name: "CameraInfo",
    md5: "c9a58c1b0b154e0e6da7578cb991d214",
    fields: "uint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] K\nfloat64[9] R\n\
             float64[12] P\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
    uses: &[REGION],
};

/// `sensor_msgs/Imu`.
pub const IMU: Definition = Definition {
    package: "sensor_msgs",
    name: "Imu",
    md5: "6a62c6daae103f4ff57a132d6f95cec2",
    fields: "geometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
             geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
             geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    uses: &[QUATERNION, VECTOR3],
};

/// `sensor_msgs/NavSatFix`.
pub const NAV_SAT_FIX: Definition = Definition {
    package: "sensor_msgs",
    name: "NavSatFix",
    md5: "2d3a8cd499b9b4a0249fb98fd05cfa48",
    fields: "sensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n\
             float64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n\
             uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n",
    uses: &[STATUS],
};

const RULE: &str = "================================================================================\n";

impl Definition {
    /// The type's ROS 1 name.
    pub fn ros1_type(&self) -> String {
        format!("{}/{}", self.package, self.name)
    }

    /// The type's ROS 2 name.
    pub fn ros2_type(&self) -> String {
        format!("{}/msg/{}", self.package, self.name)
    }

    /// The ROS 1 definition with all that it uses.
    pub fn ros1_text(&self) -> String {
        let head = ("std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n");
        self.text("std_msgs/Header header\n", self.fields.to_owned(), &[&[head], self.uses].concat())
    }

    /// The ROS 2 definition with all that it uses.
    pub fn ros2_text(&self) -> String {
        let head = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
        let time = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
        let fields = ["D", "K", "R", "P"].iter().fold(self.fields.to_owned(), |fields, letter| {
            fields.replace(&format!("] {letter}\n"), &format!("] {}\n", letter.to_lowercase()))
        });
        self.text("std_msgs/Header header\n", fields, &[&[head, time], self.uses].concat())
    }

    fn text(&self, head: &str, fields: String, uses: &[(&str, &str)]) -> String {
        uses.iter().fold(format!("{head}{fields}"), |text, (name, fields)| format!("{text}{RULE}MSG: {name}\n{fields}"))
    }
}
