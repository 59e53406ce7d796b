//! A recording of one or several files, read as one stream.

use super::block::Block;
use super::container::{Blocks, Container};
use super::error::ReadError;
use super::topic::{self, Encoding, Topic};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// How far reading has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Bytes of the files that have been read.
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
    parts: Vec<Box<dyn Container>>,
    topics: Vec<Topic>,
    /// For each part, the place in `topics` of each of its topics.
    places: Vec<Vec<usize>>,
    notes: Vec<String>,
}

impl Recording {
    /// One recording of several parts; its errors call it `path`.
    pub(crate) fn from_parts(path: &Path, mut parts: Vec<Box<dyn Container>>, notes: Vec<String>) -> Self {
        // In order of time, whatever the order of a list or of names. Those without a message come last.
        parts.sort_by_key(|part| part.first_ns().unwrap_or(i64::MAX));
        let mut topics = Vec::new();
        let mut merge = |part: &Topic| {
            let place = topic::find_or_add(&mut topics, &part.name, &part.type_name, part.encoding);
            topic::add_messages(&mut topics[place], part.messages);
            place
        };
        let places = parts.iter().map(|part| part.topics().iter().map(&mut merge).collect()).collect();
        Self { path: path.to_owned(), parts, topics, places, notes }
    }

    /// The parts, to make one recording of several.
    pub(crate) fn into_parts(self) -> Vec<Box<dyn Container>> {
        self.parts
    }

    /// What is unusual about its files, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Its topics, in the container's order.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The size of its files in bytes.
    pub fn bytes(&self) -> u64 {
        self.parts.iter().map(|part| part.bytes()).sum()
    }

    /// When its first message was received, nanoseconds since 1970; `None` where it has none.
    pub fn first_ns(&self) -> Option<i64> {
        self.parts.iter().filter_map(|part| part.first_ns()).min()
    }

    /// When its last message was received, nanoseconds since 1970; `None` where it has none.
    pub fn last_ns(&self) -> Option<i64> {
        self.parts.iter().filter_map(|part| part.last_ns()).max()
    }

    /// Whether one of its files has messages of both topics, so that one recorder received them.
    pub fn has_in_one_file(&self, one: &str, other: &str) -> bool {
        let has = |part: &dyn Container, name: &str| {
            part.topics().iter().any(|topic| topic.name == name && topic.messages != Some(0))
        };
        self.parts.iter().any(|part| has(&**part, one) && has(&**part, other))
    }

    /// Hands every message of the `wanted` topics to `each`, in order of receive time within each chunk and across
    /// files; chunks follow each other as they were written. `progress` is called after every few. Returns what `each`
    /// broke off with.
    ///
    /// A few chunks are in memory at a time, whatever the recording's length; they are read ahead and unpacked on the
    /// threads of rayon's pool. Messages before a damaged chunk are
    /// handed over before its error.
    pub fn read<B>(
        &self,
        wanted: &[&str],
        progress: &mut dyn FnMut(Progress),
        each: &mut dyn FnMut(RawMessage<'_>) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, ReadError> {
        for name in wanted {
            self.check_topic(name)?;
        }
        let mut readers: Vec<PartReader<'_>> = self.parts.iter().map(|part| PartReader::new(&**part)).collect();
        let wanted = |topic: &Topic| wanted.contains(&topic.name.as_str());
        while let Some(place) = next_reader(&readers) {
            let reader = &mut readers[place];
            if reader.next == reader.block.entries.len() {
                reader.fill(&wanted)?;
                let bytes_read = readers.iter().map(PartReader::bytes_read).sum();
                progress(Progress { bytes_read, bytes_total: self.bytes() });
                continue;
            }
            let entry = &reader.block.entries[reader.next];
            reader.next += 1;
            let topic = &self.topics[self.places[place][entry.topic]];
            let bytes = &reader.block.bytes[entry.bytes.clone()];
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
struct PartReader<'a> {
    part: &'a dyn Container,
    blocks: Option<Box<dyn Blocks>>,
    block: Block,
    next: usize,
    done: bool,
}

impl<'a> PartReader<'a> {
    fn new(part: &'a dyn Container) -> Self {
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
        let used = std::mem::take(&mut self.block);
        self.next = 0;
        match blocks.next(used)? {
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

/// The reader whose message is next; at equal times, that of the earlier part.
fn next_reader(readers: &[PartReader<'_>]) -> Option<usize> {
    let times = readers.iter().enumerate().filter_map(|(place, reader)| Some((reader.next_ns()?, place)));
    times.min().map(|(_, place)| place)
}
