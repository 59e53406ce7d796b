//! Calibration files that users bring.

use crate::images::calibration::files::parse_calibration;
use crate::images::{Rectifier, kitti, read_calibration_files};
use furrow_model::Distortion;

fn ros_yaml(p3: f64, model: &str, coefficients: &str) -> String {
    let count = coefficients.split(',').count();
    format!(
        "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\n\
         camera_matrix:\n  rows: 3\n  cols: 3\n  data: [500.5, 0, 320, 0, 500.5, 240, 0, 0, 1]\n\
         distortion_model: {model}\n\
         distortion_coefficients:\n  rows: 1\n  cols: {count}\n  data: [{coefficients}]\n\
         rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n\
         projection_matrix:\n  rows: 3\n  cols: 4\n  data: [480., 0., 310.5, {p3:e}, 0., 480., 238., 0., 0., 0., 1., 0.]\n"
    )
}

#[test]
fn ros_yaml_as_two_files_or_two_documents() {
    let left = ros_yaml(0.0, "plumb_bob", "-0.1, 0.02, 0.001, 0, 0");
    let right = ros_yaml(-57.6, "rational_polynomial", "-0.1, 0.02, 0.001, 0, 0, 0.1, 0, 0");
    let two_documents = format!("%YAML 1.2\n---\n{left}---\n{right}");
    let calibration = parse_calibration(&[("left.yaml", &left), ("right.yaml", &right)], None).unwrap();
    assert_eq!(parse_calibration(&[("both.yaml", &two_documents)], None).unwrap(), calibration);
    assert_eq!(calibration.left.intrinsics[0], 500.5);
    assert_eq!(calibration.right.coefficients.len(), 8);
    assert!((Rectifier::from_record(&calibration).unwrap().rig().baseline_m - 0.12).abs() < 1e-12);

    let folder = tempfile::tempdir().unwrap();
    let paths = ["left.yaml", "right.yaml"].map(|name| folder.path().join(name));
    std::fs::write(&paths[0], &left).unwrap();
    std::fs::write(&paths[1], &right).unwrap();
    assert_eq!(read_calibration_files(&paths, None).unwrap(), calibration);
    let error = read_calibration_files(&[folder.path().join("absent.yaml")], None).unwrap_err().to_string();
    assert!(error.contains("absent.yaml"), "{error}");
}

#[test]
fn fisheye_yaml() {
    let left = ros_yaml(0.0, "equidistant", "0.1, 0.02, 0.001, 0");
    let right = ros_yaml(-57.6, "fisheye", "0.1, 0.02, 0.001, 0");
    let calibration = parse_calibration(&[("l", &left), ("r", &right)], None).unwrap();
    assert_eq!(calibration.left.distortion, Distortion::Equidistant);
}

#[test]
fn faulty_yaml_says_where() {
    let left = ros_yaml(0.0, "plumb_bob", "0, 0, 0, 0, 0");
    let error =
        |right: &str| parse_calibration(&[("left.yaml", &left), ("right.yaml", right)], None).unwrap_err().to_string();
    assert!(error(&left.replace("cols: 4", "cols: 3")).contains("right.yaml: projection_matrix"));
    assert!(error(&left.replace("480., 0., 310.5, ", "")).contains("rows 3, cols 4 with 9 numbers"));
    // Coefficients of zero bend nothing, whatever the model's name.
    let bent = left.replace("[0, 0, 0, 0, 0]", "[0.1, 0, 0, 0, 0]");
    assert!(error(&bent.replace("plumb_bob", "mirror")).contains("found mirror"));
    assert!(parse_calibration(&[("l", &left), ("r", &left.replace("plumb_bob", "mirror"))], None).is_ok());
    assert!(error(&left.replace("image_width: 640", "image_width: wide")).contains("right.yaml"));
    assert!(error("hello: 1").contains("no calibration of a known form"));
    assert!(parse_calibration(&[("left.yaml", &left)], None).unwrap_err().to_string().contains("found 1 in left.yaml"));
    assert!(parse_calibration(&[], None).is_err());
}

/// The form of KITTI's file with numbers of our own.
fn cam_to_cam() -> String {
    let mut text = String::from("calib_time: 01-Jan-2020 00:00:00\ncorner_dist: 1.0e-01\n");
    for (camera, p3) in [("00", "0"), ("01", "-4.0e+01")] {
        text += &format!(
            "S_{camera}: 4.00e+02 2.00e+02\nK_{camera}: 2.1e+02 0 200 0 210 100 0 0 1\nD_{camera}: -0.1 0.01 0 0 0\n\
             R_{camera}: 1 0 0 0 1 0 0 0 1\nT_{camera}: 0 0 0\nS_rect_{camera}: 360 180\n\
             R_rect_{camera}: 1 0 0 0 1 0 0 0 1\nP_rect_{camera}: 200 0 190 {p3} 0 200 95 0 0 0 1 0\n"
        );
    }
    text
}

#[test]
fn kitti_raw_text() {
    let text = cam_to_cam();
    let calibration = parse_calibration(&[("calib_cam_to_cam.txt", &text)], None).unwrap();
    assert_eq!((calibration.left.width, calibration.rectified_size), (400, Some((360, 180))));
    let rig = Rectifier::from_record(&calibration).unwrap().rig();
    assert_eq!((rig.width, rig.height, rig.cu_px, rig.baseline_m), (360, 180, 190.0, 0.2));
    let error = kitti::raw_calibration("calib.txt", &text, 2, 3).unwrap_err().to_string();
    assert!(error.contains("no line 'S_rect_02:'"), "{error}");
    let error = kitti::raw_calibration("calib.txt", &text.replace("K_01: 2.1e+02", "K_01: x"), 0, 1).unwrap_err();
    assert!(error.to_string().contains("K_01 should be 9 numbers"), "{error}");
}

#[test]
fn kitti_odometry_text_with_names_or_bare() {
    let bare = "7e2 0 600 0 0 7e2 180 0 0 0 1 0\n7e2 0 600 -3.5e2 0 7e2 180 0 0 0 1 0";
    let named = "P0: 7e2 0 600 0 0 7e2 180 0 0 0 1 0\nP1: 7e2 0 600 -3.5e2 0 7e2 180 0 0 0 1 0\n\
                 P2: 7e2 0 600 4e1 0 7e2 180 2e-1 0 0 1 0\nP3: 7e2 0 600 -3.1e2 0 7e2 180 2 0 0 1 0\n";
    let read = |text: &str, cameras| kitti::odometry_calibration("calib.txt", text, cameras, [1226, 370]);
    let calibration = read(bare, [0, 1]).unwrap();
    assert_eq!(read(named, [0, 1]).unwrap(), calibration);
    for cameras in [[0, 1], [2, 3]] {
        let rectifier = Rectifier::from_record(&read(named, cameras).unwrap()).unwrap();
        assert!(rectifier.is_identity());
        assert_eq!((rectifier.rig().width, rectifier.rig().baseline_m), (1226, 0.5));
    }
    assert!(read(named, [4, 5]).unwrap_err().to_string().contains("'P4:'"));
    assert!(read("", [0, 1]).unwrap_err().to_string().contains("found 0"));
    assert!(read("1 2 3\n4 5 6", [0, 1]).unwrap_err().to_string().contains("line 1 should be 12 numbers"));
}
