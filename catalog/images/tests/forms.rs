//! OpenCV's forms, lens names, KITTI's texts by the size of their images, and what is no calibration.

use crate::images::calibration::files::parse_calibration;
use crate::images::{PairImages, Rectifier, read_single_camera_file};
use furrow_model::Distortion;

const K: &str =
    "rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.0e+02, 0., 3.2e+02, 0., 5.0e+02,\n       240., 0., 0., 1. ]";
const I: &str = "rows: 3\n   cols: 3\n   dt: d\n   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]";

fn d(numbers: &str) -> String {
    let count = numbers.split(',').count();
    format!("rows: 1\n   cols: {count}\n   dt: d\n   data: [ {numbers} ]")
}

fn p(p3: &str) -> String {
    format!("rows: 3\n   cols: 4\n   dt: d\n   data: [ 500., 0., 320., {p3}, 0., 500., 240., 0., 0., 0., 1., 0. ]")
}

fn images(width: u32, height: u32) -> Option<PairImages> {
    Some(PairImages { left: [width, height], right: [width, height], kitti_cameras: [0, 1], are_rectified: false })
}

#[test]
fn opencv_file_storage_of_one_camera_each() {
    let camera = |p3: &str, bend: &str| {
        format!(
            "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   {K}\n\
             distortion_coefficients: !!opencv-matrix\n   {}\nrectification_matrix: !!opencv-matrix\n   {I}\n\
             projection_matrix: !!opencv-matrix\n   {}\n",
            d(bend),
            p(p3)
        )
    };
    let (left, right) = (camera("0.", "0.1, 0., 0., 0., 0."), camera("-50.", "0.1, 0., 0., 0., 0."));
    let calibration = parse_calibration(&[("l", &left), ("r", &right)], images(320, 240).as_ref()).unwrap();
    let rig = Rectifier::from_record(&calibration).unwrap().rig();
    assert!((rig.baseline_m - 0.1).abs() < 1e-12 && rig.focal_px == 250.0, "{rig:?}");
    // Four numbers without a name are of either model.
    let nameless = camera("0.", "0.1, 0., 0., 0.");
    let said = parse_calibration(&[("l", &nameless), ("r", &right)], None).unwrap_err().to_string();
    assert!(said.contains("l: distortion_model should be plumb_bob") && said.contains("4 coefficients"), "{said}");
    let named = nameless.replace("image_width", "distortion_model: equidistant\nimage_width");
    let calibration = parse_calibration(&[("l", &named), ("r", &right)], None).unwrap();
    assert_eq!(calibration.left.distortion, Distortion::Equidistant);
    let zeros = camera("0.", "0., 0., 0., 0.");
    assert!(parse_calibration(&[("l", &zeros), ("r", &right)], None).is_ok());
}

#[test]
fn opencv_stereo_in_two_files_with_or_without_rectification() {
    let bend = d("-0.1, 0.01, 0., 0., 0.");
    let intrinsics = format!(
        "%YAML:1.0\nM1: !!opencv-matrix\n   {K}\nD1: !!opencv-matrix\n   {bend}\nM2: !!opencv-matrix\n   {K}\n\
         D2: !!opencv-matrix\n   {bend}\n"
    );
    let places = format!(
        "%YAML:1.0\n---\nR: !!opencv-matrix\n   {I}\nT: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   \
         data: [ -0.1, 0., 0. ]\n"
    );
    let rectified = format!(
        "{places}R1: !!opencv-matrix\n   {I}\nR2: !!opencv-matrix\n   {I}\nP1: !!opencv-matrix\n   {}\nP2: !!opencv-matrix\n   {}\n",
        p("0."),
        p("-50.")
    );
    for extrinsics in [&places, &rectified] {
        let texts = [("intrinsics.yml", intrinsics.as_str()), ("extrinsics.yml", extrinsics.as_str())];
        let calibration = parse_calibration(&texts, images(640, 480).as_ref()).unwrap();
        let rig = Rectifier::from_record(&calibration).unwrap().rig();
        assert!((rig.baseline_m - 0.1).abs() < 1e-12 && rig.focal_px == 500.0, "{rig:?}");
        assert!(parse_calibration(&texts, None).unwrap_err().to_string().contains("does not tell the size"));
    }
    let alone = parse_calibration(&[("intrinsics.yml", &intrinsics)], images(640, 480).as_ref()).unwrap_err();
    assert!(alone.to_string().contains("no place of one camera beside the other"), "{alone}");
}

