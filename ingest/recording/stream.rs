//! A recording of one or several files, read as one stream.

use super::block::{Block, Blocks};
use super::db3::Db3;
use super::error::ReadError;
use super::mcap_file::Mcap;
use super::ros1_bag::Bag;
use super::topic::{self, Encoding, Topic};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// One file of a recording.
#[derive(Debug)]
pub(crate) enum Part {
    Ros1(Bag),
    Mcap(Mcap),
    Db3(Db3),
}

impl Part {
    pub(crate) fn topics(&self) -> &[Topic] {
        match self {
            Part::Ros1(part) => &part.topics,
            Part::Mcap(part) => &part.topics,
            Part::Db3(part) => &part.topics,
        }
    }

    fn bytes(&self) -> u64 {
        match self {
            Part::Ros1(part) => part.bytes,
            Part::Mcap(part) => part.bytes,
            Part::Db3(part) => part.bytes,
        }
    }

    fn first_ns(&self) -> Option<i64> {
        match self {
            Part::Ros1(part) => part.first_ns,
            Part::Mcap(part) => part.first_ns,
            Part::Db3(part) => part.first_ns,
        }
    }

    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        match self {
            Part::Ros1(part) => part.blocks(wanted),
            Part::Mcap(part) => part.blocks(wanted),
            Part::Db3(part) => part.blocks(wanted),
        }
    }
}

/// How far reading has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Bytes of the files that are behind.
    pub bytes_read: u64,
    /// Bytes of all files.
    pub bytes_total: u64,
}

/// A message as it was recorded.
#[derive(Debug, Clone, Copy)]
pub struct RawMessage<'a> {
    /// Its topic, with its type and encoding.
    pub topic: &'a Topic,
    /// When the recorder received it, nanoseconds since 1970. Never pair by it: stamps are in the header.
    pub receive_ns: i64,
    /// Its bytes.
    pub bytes: &'a [u8],
}

/// An opened recording whose structure was found sound.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    parts: Vec<Part>,
    topics: Vec<Topic>,
    /// For each part, the place in `topics` of each of its topics.
    places: Vec<Vec<usize>>,
}

impl Recording {
    /// One recording of several parts; `path` is what its errors call it.
    pub(crate) fn of_parts(path: &Path, parts: Vec<Part>) -> Self {
        let mut topics = Vec::new();
        let mut place = |of: &Topic| {
            let place = topic::place(&mut topics, &of.name, &of.type_name, of.encoding);
            topic::count(&mut topics[place], of.messages);
            place
        };
        let places = parts.iter().map(|part| part.topics().iter().map(&mut place).collect()).collect();
        Self { path: path.to_owned(), parts, topics, places }
    }

    /// The parts, to make one recording of several.
    pub(crate) fn into_parts(self) -> Vec<Part> {
        self.parts
    }

    /// Its topics, in the container's order.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The size of its files in bytes.
    pub fn bytes(&self) -> u64 {
        self.parts.iter().map(Part::bytes).sum()
    }

    /// When its first message was received, nanoseconds since 1970; `None` where it has none.
    pub fn first_ns(&self) -> Option<i64> {
        self.parts.iter().filter_map(Part::first_ns).min()
    }

    /// Hands every message of the `wanted` topics to `each`, in order of receive time within each chunk and across files; chunks
    /// follow each other as they were written. `progress` is told after every chunk. Returns what `each` broke off with.
    ///
    /// A few chunks are in memory at a time, whatever the recording's length. Messages before a damaged chunk are handed over
    /// before its error.
    pub fn read<B>(
        &self,
        wanted: &[&str],
        progress: &mut dyn FnMut(Progress),
        each: &mut dyn FnMut(RawMessage<'_>) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, ReadError> {
        for name in wanted {
            self.check_topic(name)?;
        }
        let mut lanes: Vec<Lane<'_>> = self.parts.iter().map(Lane::new).collect();
        let wanted = |topic: &Topic| wanted.contains(&topic.name.as_str());
        while let Some(place) = next_lane(&lanes) {
            let lane = &mut lanes[place];
            if lane.next == lane.block.entries.len() {
                lane.fill(&wanted)?;
                let bytes_read = lanes.iter().map(Lane::bytes_read).sum();
                progress(Progress { bytes_read, bytes_total: self.bytes() });
                continue;
            }
            let entry = &lane.block.entries[lane.next];
            lane.next += 1;
            let topic = &self.topics[self.places[place][entry.topic]];
            let bytes = &lane.block.bytes[entry.bytes.clone()];
            if let ControlFlow::Break(why) = each(RawMessage { topic, receive_ns: entry.receive_ns, bytes }) {
                return Ok(ControlFlow::Break(why));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    fn check_topic(&self, name: &str) -> Result<(), ReadError> {
        let named: Vec<&Topic> = self.topics.iter().filter(|topic| topic.name == name).collect();
        let found = if named.is_empty() {
            "it has no such topic"
        } else if named.iter().any(|topic| topic.encoding == Encoding::Unknown) {
            "its messages are encoded neither as ros1 nor as cdr"
        } else {
            return Ok(());
        };
        let known = self.topics.iter().map(|topic| topic.name.clone()).collect();
        Err(ReadError::Topic { path: self.path.clone(), wanted: name.to_owned(), found, known })
    }
}

/// A part that is being read.
struct Lane<'a> {
    part: &'a Part,
    blocks: Option<Box<dyn Blocks>>,
    block: Block,
    next: usize,
    done: bool,
}

impl<'a> Lane<'a> {
    fn new(part: &'a Part) -> Self {
        Self { part, blocks: None, block: Block::default(), next: 0, done: false }
    }

    /// When its next message was received; a part is not opened before its time has come.
    fn next_ns(&self) -> Option<i64> {
        if self.done {
            return None;
        }
        match (self.block.entries.get(self.next), &self.blocks) {
            (Some(entry), _) => Some(entry.receive_ns),
            (None, None) => Some(self.part.first_ns().unwrap_or(i64::MIN)),
            (None, Some(_)) => Some(i64::MIN),
        }
    }

    fn fill(&mut self, wanted: &dyn Fn(&Topic) -> bool) -> Result<(), ReadError> {
        let blocks = match &mut self.blocks {
            Some(blocks) => blocks,
            none => {
                let wanted: Vec<bool> = self.part.topics().iter().map(wanted).collect();
                none.insert(self.part.blocks(&wanted)?)
            }
        };
        self.block = Block::default();
        self.next = 0;
        match blocks.next()? {
            Some(block) => self.block = block,
            None => {
                self.done = true;
                self.blocks = None;
            }
        }
        Ok(())
    }

    fn bytes_read(&self) -> u64 {
        if self.done {
            self.part.bytes()
        } else {
            self.blocks.as_ref().map_or(0, |blocks| blocks.bytes_read().min(self.part.bytes()))
        }
    }
}

/// The lane whose message is next; the earlier part at equal times.
fn next_lane(lanes: &[Lane<'_>]) -> Option<usize> {
    let times = lanes.iter().enumerate().filter_map(|(place, lane)| Some((lane.next_ns()?, place)));
    times.min().map(|(_, place)| place)
}
