//! Pairs without R and P: files of Kalibr, EuRoC and OpenCV, and the rectification that is made of them.

use super::seen::{rotated, seen_at};
use crate::images::calibration::files::parse_calibration;
use crate::images::rectify::align::align;
use crate::images::rectify::pose::Pose;
use crate::images::{PairImages, Rectifier, Side, StereoCalibration};
use furrow_model::{CameraCalibration, Distortion};

/// A turn about x, then y, then z.
fn turned([a, b, c]: [f64; 3]) -> [f64; 9] {
    let product = |m: &[f64; 9], n: &[f64; 9]| -> [f64; 9] {
        std::array::from_fn(|i| (0..3).map(|k| m[i / 3 * 3 + k] * n[k * 3 + i % 3]).sum())
    };
    let about_x = [1.0, 0.0, 0.0, 0.0, a.cos(), -a.sin(), 0.0, a.sin(), a.cos()];
    let about_y = [b.cos(), 0.0, b.sin(), 0.0, 1.0, 0.0, -b.sin(), 0.0, b.cos()];
    let about_z = [c.cos(), -c.sin(), 0.0, c.sin(), c.cos(), 0.0, 0.0, 0.0, 1.0];
    product(&about_z, &product(&about_y, &about_x))
}

fn camera(distortion: Distortion, coefficients: &[f64], [fx, fy, cx, cy]: [f64; 4]) -> CameraCalibration {
    CameraCalibration {
        width: 640,
        height: 480,
        distortion,
        coefficients: coefficients.to_vec(),
        intrinsics: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        rectification: [0.0; 9],
        projection: [0.0; 12],
    }
}

/// Every point that the rig shows is, in both recorded images, where the lenses and the places of the cameras put it.
fn shows_the_truth(calibration: &StereoCalibration, right_from_left: &Pose) {
    let rectifier = Rectifier::from_record(calibration).unwrap();
    let rig = rectifier.rig();
    let true_baseline = right_from_left.translation.iter().map(|value| value * value).sum::<f64>().sqrt();
    assert!((rig.baseline_m - true_baseline).abs() < 1e-9, "{rig:?}");
    let mut tried = 0;
    for (column, row, disparity) in [(0.1, 0.2, 40.0), (0.5, 0.5, 9.0), (0.9, 0.8, 25.0), (0.7, 0.1, 3.0)] {
        let (u, v) = (column * f64::from(rig.width), row * f64::from(rig.height));
        let in_rig = rig.triangulate(u, v, disparity);
        let transposed: [f64; 9] = std::array::from_fn(|i| calibration.left.rectification[i % 3 * 3 + i / 3]);
        let in_left = rotated(&transposed, in_rig);
        let turned = rotated(&right_from_left.rotation, in_left);
        let in_right = std::array::from_fn(|i| turned[i] + right_from_left.translation[i]);
        for (side, camera, u, point) in
            [(Side::Left, &calibration.left, u, in_left), (Side::Right, &calibration.right, u - disparity, in_right)]
        {
            let found = rectifier.source_of(side, u, v).unwrap();
            let expected = seen_at(camera, point);
            let error = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(error < 1e-6, "{side} ({u}, {v}): {found:?}, expected {expected:?}");
            tried += 1;
        }
    }
    assert_eq!(tried, 8);
}

