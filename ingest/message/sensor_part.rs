//! Which part of its sensor a camera recorded, and how its CameraInfo's matrices become those of the images.
//!
//! K and P of a CameraInfo are those of the whole sensor, unbinned. A region of interest is a crop: principal points
//! move by its offset, focal lengths stay. Binning comes after it and scales both. Drivers err: what a principal point
//! in the middle settles is read as it must be meant, and noted; what it does not settle is refused.

use super::camera_info::CameraInfo;
use super::sensor_told::{PartCalibration, Told};
use furrow_model::CameraCalibration;

/// The part of the sensor that a camera records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensorPart {
    /// Pixels that become one, by columns and rows; 0 means 1.
    pub binning: [u32; 2],
    /// Columns left of the part, and rows above it.
    pub offset: [u32; 2],
    /// Columns and rows of the part, unbinned; all zero means the whole sensor.
    pub size: [u32; 2],
}

impl SensorPart {
    /// What a CameraInfo tells.
    pub fn of(info: &CameraInfo<'_>) -> Self {
        let [x, y, rows, columns] = info.region;
        Self { binning: info.binning, offset: [x, y], size: [columns, rows] }
    }

    /// The calibration of the images of `image` columns and rows that show this part of a `sensor`.
    ///
    /// # Errors
    /// A part that is not inside the sensor, or whose size the images do not have; what was found, and what was
    /// expected.
    pub fn calibration(&self, sensor: &CameraCalibration, image: [u32; 2]) -> Result<PartCalibration, String> {
        let [w, h] = image;
        if w == 0 || h == 0 {
            return Err("the images are empty".to_owned());
        }
        let mut told = Told { sensor: sensor.clone(), binning: self.binning.map(|binning| binning.max(1)), image };
        let note = told.take_size(self.is_whole_unsized());
        let [width, height] = told.size();
        let region = match (self.size, self.offset) {
            ([0, 0], [0, 0]) => None,
            ([columns, rows], [0, 0]) if [columns, rows] == [width, height] => None,
            ([columns, rows], [x, y]) => {
                let inside = |offset: u32, size: u32, whole: u32| {
                    size > 0 && (whole == 0 || u64::from(offset) + u64::from(size) <= u64::from(whole))
                };
                if !inside(x, columns, width) || !inside(y, rows, height) {
                    return Err(format!(
                        "its region of interest of {columns} x {rows} pixels at ({x}, {y}) is no part of its sensor of \
                         {width} x {height}: width and height of a CameraInfo are the whole sensor's"
                    ));
                }
                Some([x, y, columns, rows])
            }
        };
        let part = match region {
            None => told.whole()?,
            Some(region) => told.cropped(region)?,
        };
        Ok(PartCalibration { note: part.note.or(note), ..part })
    }

    fn is_whole_unsized(&self) -> bool {
        self.size == [0, 0] && self.offset == [0, 0]
    }
}
