//! What a CameraInfo tells, held against the images that are there: of the whole sensor, binned or not.

use furrow_catalog::images::calibration::check::centre_shares;
use furrow_model::CameraCalibration;

/// A principal point that is this far from the edges, as a share of the width and of the height, is one of that image.
pub(super) const CENTRAL: std::ops::RangeInclusive<f64> = 0.3..=0.7;
/// What a principal point must be of another image than the sensor's, to be taken for that one's.
pub(super) const SURELY_CENTRAL: std::ops::RangeInclusive<f64> = 0.4..=0.6;

/// A calibration that fits its images up to a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct PartCalibration {
    /// Size, K and P of the part, unbinned: the size is a whole multiple of the images' where the part is certain.
    pub calibration: CameraCalibration,
    /// Columns and rows by which K and P were shifted.
    pub offset: [u32; 2],
    /// Whether the principal point was looked at, and found where it should be.
    pub is_central: bool,
    /// What was taken to be meant, where CameraInfo says otherwise.
    pub note: Option<String>,
}

/// What a CameraInfo tells, beside the images that are there.
pub(super) struct Told {
    /// The sensor.
    pub(super) sensor: CameraCalibration,
    /// Pixels that become one, at least 1.
    pub(super) binning: [u32; 2],
    /// Columns and rows of the images.
    pub(super) image: [u32; 2],
}

impl Told {
    /// Columns and rows of the sensor; 0 where they are not known.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.sensor.width, self.sensor.height]
    }

    /// Fills in a size that is not told, and turns one whose columns and rows are exchanged.
    pub(super) fn take_size(&mut self, is_whole: bool) -> Option<String> {
        let [w, h] = self.image;
        if self.sensor.width == 0 || self.sensor.height == 0 {
            // Without a region, the whole sensor is what the images show, times the binning.
            let by = |pixels: u32, binning: u32| if is_whole { pixels.saturating_mul(binning) } else { 0 };
            self.sensor.width = by(w, self.binning[0]);
            self.sensor.height = by(h, self.binning[1]);
            return Some(format!("CameraInfo tells no image size: that of the images, {w} x {h}, was taken"));
        }
        let exchanged = self.size() == [h, w] && w != h && is_whole && self.binning == [1, 1];
        if exchanged && self.is_of([w, h], SURELY_CENTRAL) {
            let told = self.size();
            [self.sensor.width, self.sensor.height] = [w, h];
            return Some(format!(
                "CameraInfo tells a size of {} x {}, the images are {w} x {h}, and the principal point is in the middle of \
                 theirs: rows and columns were taken to be exchanged",
                told[0], told[1]
            ));
        }
        None
    }

    /// Whether K's principal point is in the middle of an image of this size.
    pub(super) fn is_of(&self, size: [u32; 2], middle: std::ops::RangeInclusive<f64>) -> bool {
        centre_shares(&self.sensor.intrinsics, size).iter().all(|share| middle.contains(share))
    }

    /// The image's size times the binning; `None` where that is no size.
    pub(super) fn unbinned(&self) -> Option<[u32; 2]> {
        Some([self.image[0].checked_mul(self.binning[0])?, self.image[1].checked_mul(self.binning[1])?])
    }

    /// Whether the images have the size of `part` after binning, rounded down or up.
    pub(super) fn is_binned(&self, part: [u32; 2]) -> bool {
        (0..2).all(|i| {
            let (whole, binning) = (part[i], self.binning[i]);
            self.image[i] == whole / binning || self.image[i] == whole.div_ceil(binning)
        })
    }

    /// The sensor cut to `size` at `offset`.
    pub(super) fn by(&self, size: [u32; 2], offset: [u32; 2], note: Option<String>) -> PartCalibration {
        let mut calibration = self.sensor.clone();
        [calibration.width, calibration.height] = size;
        let [x, y] = offset.map(f64::from);
        calibration.intrinsics[2] -= x;
        calibration.intrinsics[5] -= y;
        calibration.projection[2] -= x;
        calibration.projection[6] -= y;
        PartCalibration { calibration, offset, is_central: false, note }
    }

    /// Images of the whole sensor, binned or not.
    pub(super) fn whole(&self) -> Result<PartCalibration, String> {
        let ([w, h], [width, height], [bx, by]) = (self.image, self.size(), self.binning);
        let is_central = self.is_of([width, height], CENTRAL);
        let part = |size, note| Ok(PartCalibration { is_central, ..self.by(size, [0, 0], note) });
        if [bx, by] == [1, 1] {
            let note = ([w, h] != [width, height]).then(|| {
                format!(
                    "the images are {w} x {h}, CameraInfo is for {width} x {height} and tells no binning and no region of \
                     interest: they were taken as scaled, not cut; if they are cut, give their calibration with \
                     --calibration"
                )
            });
            return part([width, height], note);
        }
        if [w, h] != [width, height] && self.is_binned([width, height]) {
            let unbinned = self.unbinned().ok_or("the image size times the binning is no size")?;
            self.same_binning()?;
            // K of the binned image under the sensor's size: by the convention it would be far from the middle.
            if !is_central && self.is_of([w, h], SURELY_CENTRAL) {
                return Ok(PartCalibration { is_central: true, ..self.by([w, h], [0, 0], Some(self.k_of_binned())) });
            }
            return part(unbinned, None);
        }
        if [w, h] == [width, height] {
            if is_central {
                let note = format!(
                    "CameraInfo tells a binning of {bx} x {by}, but the images have its full size of {w} x {h} and K's \
                     principal point is in their middle: they were taken as they are"
                );
                return part([w, h], Some(note));
            }
            let unbinned = self.unbinned().ok_or("the image size times the binning is no size")?;
            if bx == by && self.is_of(unbinned, SURELY_CENTRAL) {
                let note = format!(
                    "CameraInfo tells the binned size of {w} x {h}, and K's principal point is in the middle of {} x {}: \
                     K was taken as the unbinned sensor's",
                    unbinned[0], unbinned[1]
                );
                return Ok(PartCalibration { is_central: true, ..self.by(unbinned, [0, 0], Some(note)) });
            }
            return Err(format!(
                "it tells a binning of {bx} x {by}, but the images have its full size of {w} x {h}, and K's principal point \
                 is in the middle of neither"
            ));
        }
        let note = format!(
            "the images are {w} x {h}, but a binning of {bx} x {by} of {width} x {height} tells otherwise: they were taken as \
             scaled"
        );
        part([width, height], Some(note))
    }

    /// Refuses pixels that are not square.
    pub(super) fn same_binning(&self) -> Result<(), String> {
        let [bx, by] = self.binning;
        if bx == by {
            return Ok(());
        }
        Err(format!("its binning of {bx} x {by} leaves pixels that are not square: expected equal numbers"))
    }

    fn k_of_binned(&self) -> String {
        let ([w, h], [width, height], [bx, by]) = (self.image, self.size(), self.binning);
        let k = &self.sensor.intrinsics;
        format!(
            "CameraInfo tells {width} x {height} and a binning of {bx} x {by}, but K's principal point ({:.1}, {:.1}) is only \
             {:.2} of the width in, and in the middle of the images of {w} x {h}: K and P were taken as those of the binned \
             images",
            k[2],
            k[5],
            (k[2] + 0.5) / f64::from(width.max(1))
        )
    }
}