#[test]
fn points_land_where_the_cameras_saw_them_for_every_lens() {
    let radial = camera(Distortion::RadialTangential, &[-0.28, 0.07, 2e-4, 1.8e-5], [458.6, 457.3, 320.2, 248.4]);
    let other = camera(Distortion::RadialTangential, &[-0.28, 0.07, -1e-4, -3e-5, 0.01], [457.6, 456.1, 330.0, 235.0]);
    let fisheye = camera(Distortion::Equidistant, &[3e-3, 7e-4, -2e-3, 2e-4], [191.0, 190.9, 320.9, 238.0]);
    let other_eye = camera(Distortion::Equidistant, &[3e-3, 1e-3, -2.5e-3, 3e-4], [190.4, 190.4, 315.0, 244.0]);
    let tilted = [-0.2, 0.05, 1e-3, -5e-4, 0.01, 0.1, -0.02, 0.003, 2e-3, -1e-3, -3e-3, 5e-4, 0.02, -0.03];
    let tilted = camera(Distortion::RadialTangential, &tilted, [458.6, 457.3, 320.2, 248.4]);
    let plain = camera(Distortion::RadialTangential, &[], [500.0, 480.0, 300.0, 250.0]);
    let places = [
        ([0.0, 0.0, 0.0], [-0.11, 0.0, 0.0]),
        ([0.01, -0.02, 0.005], [-0.11, 0.001, -0.002]),
        ([-0.03, 0.05, -0.04], [-0.4, -0.03, 0.05]),
    ];
    for (left, right) in
        [(&radial, &other), (&tilted, &other), (&fisheye, &other_eye), (&plain, &radial), (&plain, &plain)]
    {
        for (turn, translation) in places {
            let place = Pose { rotation: turned(turn), translation };
            let calibration = align(left, right, &place).unwrap();
            assert!(!calibration.stream_is_rectified);
            shows_the_truth(&calibration, &place);
            let rig = Rectifier::from_record(&calibration).unwrap().rig();
            assert!(rig.width > 400 && rig.height > 300, "{rig:?}");
        }
    }
}

#[test]
fn cameras_that_are_aligned_already_move_no_pixel() {
    let left = camera(Distortion::RadialTangential, &[0.0; 4], [700.0, 700.0, 310.5, 240.25]);
    let place = Pose { translation: [-0.54, 0.0, 0.0], ..Pose::IDENTITY };
    let calibration = align(&left, &left, &place).unwrap();
    assert!(calibration.stream_is_rectified);
    let rig = Rectifier::from_record(&calibration).unwrap().rig();
    assert_eq!((rig.focal_px, rig.cu_px, rig.cv_px, rig.baseline_m), (700.0, 310.5, 240.25, 0.54));
}

#[test]
fn cameras_that_make_no_pair_are_refused() {
    let plain = camera(Distortion::RadialTangential, &[], [500.0, 480.0, 300.0, 250.0]);
    let said = |translation: [f64; 3], turn: [f64; 3]| {
        align(&plain, &plain, &Pose { rotation: turned(turn), translation }).unwrap_err().to_string()
    };
    assert!(said([0.11, 0.0, 0.0], [0.0; 3]).contains("name the left camera first"));
    assert!(said([-0.01, -0.2, 0.0], [0.0; 3]).contains("side by side"));
    assert!(said([-0.01, 0.0, 0.3], [0.0; 3]).contains("side by side"));
    assert!(said([0.0; 3], [0.0; 3]).contains("distance between the cameras"));
    assert!(said([f64::NAN, 0.0, 0.0], [0.0; 3]).contains("distance between the cameras"));
    for about_y in [1.2, 2.0, std::f64::consts::PI] {
        align(&plain, &plain, &Pose { rotation: turned([0.0, about_y, 0.0]), translation: [-0.2, 0.0, 0.0] })
            .expect_err("cameras that look apart");
    }
}

const CHAIN: &str = "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]\n  \
     distortion_model: equidistant\n  intrinsics: [190.97, 190.97, 254.9, 256.8]\n  resolution: [512, 512]\n  \
     rostopic: /cam0/image_raw\ncam1:\n  T_cn_cnm1:\n  - [0.9999, -0.0023, -0.0009, -0.1011]\n  \
     - [0.0023, 0.9989, 0.0467, -0.0020]\n  - [0.0008, -0.0467, 0.9989, -0.0012]\n  - [0.0, 0.0, 0.0, 1.0]\n  \
     camera_model: pinhole\n  distortion_coeffs: [0.0034, 0.0012, -0.0025, 0.0003]\n  distortion_model: equidistant\n  \
     intrinsics: [190.44, 190.43, 252.6, 254.9]\n  resolution: [512, 512]\n  rostopic: /cam1/image_raw\n";

