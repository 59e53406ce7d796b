//! What a CameraInfo with a region of interest tells, held against the images that are there.

use super::sensor_told::{CENTRAL, PartCalibration, SURELY_CENTRAL, Told};

impl Told {
    /// Images of a region (x, y, columns, rows).
    pub(super) fn cropped(&self, [x, y, columns, rows]: [u32; 4]) -> Result<PartCalibration, String> {
        let ([w, h], [width, height], [bx, by]) = (self.image, self.size(), self.binning);
        let knows_sensor = width > 0 && height > 0;
        let is_central = !knows_sensor || self.is_of([width, height], CENTRAL);
        if !self.is_binned([columns, rows]) {
            if knows_sensor && is_central && [w, h] == [width, height] {
                let note = format!(
                    "CameraInfo tells a region of interest of {columns} x {rows}, but the images are of the whole sensor, \
                     {w} x {h}: they were taken so"
                );
                return Ok(PartCalibration { is_central, ..self.by([w, h], [0, 0], Some(note)) });
            }
            return Err(format!(
                "its region of interest of {columns} x {rows} pixels with a binning of {bx} x {by} gives images of {} x {}, \
                 found {w} x {h}",
                columns / bx,
                rows / by
            ));
        }
        self.same_binning()?;
        let unbinned = self.unbinned().ok_or("the image size times the binning is no size")?;
        if !is_central && (self.is_of([w, h], SURELY_CENTRAL) || self.is_of(unbinned, SURELY_CENTRAL)) {
            let k = &self.sensor.intrinsics;
            return Err(format!(
                "its K has the principal point ({:.1}, {:.1}), far from the middle of its sensor of {width} x {height} and in \
                 the middle of the images: K must be the whole sensor's where there is a region of interest at ({x}, {y})",
                k[2], k[5]
            ));
        }
        Ok(PartCalibration { is_central, ..self.by(unbinned, [x, y], None) })
    }
}
