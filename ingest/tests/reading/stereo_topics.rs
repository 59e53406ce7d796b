//! The topics of well-known cameras.

use furrow_ingest::info_topics::named_info;
use furrow_ingest::recording::{Encoding, Topic};
use furrow_ingest::topics::{TopicError, find_sensors, find_stereo};

fn topics(of: &[(&str, &str)]) -> Vec<Topic> {
    let topic = |&(name, kind): &(&str, &str)| Topic {
        name: name.to_owned(),
        type_name: if kind.contains(['/', '.']) { kind.to_owned() } else { format!("sensor_msgs/{kind}") },
        encoding: Encoding::Cdr,
        messages: Some(10),
    };
    of.iter().map(topic).collect()
}

/// Finds `left` and `right`, with the calibrations `infos`, among `of`, in whatever order they are listed.
fn check(of: &[(&str, &str)], pair: [&str; 2], infos: [Option<&str>; 2]) {
    for reversed in [false, true] {
        let mut topics = topics(of);
        if reversed {
            topics.reverse();
        }
        let found = find_stereo(&topics, None, None).unwrap();
        assert_eq!([found.left_image.as_str(), &found.right_image], pair);
        assert_eq!([found.left_info.as_deref(), found.right_info.as_deref()], infos);
        assert_eq!(found.compressed, pair[0].ends_with("/compressed"));
    }
}

#[test]
fn zed() {
    let zed = |rest: &str| format!("/zed2i/zed_node/{rest}");
    let names = [
        "left/image_rect_color",
        "right/image_rect_color",
        "left_raw/image_raw_color",
        "right_raw/image_raw_color",
        "rgb/image_rect_color",
        "depth/depth_registered",
        "left/image_rect_gray",
        "right/image_rect_gray",
        "stereo/image_rect_color",
    ]
    .map(zed);
    let packed = ["left/image_rect_color/compressed", "right/image_rect_color/compressed"].map(zed);
    let infos = ["left/camera_info", "right/camera_info", "left_raw/camera_info", "right_raw/camera_info"].map(zed);
    let mut all: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "Image")).collect();
    all.extend(packed.iter().map(|name| (name.as_str(), "CompressedImage")));
    all.extend(infos.iter().map(|name| (name.as_str(), "CameraInfo")));
    let of_pair = [Some(infos[0].as_str()), Some(infos[1].as_str())];
    check(&all, [&names[0], &names[1]], of_pair);
    // Only compressed rectified ones beside raw ones: rectified first.
    let some: Vec<_> = all
        .iter()
        .copied()
        .filter(|(name, _)| packed.iter().chain(&names[2..4]).chain(&infos).any(|n| n == name))
        .collect();
    check(&some, [&packed[0], &packed[1]], of_pair);
    // Only the raw ones.
    let some: Vec<_> =
        all.iter().copied().filter(|(name, _)| names[2..4].iter().chain(&infos).any(|n| n == name)).collect();
    check(&some, [&names[2], &names[3]], [Some(&infos[2]), Some(&infos[3])]);
}

#[test]
fn other_cameras() {
    let plain = |left: &str, right: &str| check(&[(right, "Image"), (left, "Image")], [left, right], [None, None]);
    plain("/camera/infra1/image_rect_raw", "/camera/infra2/image_rect_raw");
    plain("/camera/fisheye1/image_raw", "/camera/fisheye2/image_raw");
    plain("/stereo/left/image_rect", "/stereo/right/image_rect");
    plain("/cam0/image_raw", "/cam1/image_raw");
    plain("/kitti/camera_gray_left/image_raw", "/kitti/camera_gray_right/image_raw");
    plain("left", "right");
    plain("/device_0/sensor_0/Fisheye_1/image/data", "/device_0/sensor_0/Fisheye_2/image/data");
    plain("/camera/l/image", "/camera/r/image");
    check(
        &[
            ("/stereo/left/image_raw/compressed", "CompressedImage"),
            ("/stereo/right/image_raw/compressed", "CompressedImage"),
            ("/stereo/left/camera_info", "CameraInfo"),
            ("/stereo/right/image_raw/camera_info", "CameraInfo"),
        ],
        ["/stereo/left/image_raw/compressed", "/stereo/right/image_raw/compressed"],
        [Some("/stereo/left/camera_info"), Some("/stereo/right/image_raw/camera_info")],
    );
    check(
        &[
            ("/rs/infra1/image_rect_raw", "Image"),
            ("/rs/infra2/image_rect_raw", "Image"),
            ("/rs/color/image_raw", "Image"),
            ("/rs/depth/image_rect_raw", "Image"),
        ],
        ["/rs/infra1/image_rect_raw", "/rs/infra2/image_rect_raw"],
        [None, None],
    );
    // Four cameras in a row: the first two.
    check(
        &[("/cam0/image", "Image"), ("/cam1/image", "Image"), ("/cam2/image", "Image"), ("/cam3/image", "Image")],
        ["/cam0/image", "/cam1/image"],
        [None, None],
    );
}

