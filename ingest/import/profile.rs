//! The keys of a profile. Every path is below the dataset's folder, with `/` between its parts; a `*` may stand in the
//! last part. Where a key takes a list of files, the first that is there counts.

pub use super::profile_unit::Unit;
pub use super::profile_world::{Axes, CalibrationPart, RowsPart, SensorPart, TruthPart};

use super::profile_unit::{first, second};
use furrow_catalog::images::BayerPattern;
use serde::Deserialize;

/// A profile: how a dataset is laid out.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// One line that says which datasets it is for.
    pub title: String,
    /// Where the layout is documented.
    #[serde(default)]
    pub documentation: String,
    /// What could not be confirmed by the documentation, a sentence each.
    #[serde(default)]
    pub unconfirmed: Vec<String>,
    /// Folders below the given one in which the layout may begin; the first that has the left images counts. `.` is the
    /// given one itself, and the default.
    #[serde(default)]
    pub within: Vec<String>,
    /// Loose images.
    pub images: Option<ImagesPart>,
    /// Bags, in place of loose images.
    pub recording: Option<RecordingPart>,
    /// The cameras.
    pub calibration: Option<CalibrationPart>,
    /// True poses.
    pub truth: Option<TruthPart>,
    /// Other sensors beside loose images.
    #[serde(default)]
    pub sensors: Vec<SensorPart>,
}

/// Loose images of a pair, or of a single camera, which counts as the left one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImagesPart {
    /// The left or only camera's.
    pub left: SidePart,
    /// The right camera's.
    pub right: Option<SidePart>,
}

/// The images of one camera.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SidePart {
    /// The images, as in `cam0/data/*.png`.
    pub files: Vec<String>,
    /// When they were taken.
    pub stamps: StampsPart,
    /// The mosaic that grey image files hold.
    pub bayer: Option<BayerPattern>,
    /// A file of doubles that says where each undistorted pixel comes from: all columns, then all rows.
    #[serde(default)]
    pub lookup_table: Vec<String>,
}

/// Where stamps stand.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "from", rename_all = "snake_case", deny_unknown_fields)]
pub enum StampsPart {
    /// In the files' names.
    Names {
        /// Their unit.
        #[serde(default)]
        unit: Unit,
    },
    /// In a list: a line for each image, with its stamp and its file's name. Images that are not listed are left out.
    List {
        /// The list.
        files: Vec<String>,
        /// The stamps' unit.
        unit: Unit,
        /// The column of the stamp.
        #[serde(default = "first")]
        stamp: String,
        /// The column of the name.
        #[serde(default = "second")]
        name: String,
    },
    /// In a file whose line i, from 0, tells when the image with number i was taken.
    Lines {
        /// The file.
        files: Vec<String>,
        /// The stamps' unit.
        unit: Unit,
    },
    /// Nowhere: images in the order of their names were taken at this rate, from 0.
    Rate {
        /// Images a second.
        hertz: f64,
    },
    /// In the field `timestamp` of names as sets for place recognition have them; else a second apart.
    PlaceNames,
}

/// Bags that are read as one recording.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordingPart {
    /// The bags with the images: all files that the first pattern with any names.
    pub files: Vec<String>,
    /// Bags of other sensors, taken along where they are there; all patterns count.
    #[serde(default)]
    pub beside: Vec<String>,
    /// The topic of the left images.
    pub left: Option<String>,
    /// The topic of the right images.
    pub right: Option<String>,
    /// The topic of the left camera's CameraInfo.
    pub left_info: Option<String>,
    /// The topic of the right camera's CameraInfo.
    pub right_info: Option<String>,
}
