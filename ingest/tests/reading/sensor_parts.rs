//! Regions of interest and binning, by points projected through the sensor, the crop and the bin.

use furrow_catalog::images::calibration::stereo::fit_to_image;
use furrow_ingest::message::SensorPart;
use furrow_model::{CameraCalibration, Distortion};
use proptest::prelude::*;

/// A sensor, and a region of it that is read out.
#[derive(Debug, Clone)]
struct Readout {
    width: u32,
    height: u32,
    focal: f64,
    centre: [f64; 2],
    /// x, y, columns, rows.
    region: [u32; 4],
    binning: u32,
}

impl Readout {
    fn image(&self) -> [u32; 2] {
        [self.region[2] / self.binning, self.region[3] / self.binning]
    }

    /// Where the image shows a ray: the sensor's pixel, less the offset, in blocks of `binning` pixels.
    fn shows(&self, ray: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| {
            let on_sensor = self.focal * ray[i] + self.centre[i];
            (on_sensor - f64::from(self.region[i]) + 0.5) / f64::from(self.binning) - 0.5
        })
    }

    fn is_whole(&self) -> bool {
        self.region == [0, 0, self.width, self.height]
    }

    /// K and P for a size, at `scale` of the sensor's resolution and without `offset`.
    fn calibration(&self, [width, height]: [u32; 2], scale: f64, offset: [f64; 2]) -> CameraCalibration {
        let focal = self.focal * scale;
        let [cx, cy] = [0, 1].map(|i| (self.centre[i] - offset[i] + 0.5) * scale - 0.5);
        CameraCalibration {
            width,
            height,
            distortion: Distortion::RadialTangential,
            coefficients: Vec::new(),
            intrinsics: [focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0],
            rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            projection: [focal, 0.0, cx, -0.12 * focal, 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        }
    }

    fn part(&self) -> SensorPart {
        let [x, y, columns, rows] = self.region;
        SensorPart { binning: [self.binning; 2], offset: [x, y], size: [columns, rows] }
    }

    /// What the calibration of the images would show; `None` where it was refused.
    fn read(&self, told: &CameraCalibration, part: SensorPart) -> Option<CameraCalibration> {
        let [w, h] = self.image();
        let part = part.calibration(told, [w, h]).ok()?;
        Some(fit_to_image(&part.calibration, w, h).expect("a part fits its images"))
    }

    /// Whether a calibration shows the rays of the four corners where the image does.
    fn is_true(&self, read: &CameraCalibration) -> bool {
        let (k, p) = (&read.intrinsics, &read.projection);
        let baseline = -p[3] / p[0];
        [[-0.3, 0.2], [0.4, -0.1], [0.0, 0.0], [0.25, 0.3]].into_iter().all(|ray| {
            let truth = self.shows(ray);
            let by_k = [k[0] * ray[0] + k[2], k[4] * ray[1] + k[5]];
            let by_p = [p[0] * ray[0] + p[2], p[5] * ray[1] + p[6]];
            let close = |found: [f64; 2]| (0..2).all(|i| (found[i] - truth[i]).abs() < 1e-6);
            close(by_k) && close(by_p) && (baseline - 0.12).abs() < 1e-12
        })
    }
}

