//! Maps against OpenCV's own, rigs against arithmetic by hand.

use super::{bent_pair, rows, scene, straight_pair};
use crate::images::calibration::stereo::fit_to_image;
use crate::images::{CalibrationError, ColourImage, Rectifier, Side, StereoCalibration};
use furrow_model::{CameraCalibration, Distortion, GreyImage};
use opencv::core::{CV_32FC1, Mat, MatTraitConst, Size};

fn matrix(values: &[f64], columns: i32) -> Mat {
    let rows = values.len() as i32 / columns;
    Mat::new_rows_cols_with_data(rows, columns, values).unwrap().try_clone().unwrap()
}

/// OpenCV's maps (x, y) for a rectified size.
fn opencv_maps(camera: &CameraCalibration, width: u32, height: u32) -> (Mat, Mat) {
    let k = matrix(&camera.intrinsics, 3);
    let d = matrix(&camera.coefficients, 1);
    let r = matrix(&camera.rectification, 3);
    let p = matrix(&camera.projection, 4);
    let size = Size::new(width as i32, height as i32);
    let (mut x, mut y) = (Mat::default(), Mat::default());
    match camera.distortion {
        Distortion::RadialTangential => {
            opencv::calib3d::init_undistort_rectify_map(&k, &d, &r, &p, size, CV_32FC1, &mut x, &mut y).unwrap();
        }
        Distortion::Equidistant => {
            opencv::calib3d::fisheye_init_undistort_rectify_map(&k, &d, &r, &p, size, CV_32FC1, &mut x, &mut y)
                .unwrap();
        }
    }
    (x, y)
}

#[test]
fn maps_agree_with_opencv_for_every_lens_model() {
    let (left, right) = bent_pair();
    let rational =
        CameraCalibration { coefficients: vec![0.4, -0.2, 0.0004, -0.0003, 0.05, 0.7, -0.15, 0.02], ..left.clone() };
    let prism = [-0.2, 0.05, 1e-3, -5e-4, 0.01, 0.1, -0.02, 0.003, 2e-3, -1e-3, -3e-3, 5e-4];
    let twelve = CameraCalibration { coefficients: prism.to_vec(), ..left.clone() };
    let tilted = CameraCalibration { coefficients: [&prism[..], &[0.02, -0.03]].concat(), ..left.clone() };
    let four = CameraCalibration { coefficients: vec![-0.25, 0.06, 0.001, -0.002], ..left.clone() };
    let fisheye = CameraCalibration {
        distortion: Distortion::Equidistant,
        coefficients: vec![-0.01, 0.02, -0.015, 0.003],
        ..left.clone()
    };
    for camera in [left.clone(), right.clone(), rational, twelve, tilted, four, fisheye] {
        let pair = StereoCalibration {
            left: CameraCalibration { projection: left.projection, ..camera.clone() },
            right: CameraCalibration { projection: right.projection, ..camera.clone() },
            rectified_size: Some((330, 210)),
            stream_is_rectified: false,
        };
        let rectifier = Rectifier::from_record(&pair).unwrap();
        let (x, y) = opencv_maps(&pair.left, 330, 210);
        for (v, u) in (0..210).flat_map(|v| (0..330).map(move |u| (v, u))) {
            let [ours_x, ours_y] = rectifier.source_of(Side::Left, f64::from(u), f64::from(v)).unwrap();
            let theirs = [*x.at_2d::<f32>(v, u).unwrap(), *y.at_2d::<f32>(v, u).unwrap()].map(f64::from);
            // Single precision of a number below 512: half a unit is 1.5e-5.
            let error = (ours_x - theirs[0]).abs().max((ours_y - theirs[1]).abs());
            assert!(error < 5e-5, "{:?} at ({u}, {v}): {error}", camera.coefficients);
        }
    }
}

#[test]
fn rectified_streams_pass_unchanged() {
    let (left, right) = straight_pair();
    let rectifier = Rectifier::new(&left, &right).unwrap();
    assert!(rectifier.is_identity());
    let rig = rectifier.rig();
    assert_eq!((rig.width, rig.height, rig.focal_px, rig.cu_px, rig.cv_px), (64, 48, 60.0, 31.5, 23.5));
    assert!((rig.baseline_m - 0.12).abs() < 1e-12);
    let image = GreyImage::new(64, 48, rows(64, 48, 0, |x, y| [scene(x, y)[0]])).unwrap();
    assert_eq!(rectifier.rectify_grey(Side::Right, image.clone()).unwrap(), image);

    let (left, right) = bent_pair();
    assert!(!Rectifier::new(&left, &right).unwrap().is_identity());
    let trusted = Rectifier::for_rectified_topic(&left, &right).unwrap();
    assert!(trusted.is_identity());
    assert_eq!((trusted.rig().width, trusted.rig().height, trusted.rig().focal_px), (320, 200, 180.0));
    let cropped = StereoCalibration { rectified_size: Some((64, 48)), ..trusted.record().clone() };
    assert_eq!(Rectifier::from_record(&cropped).unwrap().rectify_grey(Side::Left, image.clone()).unwrap(), image);
}

#[test]
fn a_shifted_principal_point_shifts_pixels() {
    let (mut left, mut right) = straight_pair();
    for camera in [&mut left, &mut right] {
        camera.projection[2] -= 10.0;
        camera.projection[6] -= 6.0;
    }
    let rectifier = Rectifier::new(&left, &right).unwrap();
    let rig = rectifier.rig();
    assert_eq!((rig.width, rig.height), (52, 40), "what is seen is 54 x 42; sizes step by 4");
    let image = ColourImage { width: 64, height: 48, rgb: rows(64, 48, 0, scene) };
    let moved = rectifier.rectify_colour(Side::Left, &image).unwrap();
    assert_eq!(moved.rgb, rows(52, 40, 0, |x, y| scene(x + 10, y + 6)));
    let grey = GreyImage::new(64, 48, rows(64, 48, 0, |x, y| [scene(x, y)[2]])).unwrap();
    let moved = rectifier.rectify_grey(Side::Right, grey.clone()).unwrap();
    assert_eq!(moved.pixels, rows(52, 40, 0, |x, y| [scene(x + 10, y + 6)[2]]));
}

