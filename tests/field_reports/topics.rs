//! Names of topics and types.

use super::case::{Case, read, refused};

pub const CASES: &[Case] = &[
    refused("18-video-and-foxglove/ffmpeg", &["ffmpeg_image_transport_msgs", "/stereo/left/image_raw/ffmpeg"]),
    refused("18-video-and-foxglove/foxglove.mcap", &["foxglove.CompressedImage"]),
    read("18-video-and-foxglove/empty-schema.mcap", 12, 13.116),
    refused("19-side-by-side/a.bag", &["side by side"]),
    read("27-depth-namespace/depth_cam.bag", 12, 13.116),
    read("27-depth-namespace/depth_cam.bag", 12, 13.116)
        .with("--left /depth_cam/left/image_raw --right /depth_cam/right/image_raw"),
    read("27-depth-namespace/depth_camera-infra", 12, 13.116),
    read("28-zed-names/zed-5.1", 12, 13.116),
    read("28-zed-names/zed-3.bag", 12, 13.116),
    refused("29-right-never-came/db3", &["/stereo/right/image_rect/compressed", "empty", "12"]),
    refused("29-right-never-came/mcap", &["/stereo/right/image_rect/compressed", "empty", "12"]),
    refused("30-which-pair/front-rear.bag", &["/front/left", "/rear/left", "--left"]),
    read("30-which-pair/front-rear.bag", 12, 13.116)
        .with("--left /front/left/image_rect/compressed --right /front/right/image_rect/compressed"),
    refused("30-which-pair/front-rear.bag", &["same topic", "/rear/left"])
        .with("--left /front/left/image_rect/compressed --right /front/left/image_rect/compressed"),
    refused("30-which-pair/clock-only.bag", &["rosgraph_msgs/Clock"]),
    refused(
        "30-which-pair/raw-and-compressed.bag",
        &["/stereo/left/image_rect", "/stereo/right/image_rect/compressed"],
    ),
    read("52-nan-fixes/a.bag", 12, 13.116),
];
