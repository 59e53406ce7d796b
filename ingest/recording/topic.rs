//! The topics of a recording.

/// How a message's bytes are to be decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// ROS1 serialisation: little endian, packed.
    Ros1,
    /// ROS2's CDR with its four-byte encapsulation header.
    Cdr,
    /// Anything else, such as JSON or protobuf; such topics are listed but not read.
    Unknown,
}

impl Encoding {
    /// The encoding that MCAP's `message_encoding` or rosbag2's `serialization_format` names.
    pub(crate) fn from_name(name: &str) -> Self {
        match name {
            "ros1" | "ros1msg" => Encoding::Ros1,
            "cdr" => Encoding::Cdr,
            _ => Encoding::Unknown,
        }
    }
}

/// A topic of a recording. Two types on one name are two topics.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Its name, as `/stereo/left/image_raw`.
    pub name: String,
    /// Its message type as ROS1 writes it, `sensor_msgs/Image`.
    pub type_name: String,
    /// How its messages are encoded.
    pub encoding: Encoding,
    /// The number of its messages; `None` where the container has no index.
    pub messages: Option<u64>,
}

/// `sensor_msgs/msg/Image` and `sensor_msgs/Image` are one type: the latter.
pub(crate) fn normal_type(name: &str) -> String {
    name.replacen("/msg/", "/", 1)
}

/// The place of a topic in `topics`, added without messages where it is new.
pub(crate) fn find_or_add(topics: &mut Vec<Topic>, name: &str, type_name: &str, encoding: Encoding) -> usize {
    let type_name = normal_type(type_name);
    let same = |topic: &Topic| topic.name == name && topic.type_name == type_name && topic.encoding == encoding;
    topics.iter().position(same).unwrap_or_else(|| {
        topics.push(Topic { name: name.to_owned(), type_name, encoding, messages: Some(0) });
        topics.len() - 1
    })
}

/// Adds messages to a topic's count; an unknown count stays unknown.
pub(crate) fn add_messages(topic: &mut Topic, messages: Option<u64>) {
    topic.messages = topic.messages.zip(messages).map(|(before, more)| before.saturating_add(more));
}
