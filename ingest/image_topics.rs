//! Which topics have a camera's images, as far as types and names tell.

use crate::message::{CompressedImage, Image};
use crate::recording::Topic;

/// What images show that no camera took as they are.
const DERIVED: [&str; 5] = ["depth", "disparity", "confidence", "mask", "segmentation"];
/// With one of these words a namespace means a device, as in `depth_camera`.
const DEVICES: [&str; 10] = ["cam", "camera", "cameras", "device", "driver", "head", "module", "node", "rig", "sensor"];

/// Whether a topic has images by its type.
pub(crate) fn is_typed_as_image(topic: &Topic) -> bool {
    topic.type_name == Image::TYPE || topic.type_name == CompressedImage::TYPE
}

/// Whether images are depth or the like, which have the same type as a camera's: by the last part of the topic's name,
/// and by the part before it where that does not mean a device. The namespace before these says nothing.
pub(crate) fn is_derived(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let mut parts = name.strip_suffix("/compressed").unwrap_or(&name).rsplit('/');
    let last = parts.next().unwrap_or_default();
    if DERIVED.iter().any(|word| last.contains(word)) {
        return true;
    }
    let words = || parts.clone().next().unwrap_or_default().split(|c: char| !c.is_ascii_alphabetic());
    words().any(|word| DERIVED.contains(&word)) && !words().any(|word| DEVICES.contains(&word))
}

/// Whether any part of a name speaks of depth or the like: of two pairs, the one without is preferred.
pub(crate) fn hints_at_derived(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    DERIVED.iter().any(|word| name.contains(word))
}

/// A recording's topics with their types, for people.
pub(crate) fn list_topics(topics: &[Topic]) -> Vec<String> {
    topics.iter().map(|topic| format!("{} ({})", topic.name, topic.type_name)).collect()
}

/// What to do about a recording without images that are read, by the types that it has in their place.
pub(crate) fn advice_without_images(topics: &[Topic]) -> &'static str {
    let any = |part: &str| topics.iter().any(|topic| topic.type_name.contains(part));
    if any("FFMPEGPacket") {
        "its images are packets of a video: decode them with `ros2 run image_transport republish ffmpeg raw`, and \
         record what that publishes"
    } else if any("theora") {
        "its images are packets of a video: decode them with `rosrun image_transport republish theora raw`, and record \
         what that publishes"
    } else if any("foxglove") {
        "Foxglove's messages are not read: write them as sensor_msgs/Image or sensor_msgs/CompressedImage, encoded as \
         ros1 or cdr"
    } else {
        "record the cameras' sensor_msgs/Image or sensor_msgs/CompressedImage"
    }
}

#[cfg(test)]
mod tests {
    use super::is_derived;

    #[test]
    fn only_the_last_parts_of_a_name_speak_of_its_images() {
        for picture in [
            "/depth_cam/left/image_raw",
            "/amr/depth_camera/infra1/image_rect_raw",
            "/depth/left/image_raw",
            "/masked_robot/left/image_raw/compressed",
            "/depth_camera/left",
            "/d435_depth_module/image_raw",
            "left",
            "/depthai/left/image",
            "/segmentation/left/image_rect",
        ] {
            assert!(!is_derived(picture), "{picture}");
        }
        for derived in [
            "/camera/depth/image_rect_raw",
            "/camera/depth/image_rect_raw/compressedDepth",
            "/camera/aligned_depth_to_infra1/image_raw",
            "/zed/zed_node/depth/depth_registered",
            "/zed/zed_node/confidence/confidence_map",
            "/stereo/disparity/image/compressed",
            "/camera/left/image_mask",
            "/depth/image_raw",
            "depth",
        ] {
            assert!(is_derived(derived), "{derived}");
        }
    }
}
