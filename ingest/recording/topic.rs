//! What a recording says about its topics.

/// How a message's bytes are to be decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// ROS1 serialisation: little endian, packed.
    Ros1,
    /// ROS2's CDR with its four-byte encapsulation header.
    Cdr,
    /// Anything else, as JSON or protobuf; such topics are listed but not read.
    Unknown,
}

impl Encoding {
    /// The encoding of MCAP's `message_encoding` and rosbag2's `serialization_format`.
    pub(crate) fn named(name: &str) -> Self {
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
    /// Its messages, where the container's index tells.
    pub messages: Option<u64>,
}

/// `sensor_msgs/msg/Image` and `sensor_msgs/Image` are one type: the latter.
pub(crate) fn normal_type(name: &str) -> String {
    name.replacen("/msg/", "/", 1)
}

/// The place of a topic in `topics`, added with no messages counted where it is new.
pub(crate) fn place(topics: &mut Vec<Topic>, name: &str, type_name: &str, encoding: Encoding) -> usize {
    let type_name = normal_type(type_name);
    let same = |topic: &Topic| topic.name == name && topic.type_name == type_name && topic.encoding == encoding;
    topics.iter().position(same).unwrap_or_else(|| {
        topics.push(Topic { name: name.to_owned(), type_name, encoding, messages: Some(0) });
        topics.len() - 1
    })
}

/// Adds messages to a topic's count; an unknown count stays unknown.
pub(crate) fn count(topic: &mut Topic, messages: Option<u64>) {
    topic.messages = topic.messages.zip(messages).map(|(before, more)| before.saturating_add(more));
}
