//! Which CameraInfo topic belongs to an image topic.
//!
//! ROS' convention is one `camera_info` beside the images, good for raw and rectified ones. Some drivers write two: the
//! old ZED wrapper's `camera_info` is of the rectified images, and `camera_info_raw` of the raw ones.

use crate::message::CameraInfo;
use crate::recording::Topic;

/// What a topic's name says of its images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageKind {
    /// Rectified.
    Rectified,
    /// As the camera took them.
    Raw,
    /// Nothing.
    Unnamed,
}

/// What the last parts of an image topic's name say: `image_rect_color`, `color/rect/image`, `image_raw`. Rectified
/// images of a raw pixel format, as RealSense's `image_rect_raw`, are rectified.
pub fn image_kind(image: &str) -> ImageKind {
    let base = without_transport(image).to_ascii_lowercase();
    let last_two: Vec<&str> = base.rsplit('/').take(2).collect();
    let has = |wanted: &[&str]| {
        let mut words = last_two.iter().flat_map(|part| part.split(|c: char| !c.is_ascii_alphabetic()));
        words.any(|word| wanted.contains(&word))
    };
    if base.contains("image_rect") || has(&["rect", "rectified"]) {
        ImageKind::Rectified
    } else if has(&["raw", "unrect", "unrectified", "distorted"]) {
        ImageKind::Raw
    } else {
        ImageKind::Unnamed
    }
}

/// The CameraInfo topic of an image topic: below its own name or in its namespace; that of raw images for raw images,
/// and never that of the other kind.
pub fn info_topic(topics: &[Topic], image: &str) -> Option<String> {
    let base = without_transport(image);
    let namespace = base.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    let beside = if namespace.is_empty() && !base.starts_with('/') { String::new() } else { format!("{namespace}/") };
    let own: &[&str] = match image_kind(image) {
        ImageKind::Rectified => &["camera_info_rect", "camera_info"],
        ImageKind::Raw => &["camera_info_raw", "camera_info"],
        ImageKind::Unnamed => &["camera_info"],
    };
    let names = own.iter().flat_map(|name| [format!("{base}/{name}"), format!("{beside}{name}")]);
    let is_info = |wanted: &str| info_topics(topics).any(|name| name == wanted);
    names.into_iter().find(|wanted| is_info(wanted))
}

/// The CameraInfo topic that the user named.
///
/// # Errors
/// A topic that is not in the recording, or of another type; with the CameraInfo topics that there are.
pub fn named_info(topics: &[Topic], wanted: &str) -> Result<String, String> {
    match topics.iter().find(|topic| topic.name == wanted) {
        Some(topic) if topic.type_name == CameraInfo::TYPE => Ok(wanted.to_owned()),
        Some(topic) => Err(format!(
            "topic {wanted} is {}, expected {}; CameraInfo topics: {}",
            topic.type_name,
            CameraInfo::TYPE,
            listed(topics)
        )),
        None => Err(format!("no topic {wanted} in the recording; CameraInfo topics: {}", listed(topics))),
    }
}

/// The names of the CameraInfo topics, for an error.
pub fn listed(topics: &[Topic]) -> String {
    let names: Vec<&str> = info_topics(topics).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

fn info_topics(topics: &[Topic]) -> impl Iterator<Item = &str> {
    topics.iter().filter(|topic| topic.type_name == CameraInfo::TYPE).map(|topic| topic.name.as_str())
}

/// The name without the part that a transport adds.
fn without_transport(image: &str) -> &str {
    image.strip_suffix("/compressed").unwrap_or(image)
}