#[test]
fn choices_and_errors() {
    let two = topics(&[
        ("/a/left/image", "Image"),
        ("/a/right/image", "Image"),
        ("/b/left/image", "Image"),
        ("/b/right/image", "Image"),
        ("/b/right/image/compressed", "CompressedImage"),
        ("/x", "Image"),
    ]);
    let several = find_stereo(&two, None, None).unwrap_err();
    assert!(matches!(&several, TopicError::Several { pairs } if pairs.len() == 2), "{several}");
    assert!(several.to_string().contains("--left TOPIC --right TOPIC"));
    let chosen = find_stereo(&two, Some("/b/left/image"), None).unwrap();
    assert_eq!(chosen.right_image, "/b/right/image");
    let chosen = find_stereo(&two, Some("/x"), Some("/a/left/image")).unwrap();
    assert_eq!((chosen.left_image.as_str(), chosen.right_image.as_str()), ("/x", "/a/left/image"));
    let unlike = find_stereo(&two, Some("/b/left/image"), Some("/b/right/image/compressed")).unwrap_err();
    assert!(matches!(unlike, TopicError::Unlike { .. }));
    let missing = find_stereo(&two, Some("/c"), None).unwrap_err().to_string();
    assert!(missing.contains("/c") && missing.contains("/b/right/image/compressed"), "{missing}");
    let alone = find_stereo(&topics(&[("/x", "Image"), ("/imu", "Imu")]), None, None).unwrap_err().to_string();
    assert!(alone.contains("image topics: /x;") && alone.contains("--left"), "{alone}");
}

#[test]
fn sensors() {
    let found = find_sensors(&topics(&[
        ("/imu", "Imu"),
        ("/odom", "nav_msgs/Odometry"),
        ("/fix", "NavSatFix"),
        ("/imu2", "Imu"),
    ]));
    assert_eq!(found.imu, ["/imu", "/imu2"]);
    assert_eq!((found.fixes, found.odometry), (vec!["/fix".to_owned()], vec!["/odom".to_owned()]));
}

/// The CameraInfo topics found for a pair of image topics, among some that there are.
fn infos_of(images: [&str; 2], infos: &[&str]) -> [Option<String>; 2] {
    let mut all: Vec<(&str, &str)> = images.iter().map(|name| (*name, "Image")).collect();
    all.extend(infos.iter().map(|name| (*name, "CameraInfo")));
    let found = find_stereo(&topics(&all), Some(images[0]), Some(images[1])).unwrap();
    [found.left_info, found.right_info]
}