prop_compose! {
    fn readouts()(
        (width, height) in (64_u32..3000, 64_u32..3000),
        focal in 60.0..2500.0,
        middle in prop::array::uniform2(0.45..0.55),
        corner in prop::array::uniform2(0.0..0.8),
        share in prop::array::uniform2(0.05..1.0),
        is_whole in any::<bool>(),
        binning in 1_u32..5,
    ) -> Readout {
        let sides = [width, height].map(f64::from);
        let offset = [0, 1].map(|i| if is_whole { 0 } else { (corner[i] * sides[i]) as u32 });
        let size = [0, 1].map(|i| {
            let left = [width, height][i] - offset[i];
            if is_whole { left } else { ((f64::from(left) * share[i]) as u32).max(binning) }
        });
        let centre = [0, 1].map(|i| middle[i] * sides[i] - 0.5);
        Readout { width, height, focal, centre, region: [offset[0], offset[1], size[0], size[1]], binning }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn any_region_and_binning_inside_the_sensor_is_read_as_it_is(readout in readouts()) {
        let told = readout.calibration([readout.width, readout.height], 1.0, [0.0; 2]);
        let read = readout.read(&told, readout.part()).expect("told by the convention");
        prop_assert!(readout.is_true(&read), "{read:?}");
    }

    /// Drivers that scale K, or tell the size of what they send: the truth or a refusal.
    #[test]
    fn what_a_driver_tells_otherwise_is_read_as_it_is_meant_or_refused(readout in readouts(), kind in 0..6) {
        let scale = 1.0 / f64::from(readout.binning);
        let [w, h] = readout.image();
        let whole = [readout.width, readout.height];
        let offset = [f64::from(readout.region[0]), f64::from(readout.region[1])];
        let nowhere = SensorPart { offset: [0; 2], size: [0; 2], ..readout.part() };
        let (told, part) = match kind {
            // K of the binned image under the sensor's size.
            0 if readout.is_whole() => (readout.calibration(whole, scale, offset), nowhere),
            // The image's own size and K, and still the binning.
            1 => (readout.calibration([w, h], scale, offset), nowhere),
            // The image's own size, and the sensor's K.
            2 if readout.is_whole() => (readout.calibration([w, h], 1.0, [0.0; 2]), nowhere),
            // No size at all.
            3 => (readout.calibration([0, 0], 1.0, [0.0; 2]), readout.part()),
            // The image's own K and size, and nothing of how it came about.
            4 => (readout.calibration([w, h], scale, offset), SensorPart { binning: [0; 2], ..nowhere }),
            // The size of the part, and where it lies.
            _ => (readout.calibration([w, h], scale, offset), readout.part()),
        };
        // A principal point that is not in the middle of what was told is noted, not known: only those are tried here
        // that a lens above its image has.
        let [cx, cy] = readout.shows([0.0, 0.0]);
        let is_above = (0.4..0.6).contains(&(cx / f64::from(w))) && (0.4..0.6).contains(&(cy / f64::from(h)));
        if let Some(read) = is_above.then(|| readout.read(&told, part)).flatten() {
            prop_assert!(readout.is_true(&read), "{kind}: {told:?} {part:?}: {read:?}");
        }
    }

    #[test]
    fn no_numbers_of_a_part_panic(
        numbers in prop::array::uniform6(prop_oneof![Just(0), 0_u32..5, 1_u32..4000, any::<u32>()]),
        size in prop::array::uniform2(prop_oneof![Just(0), 1_u32..4000, any::<u32>()]),
        image in prop::array::uniform2(prop_oneof![Just(0), 1_u32..4000, any::<u32>()]),
        centre in prop::array::uniform2(any::<f64>()),
    ) {
        let [bx, by, x, y, columns, rows] = numbers;
        let region = [0, 0, size[0], size[1]];
        let readout = Readout { width: size[0], height: size[1], focal: 500.0, centre, region, binning: 1 };
        let part = SensorPart { binning: [bx, by], offset: [x, y], size: [columns, rows] };
        let _ = part.calibration(&readout.calibration(size, 1.0, [0.0; 2]), image);
    }
}

#[test]
fn parts_that_contradict_the_sensor_or_the_images_are_refused() {
    let readout = Readout {
        width: 1226,
        height: 370,
        focal: 707.0,
        centre: [601.9, 183.1],
        region: [0, 0, 1226, 370],
        binning: 1,
    };
    let told = readout.calibration([1226, 370], 1.0, [0.0; 2]);
    let said = |binning, offset, size, image| {
        SensorPart { binning, offset, size }.calibration(&told, image).expect_err("refused")
    };
    assert!(said([1, 1], [700, 0], [613, 185], [613, 185]).contains("no part of its sensor of 1226 x 370"));
    assert!(said([0, 0], [10, 0], [0, 0], [1216, 370]).contains("no part of its sensor"));
    assert!(said([0, 0], [u32::MAX, 0], [u32::MAX, 1], [1, 1]).contains("no part of its sensor"));
    assert!(said([1, 1], [306, 92], [613, 185], [306, 92]).contains("gives images of 613 x 185, found 306 x 92"));
    assert!(said([2, 2], [306, 92], [613, 185], [613, 185]).contains("gives images of 306 x 92, found 613 x 185"));
    assert!(said([2, 1], [0, 0], [0, 0], [613, 370]).contains("not square"));
    let exchanged = readout.calibration([370, 1226], 1.0, [0.0; 2]);
    let whole = SensorPart { binning: [0; 2], offset: [0; 2], size: [0; 2] };
    let read = whole.calibration(&exchanged, [1226, 370]).unwrap();
    assert_eq!((read.calibration.width, read.calibration.height), (1226, 370));
    assert!(read.note.unwrap().contains("rows and columns"));
}
