//! Which topics are the stereo pair, its calibration, and the other sensors: by type and by name.
//!
//! Two image topics are a pair where their names differ only in a side: `left`/`right`, `l`/`r`, or a camera's number,
//! as in ZED's `left/image_rect_color`, RealSense's `infra1`, the T265's `fisheye1` or KITTI's `cam0`.

pub use crate::topic_error::TopicError;

use crate::image_topics::{advice_without_images, hints_at_derived, is_derived, is_typed_as_image, list_topics};
use crate::info_topics::info_topic;
use crate::message::{CompressedImage, Imu, NavSatFix, Odometry};
use crate::recording::Topic;

/// The topics of a stereo pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StereoTopics {
    /// The left camera's images.
    pub left_image: String,
    /// The right camera's images.
    pub right_image: String,
    /// The left camera's calibration; `None` where it was not recorded.
    pub left_info: Option<String>,
    /// The right camera's calibration; `None` where it was not recorded.
    pub right_info: Option<String>,
    /// Whether the images are `CompressedImage`s.
    pub compressed: bool,
}

/// The names of the topics of other sensors, in the recording's order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SensorTopics {
    /// `sensor_msgs/Imu`.
    pub imu: Vec<String>,
    /// `sensor_msgs/NavSatFix`.
    pub fixes: Vec<String>,
    /// `nav_msgs/Odometry`.
    pub odometry: Vec<String>,
}

/// Finds the stereo pair. `left` and `right` are the user's choice; with one of them given, the other is the topic that
/// fits it best. Depth and the like are no pair unless they are named. Rectified colour is preferred to rectified grey,
/// and that to unrectified images; raw messages are preferred to compressed ones.
pub fn find_stereo(topics: &[Topic], left: Option<&str>, right: Option<&str>) -> Result<StereoTopics, TopicError> {
    let images: Vec<&Topic> = topics.iter().filter(|topic| is_typed_as_image(topic)).collect();
    if images.is_empty() {
        return Err(TopicError::NoImages { topics: list_topics(topics), advice: advice_without_images(topics) });
    }
    let names = || images.iter().map(|topic| topic.name.clone()).collect();
    let chosen = |name: &str| {
        let topic = images.iter().copied().find(|topic| topic.name == name);
        topic.ok_or_else(|| TopicError::Missing { wanted: name.to_owned(), images: names() })
    };
    let (left, right) = (left.map(chosen).transpose()?, right.map(chosen).transpose()?);
    let (left, right) = match (left, right) {
        (Some(left), Some(right)) => (left, right),
        _ => best_pair(&images, left, right)?,
    };
    if left == right {
        return Err(TopicError::Same { topic: left.name.clone(), images: names() });
    }
    if left.type_name != right.type_name {
        return Err(TopicError::Unlike { left: left.name.clone(), right: right.name.clone() });
    }
    Ok(StereoTopics {
        left_image: left.name.clone(),
        right_image: right.name.clone(),
        left_info: info_topic(topics, &left.name),
        right_info: info_topic(topics, &right.name),
        compressed: left.type_name == CompressedImage::TYPE,
    })
}

/// Finds the topics of other sensors.
pub fn find_sensors(topics: &[Topic]) -> SensorTopics {
    let names_of_type = |type_name: &str| {
        topics.iter().filter(|topic| topic.type_name == type_name).map(|topic| topic.name.clone()).collect()
    };
    SensorTopics {
        imu: names_of_type(Imu::TYPE),
        fixes: names_of_type(NavSatFix::TYPE),
        odometry: names_of_type(Odometry::TYPE),
    }
}

fn best_pair<'a>(
    images: &[&'a Topic],
    left: Option<&Topic>,
    right: Option<&Topic>,
) -> Result<(&'a Topic, &'a Topic), TopicError> {
    let allowed = |wanted: Option<&Topic>, topic: &Topic| match wanted {
        Some(wanted) => wanted == topic,
        None => !is_derived(&topic.name),
    };
    let mut pairs = Vec::new();
    for &l in images.iter().filter(|topic| allowed(left, topic)) {
        for &r in images.iter().filter(|topic| allowed(right, topic) && topic.type_name == l.type_name) {
            if let Some(sides) = sides(&l.name, &r.name) {
                let empty = l.messages == Some(0) || r.messages == Some(0);
                let compressed = l.type_name == CompressedImage::TYPE;
                let hint = hints_at_derived(&l.name) || hints_at_derived(&r.name);
                pairs.push(((empty, hint, sides, image_rank(&l.name), compressed), l, r));
            }
        }
    }
    let Some(best) = pairs.iter().map(|&(rank, ..)| rank).min() else {
        let (hidden, images) = images.iter().map(|topic| topic.name.clone()).partition(|name| is_derived(name));
        return Err(TopicError::NoPair { images, hidden });
    };
    pairs.retain(|&(rank, ..)| rank == best);
    match pairs[..] {
        [(_, left, right)] => Ok((left, right)),
        _ => {
            let pairs = pairs.iter().map(|(_, left, right)| format!("{} and {}", left.name, right.name)).collect();
            Err(TopicError::Several { pairs })
        }
    }
}

/// How two names differ in their side, the surest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Sides {
    Words,
    Letters,
    /// The left camera's number; the right one's is the next.
    Numbers(u8),
}

/// How `left` and `right` differ, if it is in their side alone.
fn sides(left: &str, right: &str) -> Option<Sides> {
    let (left, right) = (words(left), words(right));
    if left.len() != right.len() {
        return None;
    }
    let mut differences = left.iter().zip(&right).filter(|(l, r)| l != r).map(|(l, r)| side(l, r));
    let first = differences.next()??;
    differences.all(|other| other == Some(first)).then_some(first)
}

/// How two words differ in their side, if they do.
fn side(left: &str, right: &str) -> Option<Sides> {
    match (left.parse::<u8>(), right.parse::<u8>()) {
        (Ok(l), Ok(r)) => (left.len() == right.len() && l < 3 && r == l + 1).then_some(Sides::Numbers(l)),
        _ if left.contains("left") => (left.replacen("left", "right", 1) == right).then_some(Sides::Words),
        _ => (left == "l" && right == "r").then_some(Sides::Letters),
    }
}

/// The runs of letters, of digits, and of other characters in a name, in lower case.
fn words(name: &str) -> Vec<String> {
    let kind = |c: char| (c.is_alphabetic(), c.is_ascii_digit());
    let mut words: Vec<String> = Vec::new();
    let mut last = None;
    for c in name.to_lowercase().chars() {
        match words.last_mut() {
            Some(word) if last == Some(kind(c)) => word.push(c),
            _ => words.push(c.to_string()),
        }
        last = Some(kind(c));
    }
    words
}

/// The kind of images that a name says, the most useful first: rectified colour, rectified, colour, other.
fn image_rank(name: &str) -> u8 {
    let name = name.to_ascii_lowercase();
    match (name.contains("rect") && !name.contains("unrect"), name.contains("color") || name.contains("colour")) {
        (true, true) => 0,
        (true, false) => 1,
        (false, true) => 2,
        (false, false) => 3,
    }
}