#[test]
fn raw_images_go_with_the_raw_calibration_and_rectified_ones_with_theirs() {
    let pair = |name: &str| [format!("/zed/left/{name}"), format!("/zed/right/{name}")];
    let all = ["camera_info", "camera_info_raw", "camera_info_rect"].map(pair).concat();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let found = |image: &str, kept: &[&str]| {
        let [left, right] = pair(image);
        let infos: Vec<&str> =
            all.iter().copied().filter(|name| kept.iter().any(|kept| name.ends_with(kept))).collect();
        let [left, right] = infos_of([&left, &right], &infos);
        assert_eq!(left.as_ref().map(|name| name.replace("left", "right")), right);
        left.map(|name| name.rsplit('/').next().unwrap_or_default().to_owned())
    };
    let every: &[&str] = &["camera_info", "_raw", "_rect"];
    for raw in ["image_raw_color", "image_raw", "image_raw_color/compressed", "image_unrect"] {
        assert_eq!(found(raw, every).as_deref(), Some("camera_info_raw"), "{raw}");
        assert_eq!(found(raw, &["/camera_info"]).as_deref(), Some("camera_info"), "{raw}");
        assert_eq!(found(raw, &["_rect"]), None, "{raw}");
    }
    for rectified in ["image_rect", "image_rect_color/compressed", "image_rect_raw"] {
        assert_eq!(found(rectified, every).as_deref(), Some("camera_info_rect"), "{rectified}");
        assert_eq!(found(rectified, &["/camera_info"]).as_deref(), Some("camera_info"), "{rectified}");
        assert_eq!(found(rectified, &["_raw"]), None, "{rectified}");
    }
    assert_eq!(found("image_color", every).as_deref(), Some("camera_info"));
}

#[test]
fn named_calibrations_must_be_there_and_of_their_type() {
    let topics = topics(&[("/left/image", "Image"), ("/left/camera_info", "CameraInfo")]);
    assert_eq!(named_info(&topics, "/left/camera_info").unwrap(), "/left/camera_info");
    let absent = named_info(&topics, "/right/camera_info").unwrap_err();
    assert!(absent.contains("no topic /right/camera_info") && absent.contains("topics: /left/camera_info"), "{absent}");
    let other = named_info(&topics, "/left/image").unwrap_err();
    assert!(other.contains("is sensor_msgs/Image, expected sensor_msgs/CameraInfo"), "{other}");
}

#[test]
fn depth_in_a_namespace_hides_no_camera_and_what_is_named_is_read() {
    let plain = |left: &str, right: &str| check(&[(right, "Image"), (left, "Image")], [left, right], [None, None]);
    plain("/depth_cam/left/image_raw", "/depth_cam/right/image_raw");
    plain("/amr/depth_camera/infra1/image_rect_raw", "/amr/depth_camera/infra2/image_rect_raw");
    plain("/masked_robot/left/image_rect", "/masked_robot/right/image_rect");
    // Beside a camera's own images, those of such a namespace are not chosen.
    check(
        &[
            ("/segmentation/left/image", "Image"),
            ("/segmentation/right/image", "Image"),
            ("/front/left/image", "Image"),
            ("/front/right/image", "Image"),
        ],
        ["/front/left/image", "/front/right/image"],
        [None, None],
    );
    let depths = topics(&[("/left/depth/image", "Image"), ("/right/depth/image", "Image")]);
    let hidden = find_stereo(&depths, None, None).unwrap_err().to_string();
    assert!(hidden.contains("by name not a camera's: /left/depth/image, /right/depth/image"), "{hidden}");
    let named = find_stereo(&depths, Some("/left/depth/image"), Some("/right/depth/image")).unwrap();
    assert_eq!(named.right_image, "/right/depth/image");
}

#[test]
fn what_cannot_be_a_pair_is_said() {
    let one = topics(&[("/x/left/image", "Image"), ("/x/right/image", "Image")]);
    let same = find_stereo(&one, Some("/x/left/image"), Some("/x/left/image")).unwrap_err();
    assert!(matches!(&same, TopicError::Same { topic, .. } if topic == "/x/left/image"), "{same}");
    for (kind, advice) in [
        ("ffmpeg_image_transport_msgs/FFMPEGPacket", "republish ffmpeg raw"),
        ("theora_image_transport/Packet", "republish theora raw"),
        ("foxglove.CompressedImage", "Foxglove"),
        ("rosgraph_msgs/Clock", "sensor_msgs/CompressedImage"),
    ] {
        let said = find_stereo(&topics(&[("/t", kind)]), None, None).unwrap_err().to_string();
        assert!(said.contains(&format!("/t ({kind})")) && said.contains(advice), "{said}");
    }
    let alone = find_stereo(&topics(&[("/stereo/image", "Image")]), None, None).unwrap_err().to_string();
    assert!(alone.contains("side by side") && alone.contains("both files"), "{alone}");
}