#[test]
fn the_chosen_size_shows_no_border() {
    let (left, right) = bent_pair();
    let rectifier = Rectifier::new(&left, &right).unwrap();
    let (width, height) = (rectifier.rig().width, rectifier.rig().height);
    let white = GreyImage::new(320, 200, vec![255; 64_000]).unwrap();
    for side in [Side::Left, Side::Right] {
        let seen = rectifier.rectify_grey(side, white.clone()).unwrap();
        let black = seen.pixels.iter().filter(|&&value| value < 255).count();
        assert!(black * 50 < seen.pixels.len(), "{black} of {width} x {height} pixels see nothing");
    }
    // One cell more in either direction would show more border than the rule allows.
    assert!(width > 240 && height > 150 && width <= 320 && height <= 200, "{width} x {height}");
}

#[test]
fn black_corners_are_accepted_where_the_calibration_keeps_them() {
    let (mut left, mut right) = bent_pair();
    for camera in [&mut left, &mut right] {
        camera.projection[0] = 120.0;
        camera.projection[5] = 120.0;
        camera.projection[2] = 160.0;
        camera.projection[6] = 100.0;
    }
    let rig = Rectifier::new(&left, &right).unwrap().rig();
    assert!(rig.width > 250 && rig.height > 150, "{} x {}", rig.width, rig.height);
}

#[test]
fn a_stored_record_rebuilds_the_same_rectifier() {
    let (left, right) = bent_pair();
    let rectifier = Rectifier::new(&left, &right).unwrap();
    let json = serde_json::to_string(rectifier.record()).unwrap();
    let rebuilt = Rectifier::from_record(&serde_json::from_str(&json).unwrap()).unwrap();
    assert_eq!(rebuilt.record(), rectifier.record());
    assert_eq!(rebuilt.rig(), rectifier.rig());
    let image = GreyImage::new(320, 200, rows(320, 200, 0, |x, y| [scene(x, y)[1]])).unwrap();
    let rectified = rectifier.rectify_grey(Side::Left, image.clone()).unwrap();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| assert_eq!(rebuilt.rectify_grey(Side::Left, image.clone()).unwrap(), rectified));
        }
    });
    let error = rebuilt.rectify_grey(Side::Right, GreyImage::new(160, 100, vec![0; 16_000]).unwrap()).unwrap_err();
    assert!(error.to_string().contains("right image is 160 x 100"), "{error}");
}

#[test]
fn binned_images_scale_their_calibration() {
    let (left, right) = straight_pair();
    let record = StereoCalibration { left, right, rectified_size: Some((60, 40)), stream_is_rectified: false };
    let StereoCalibration { left, right, rectified_size, .. } = record.fit_to_images(32, 24).unwrap();
    assert_eq!(rectified_size, Some((30, 20)));
    assert_eq!(left.intrinsics, [30.0, 0.0, 15.5, 0.0, 30.0, 11.5, 0.0, 0.0, 1.0]);
    let rig = Rectifier::new(&left, &right).unwrap().rig();
    assert_eq!((rig.width, rig.focal_px, rig.cu_px), (32, 30.0, 15.5));
    assert!((rig.baseline_m - 0.12).abs() < 1e-12);
    assert!(matches!(fit_to_image(&left, 32, 32), Err(CalibrationError::Shape { .. })));
    assert!(matches!(fit_to_image(&left, 0, 0), Err(CalibrationError::Shape { .. })));
}

#[test]
fn odd_calibrations_are_refused_by_the_number() {
    type Change = fn(&mut CameraCalibration);
    let right_changes: [(Change, &str); 12] = [
        (|c| c.projection[3] = 21.6, "baseline term P[3]"),
        (|c| c.projection[3] = 0.0, "baseline term P[3]"),
        (|c| c.projection[7] = -50.0, "vertical offset"),
        (|c| c.projection[2] = 151.0, "principal point's column"),
        (|c| c.projection[6] = 96.0, "principal point's row"),
        (|c| (c.projection[0], c.projection[5]) = (181.0, 181.0), "focal length P[0]"),
        (|c| c.projection[5] = 190.0, "right camera's P is fx 180, fy 190"),
        (|c| c.projection = [0.0; 12], "record calibrated CameraInfo or give a calibration file"),
        (|c| c.rectification = [0.0; 9], "its R is all zeros"),
        (|c| c.rectification[0] = 2.0, "expected a rotation matrix"),
        (|c| c.intrinsics[0] = f64::NAN, "expected finite numbers"),
        (|c| c.coefficients = vec![0.1; 3], "0, 4, 5, 8, 12 or 14 coefficients"),
    ];
    for (change, says) in right_changes {
        let (left, mut right) = bent_pair();
        change(&mut right);
        let error = Rectifier::new(&left, &right).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(says), "expected '{says}' in '{error}'");
    }
    let (left, right) = bent_pair();
    let swapped = Rectifier::new(&right, &left).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(swapped.contains("swapped"), "{swapped}");
    let (mut away, right) = bent_pair();
    away.rectification = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
    assert!(matches!(Rectifier::new(&away, &right), Err(CalibrationError::NoOverlap { .. })));
}