#[test]
fn kitti_texts_by_the_size_of_their_images() {
    let mut raw = String::new();
    for (camera, p3) in [("00", "0"), ("01", "-4.0e+01")] {
        raw += &format!(
            "S_{camera}: 4.00e+02 2.00e+02\nK_{camera}: 2.1e+02 0 200 0 210 100 0 0 1\nD_{camera}: -0.1 0.01 0 0 0\n\
             R_{camera}: 1 0 0 0 1 0 0 0 1\nT_{camera}: 0 0 0\nS_rect_{camera}: 360 150\n\
             R_rect_{camera}: 1 0 0 0 1 0 0 0 1\nP_rect_{camera}: 200 0 190 {p3} 0 200 95 0 0 0 1 0\n"
        );
    }
    let rig_of = |text: &str, width, height| {
        let calibration = parse_calibration(&[("calib", text)], images(width, height).as_ref()).unwrap();
        let rectifier = Rectifier::from_record(&calibration).unwrap();
        (rectifier.is_identity(), rectifier.rig())
    };
    let (moved, rig) = rig_of(&raw, 400, 200);
    assert!(!moved && (rig.width, rig.height, rig.focal_px, rig.baseline_m) == (360, 150, 200.0, 0.2));
    let (same, rig) = rig_of(&raw, 360, 150);
    assert!(same && (rig.width, rig.height, rig.focal_px, rig.baseline_m) == (360, 150, 200.0, 0.2));
    let odometry = "P0: 7e2 0 600 0 0 7e2 180 0 0 0 1 0\nP1: 7e2 0 600 -3.5e2 0 7e2 180 0 0 0 1 0\n";
    let (same, rig) = rig_of(odometry, 1226, 370);
    assert!(same && (rig.width, rig.height, rig.baseline_m) == (1226, 370, 0.5));
    assert!(parse_calibration(&[("calib.txt", odometry)], None).unwrap_err().to_string().contains("tell the size"));
}

#[test]
fn one_camera_from_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera.yaml");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        read_single_camera_file(&path, [320, 240], 0)
    };
    let text = format!(
        "image_width: 640\nimage_height: 480\ncamera_matrix:\n   {K}\ndistortion_coefficients:\n   {}\n",
        d("0.0")
    );
    let camera = read(&text).unwrap();
    assert_eq!((camera.rig().unwrap().focal_px, camera.is_assumed), (250.0, false));
    let camera = read("P0: 7e2 0 600 0 0 7e2 180 0 0 0 1 0\nP1: 7e2 0 600 -3.5e2 0 7e2 180 0 0 0 1 0\n").unwrap();
    assert_eq!(camera.rig().unwrap().focal_px, 700.0);
    let bent = text.replace("[ 0.0 ]", "[ 0.1, 0, 0, 0, 0 ]").replace("cols: 1", "cols: 5");
    assert!(read(&bent).unwrap().rig().unwrap_err().to_string().contains("undistort them first"));
    assert!(read(&format!("{text}---\n{text}")).unwrap_err().to_string().contains("a single camera, found 2"));
}

#[test]
fn hostile_texts_are_refused() {
    let nested = format!("camera_matrix: {}1{}", "[".repeat(5000), "]".repeat(5000));
    let aliases = "a: &a [1,1,1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\n\
         camera_matrix: [*c,*c,*c]\n";
    for text in [
        "",
        "\u{feff}",
        "---\n---\n",
        "cam0: 3\ncam1: []\n",
        "camera_matrix: {rows: 9e99, cols: -1, data: [x]}",
        "M1: 3",
        "R1: {}\n",
        "P0: 1 2\n",
        "P_rect_",
        "T_BS: 1\nintrinsics: [1,2,3]",
        "[1, 2]",
        "%YAML:1.0",
        "cam0:\n  intrinsics: [.nan, 1, 1, 1]\n",
        &nested,
        aliases,
    ] {
        let beginning: String = text.chars().take(40).collect();
        assert!(parse_calibration(&[("x", text)], images(64, 48).as_ref()).is_err(), "{beginning}");
        assert!(parse_calibration(&[("x", text), ("y", text)], None).is_err(), "{beginning}");
    }
}
