//! The keys of a profile that tell of cameras, true poses and other sensors.

use super::profile_unit::{Unit, first};
use serde::Deserialize;

/// What the cameras are.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationPart {
    /// Files in any form that `--calibration` takes; all of them are needed.
    #[serde(default)]
    pub files: Vec<String>,
    /// So many folders above the dataset's are looked into as well.
    #[serde(default)]
    pub above: u8,
    /// The cameras of a KITTI text, left and right.
    pub kitti_cameras: Option<[u8; 2]>,
    /// Whether the images are rectified already.
    #[serde(default)]
    pub rectified: bool,
    /// The calibration itself, in any form that a file may have.
    pub text: Option<String>,
    /// A file that begins with `fx fy cx cy` of rectified images; with `baseline_m` for a pair.
    #[serde(default)]
    pub pinhole: Vec<String>,
    /// The distance of the two cameras, metres, where `pinhole` tells the rest.
    pub baseline_m: Option<f64>,
}

/// True poses, in one of three forms: `rows`, `matrices` or `place_names`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TruthPart {
    /// The file, or files of one row each; `{name}` stands for the name of the dataset's folder.
    #[serde(default)]
    pub files: Vec<String>,
    /// So many folders above the dataset's are looked into as well.
    #[serde(default)]
    pub above: u8,
    /// Rows of columns. A column is a number from 1, or a name in the file's header; `-` before it turns its sign.
    pub rows: Option<Box<RowsPart>>,
    /// KITTI's poses: line i has the 3x4 matrix of the image with number i, in the frame of the first camera.
    #[serde(default)]
    pub matrices: bool,
    /// `UTM_east` and `UTM_north` of the images' own names, as sets for place recognition have them.
    #[serde(default)]
    pub place_names: bool,
}

/// Rows of poses.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RowsPart {
    /// The stamps' unit.
    pub unit: Unit,
    /// The column of the stamp.
    #[serde(default = "first")]
    pub stamp: String,
    /// The column of nanoseconds beside one of whole seconds.
    pub nanoseconds: Option<String>,
    /// A file whose line i has the stamp of row i, in place of a column.
    #[serde(default)]
    pub lines: Vec<String>,
    /// Columns of x, y, z in a world with z up, metres.
    pub position: Option<[String; 3]>,
    /// Columns of latitude and longitude in degrees and altitude in metres, in place of `position`.
    pub geodetic: Option<[String; 3]>,
    /// Columns of the quaternion x, y, z, w.
    pub quaternion_xyzw: Option<[String; 4]>,
    /// Columns of roll, pitch, yaw in radians, in place of a quaternion.
    pub roll_pitch_yaw: Option<[String; 3]>,
    /// What roll, pitch and yaw turn.
    #[serde(default)]
    pub axes: Axes,
    /// The left camera on the body whose poses these are: 4x4 by rows, metres. Without it and without
    /// `body_from_left_file`, the poses are the left camera's; roll, pitch and yaw are those of a body whose forward
    /// axis it looks along.
    pub body_from_left: Option<Vec<f64>>,
    /// EuRoC's `sensor.yaml` (`T_BS`) or Kalibr's camchain (`T_cam_imu`) that tells the same.
    #[serde(default)]
    pub body_from_left_file: Vec<String>,
    /// KITTI's texts with `R` and `T` that lead from body to camera, the last step first; used where all are there, in
    /// this folder or so many above it as the truth's file may lie.
    #[serde(default)]
    pub left_from_body_files: Vec<String>,
}

/// Axes of a body and of its world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axes {
    /// World east, north, up; body forward, left, up.
    #[default]
    Enu,
    /// World north, east, down; body forward, right, down.
    Ned,
}

/// A table of another sensor.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorPart {
    /// What the table is called.
    pub name: String,
    /// The file, or files of one row each.
    pub files: Vec<String>,
    /// The stamps' unit.
    pub unit: Unit,
    /// The column of the stamp.
    #[serde(default = "first")]
    pub stamp: String,
    /// A file whose line i has the stamp of row i, in place of a column.
    #[serde(default)]
    pub lines: Vec<String>,
    /// Columns of turn rates x, y, z, rad/s, then accelerations x, y, z, m/s².
    pub imu: Option<[String; 6]>,
    /// Columns of latitude and longitude in degrees and altitude in metres.
    pub fix: Option<[String; 3]>,
}