#[test]
fn kalibr_chains_and_their_images_of_half_the_size() {
    let full = parse_calibration(&[("camchain.yaml", CHAIN)], None).unwrap();
    assert_eq!(full.left.distortion, Distortion::Equidistant);
    let rig = Rectifier::from_record(&full).unwrap().rig();
    assert!((rig.baseline_m - 0.10113).abs() < 1e-4 && rig.width > 450 && rig.height > 450, "{rig:?}");
    let images = PairImages { left: [256, 256], right: [256, 256], kitti_cameras: [0, 1], are_rectified: false };
    let half = parse_calibration(&[("camchain.yaml", CHAIN)], Some(&images)).unwrap();
    let half_rig = Rectifier::from_record(&half).unwrap().rig();
    assert!((half_rig.focal_px * 2.0 - rig.focal_px).abs() < 1e-9 && half_rig.baseline_m == rig.baseline_m);
    let said = |text: &str| parse_calibration(&[("camchain.yaml", text)], None).unwrap_err().to_string();
    assert!(said(&CHAIN.replace("pinhole", "omni")).contains("cam0: camera_model should be pinhole, found omni"));
    assert!(said(&CHAIN.replace("T_cn_cnm1", "T_other")).contains("no place of one camera beside the other"));
    assert!(said(&CHAIN.replace("0.9999,", "1.9999,")).contains("T_cn_cnm1 should be a 4x4 matrix of a rotation"));
    assert!(said(&CHAIN.replace("resolution: [512, 512]", "resolution: [0, 512]")).contains("resolution"));
    assert!(said(&CHAIN.replace("cam1:", "cam0:")).contains("camchain.yaml is no YAML"));
    let rectified = PairImages { are_rectified: true, left: [512, 512], right: [512, 512], ..images };
    let said = parse_calibration(&[("camchain.yaml", CHAIN)], Some(&rectified)).unwrap_err().to_string();
    assert!(said.contains("before rectification"), "{said}");
}

/// EuRoC's published calibration, in the layout's own form.
fn sensor(t_bs: &str, intrinsics: &str, distortion: &str) -> String {
    format!(
        "# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor\n\n\
         # Sensor extrinsics wrt. the body-frame.\nT_BS:\n  cols: 4\n  rows: 4\n  data: [{t_bs},\n         0.0, 0.0, 0.0, 1.0]\n\n\
         rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [{intrinsics}] #fu, fv, cu, cv\n\
         distortion_model: radial-tangential\ndistortion_coefficients: [{distortion}]\n"
    )
}

#[test]
fn euroc_sensors_as_two_files() {
    let left = sensor(
        "0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,\n 0.999557249008, 0.0149672133247, \
         0.025715529948, -0.064676986768,\n -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949",
        "458.654, 457.296, 367.215, 248.375",
        "-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05",
    );
    let right = sensor(
        "0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556,\n 0.999598781151, 0.0130119051815, \
         0.0251588363115, 0.0453689425024,\n -0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038",
        "457.587, 456.134, 379.999, 255.238",
        "-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05",
    );
    let files = [("cam0/sensor.yaml", left.as_str()), ("cam1/sensor.yaml", right.as_str())];
    let rig = Rectifier::from_record(&parse_calibration(&files, None).unwrap()).unwrap().rig();
    // The published baseline is 0.11008 m.
    assert!((rig.baseline_m - 0.11008).abs() < 1e-4 && rig.width > 700 && rig.height > 440, "{rig:?}");
    let exchanged = parse_calibration(&[files[1], files[0]], None).unwrap_err().to_string();
    assert!(exchanged.contains("name the left camera first"), "{exchanged}");
}
