//! A file: its topics, and the chunks that its messages are read from.

use super::decode::{ChunkDecoder, count_messages};
use super::summary::read_summary;
use super::walk::Walk;
use crate::recording::buffer::Buffer;
use crate::recording::chunk::ChunkAt;
use crate::recording::container::{Blocks, Container};
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::file::{SharedFile, Source};
use crate::recording::read_ahead::ReadAhead;
use crate::recording::topic::{self, Topic};
use crate::recording::unpack::Unpacker;
use mcap::records::Statistics;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The first and last bytes of a file.
pub(crate) const MAGIC: &[u8] = mcap::MAGIC;

/// A file whose structure was found sound.
#[derive(Debug)]
pub(crate) struct Mcap {
    path: PathBuf,
    bytes: u64,
    /// When its first and last message were received, nanoseconds.
    span_ns: Option<(i64, i64)>,
    topics: Vec<Topic>,
    /// The topic of each channel.
    channels: BTreeMap<u16, usize>,
    chunks: Vec<ChunkAt>,
}

impl Mcap {
    /// Walks the file from magic to magic. Chunks are decompressed only where nothing else tells the channels.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut source = Source::open(path)?;
        source.skip(MAGIC.len() as u64, "the file's magic")?;
        let mut walk = Walk::of_data_section(&mut source)?;
        let statistics = read_summary(&mut source, &mut walk.channels)?;
        if let Some(statistics) = &statistics {
            check_statistics(&source, &walk, statistics)?;
        }
        let counts = message_counts(&source, &mut walk, statistics)?;
        let (mut topics, mut channels) = (Vec::new(), BTreeMap::new());
        for (id, name, type_name, encoding) in walk.channels.iter() {
            let place = topic::find_or_add(&mut topics, name, type_name, encoding);
            let messages = counts.as_ref().map(|counts| counts.get(&id).copied().unwrap_or(0));
            topic::add_messages(&mut topics[place], messages);
            channels.insert(id, place);
        }
        let (bytes, span_ns, chunks) = (source.len(), walk.span_ns, walk.chunks);
        Ok(Self { path: path.to_owned(), bytes, span_ns, topics, channels, chunks })
    }
}

impl Container for Mcap {
    fn topics(&self) -> &[Topic] {
        &self.topics
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn first_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.0)
    }

    fn last_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.1)
    }

    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let topic = |place: usize| (wanted[place].then_some(place), self.topics[place].encoding);
        let channels = self.channels.iter().map(|(&id, &place)| (id, topic(place))).collect();
        let decoder = ChunkDecoder { path: self.path.clone(), channels };
        Ok(Box::new(ReadAhead::new(SharedFile::open(&self.path)?, self.chunks.clone(), decoder)))
    }
}

/// Compares the walk with the file's statistics. Records of unknown opcodes are passed over, as the format demands, so
/// a damaged opcode shows only here.
fn check_statistics(source: &Source, walk: &Walk, statistics: &Statistics) -> Result<(), ReadError> {
    let messages: u64 = walk.counts.values().sum();
    let same_chunks = u64::from(statistics.chunk_count) == walk.real_chunks;
    if same_chunks && (!walk.is_indexed() || statistics.message_count == messages) {
        return Ok(());
    }
    let expected =
        format!("{} chunks and {} messages, as its statistics say", statistics.chunk_count, statistics.message_count);
    let found = format!("{} chunks and {messages} messages in indices or bare", walk.real_chunks);
    Err(ReadError::unexpected(source.path(), source.at(), expected, found, DAMAGED))
}

/// The count of messages by channel; `None` where the file does not have it. Decodes every chunk where the channels are
/// not all known.
fn message_counts(
    source: &Source,
    walk: &mut Walk,
    statistics: Option<Statistics>,
) -> Result<Option<BTreeMap<u16, u64>>, ReadError> {
    let channel_count = statistics.as_ref().map(|statistics| statistics.channel_count as usize);
    let all_known = walk.counts.keys().all(|&channel| walk.channels.knows(channel));
    if all_known && walk.is_indexed() {
        return Ok(Some(std::mem::take(&mut walk.counts)));
    }
    if all_known && channel_count == Some(walk.channels.len()) {
        return Ok(statistics.map(|statistics| statistics.channel_message_counts));
    }
    let file = SharedFile::open(source.path())?;
    let (mut unpacker, mut data, mut counts) = (Unpacker::default(), Buffer::default(), BTreeMap::new());
    for at in &walk.chunks {
        data.clear();
        unpacker.unpack(&file, at, &mut data)?;
        count_messages(file.path(), at, &data, &mut walk.channels, &mut counts)?;
    }
    Ok(Some(counts))
}
