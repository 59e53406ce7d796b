//! A recording made longer: driven forth and back, again and again.

use mcap::{Message, MessageStream, Writer};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// From the last message of a lap to the first of the next.
const PAUSE_NS: u64 = 50_000_000;

/// Writes `from`, an MCAP file of ROS2 messages that begin with a header, `laps` times over to `to`. Every second lap
/// is driven backwards, so that the robot never jumps; receive times and stamps go on.
pub fn repeated(from: &Path, to: &Path, laps: u64) {
    let bytes = std::fs::read(from).unwrap();
    let messages: Vec<Message> = MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
    let (first, last) = messages
        .iter()
        .fold((u64::MAX, 0), |(first, last), message| (first.min(message.log_time), last.max(message.log_time)));
    let mut writer = Writer::new(BufWriter::new(File::create(to).unwrap())).unwrap();
    for lap in 0..laps {
        let start = first + lap * (last - first + PAUSE_NS);
        let time = |message: &Message| {
            start + if lap.is_multiple_of(2) { message.log_time - first } else { last - message.log_time }
        };
        let mut lap: Vec<(u64, &Message)> = messages.iter().map(|message| (time(message), message)).collect();
        lap.sort_by_key(|(time, _)| *time);
        for (time, message) in lap {
            let mut message = message.clone();
            let later_ns = time as i64 - message.log_time as i64;
            (message.log_time, message.publish_time) = (time, time);
            shift_stamp(message.data.to_mut(), later_ns);
            writer.write(&message).unwrap();
        }
    }
    writer.finish().unwrap();
}

/// Moves the stamp of a CDR message's header: seconds and nanoseconds behind the four bytes of encapsulation.
fn shift_stamp(data: &mut [u8], later_ns: i64) {
    let part = |bytes: &[u8]| i64::from(u32::from_le_bytes(bytes.try_into().unwrap()));
    let stamp_ns = part(&data[4..8]) * 1_000_000_000 + part(&data[8..12]) + later_ns;
    data[4..8].copy_from_slice(&((stamp_ns / 1_000_000_000) as u32).to_le_bytes());
    data[8..12].copy_from_slice(&((stamp_ns % 1_000_000_000) as u32).to_le_bytes());
}
