//! Images that cannot be read: each costs its frame, and each is counted and named.

use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use furrow_catalog::images::Side;
use furrow_catalog::records::{UnreadableImage, UnreadableRecord};
use std::path::{Path, PathBuf};

/// Once so many frames came, one after the other, and none of them could be read, nothing better is expected.
const HOPELESS: u32 = 64;
/// Of so many frames one may be of another size than its calibration: a damaged header. More of them are a camera that
/// was set otherwise.
const OF_ANOTHER_SIZE: u32 = 10;

/// An image that cannot be read.
#[derive(Debug, Clone)]
pub(crate) struct LostImage {
    /// Its header stamp, or when it was received where there is no header.
    pub(crate) stamp_ns: i64,
    /// Which camera's.
    pub(crate) side: Side,
    /// Its file.
    pub(crate) file: PathBuf,
    /// What is wrong with it.
    pub(crate) fault: String,
}

/// A moment that gave no frame.
#[derive(Debug, Clone)]
pub(crate) struct LostMoment {
    /// Its images that cannot be read: at least one.
    pub(crate) images: Vec<LostImage>,
    /// The image that can be read and lost its partner.
    pub(crate) partner: Option<(i64, Side)>,
    /// Whether it was lost because an image is of another size than its calibration.
    pub(crate) is_of_another_size: bool,
}

/// Everything that was lost of a recording.
#[derive(Debug, Default)]
pub(crate) struct Losses {
    images: Vec<LostImage>,
    /// Images that lost their partners.
    pub(crate) partners: Vec<(i64, Side)>,
    /// Moments that gave no frame.
    pub(crate) moments: u32,
    of_another_size: u32,
}

impl Losses {
    /// Adds a moment.
    pub(crate) fn add(&mut self, lost: LostMoment) {
        self.moments += 1;
        self.of_another_size += u32::from(lost.is_of_another_size);
        self.images.extend(lost.images);
        self.partners.extend(lost.partner);
    }

    /// Adds images that no moment could be made with.
    pub(crate) fn extend(&mut self, images: Vec<LostImage>) {
        self.moments += images.len() as u32;
        self.images.extend(images);
    }

    /// Refuses a recording of which nothing could be read so far, `kept` frames being read.
    pub(crate) fn check_begin(&self, path: &Path, kept: u32) -> Result<(), IngestError> {
        if kept == 0 && self.moments >= HOPELESS { Err(self.refusal(path, kept)) } else { Ok(()) }
    }

    /// Refuses a recording of which more is lost than its frames, `kept` of which were read.
    pub(crate) fn check(&self, path: &Path, kept: u32) -> Result<(), IngestError> {
        let all = self.moments.saturating_add(kept);
        let too_many = self.moments > kept || self.of_another_size.saturating_mul(OF_ANOTHER_SIZE) > all;
        if self.moments > 0 && too_many { Err(self.refusal(path, kept)) } else { Ok(()) }
    }

    fn refusal(&self, path: &Path, kept: u32) -> IngestError {
        IngestError::Unreadable {
            path: path.to_owned(),
            lost: self.moments,
            frames: self.moments.saturating_add(kept),
            first: self.images.first().map_or_else(String::new, |image| image.described(path)),
        }
    }

    /// Notes what was lost; gives the list, in order of the stamps.
    pub(crate) fn note(mut self, path: &Path, notes: &Notes) -> UnreadableRecord {
        const NAMED: usize = 3;
        self.images.sort_by_key(|image| (image.stamp_ns, image.side));
        let count = self.images.len();
        if count == 0 {
            return UnreadableRecord::default();
        }
        let named: Vec<String> = self.images.iter().take(NAMED).map(|image| image.described(path)).collect();
        let more =
            if count > NAMED { format!("; and {} more, which --json lists", count - NAMED) } else { String::new() };
        let (images, frames) = if count == 1 { ("image", "its frame") } else { ("images", "their frames") };
        notes.add(format!("{count} unreadable {images} cost {frames}: {}{more}", named.join("; ")));
        let record = |image: LostImage| UnreadableImage {
            stamp_ns: image.stamp_ns,
            side: image.side.to_string(),
            fault: image.fault,
        };
        UnreadableRecord { images: self.images.into_iter().map(record).collect() }
    }
}

impl LostImage {
    /// In words; its file is named where it is not the recording `path` itself.
    fn described(&self, path: &Path) -> String {
        let Self { stamp_ns, side, file, fault } = self;
        if file == path {
            format!("{side} image stamped {stamp_ns} ns: {fault}")
        } else {
            format!("{side} image {} stamped {stamp_ns} ns: {fault}", file.display())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(stamp_ns: i64, is_of_another_size: bool) -> LostMoment {
        let image = LostImage { stamp_ns, side: Side::Left, file: "a.bag".into(), fault: "cut".to_owned() };
        LostMoment { images: vec![image], partner: Some((stamp_ns, Side::Right)), is_of_another_size }
    }

    fn lost(count: i64, is_of_another_size: bool) -> Losses {
        let mut losses = Losses::default();
        (0..count).for_each(|stamp_ns| losses.add(moment(stamp_ns, is_of_another_size)));
        losses
    }

    #[test]
    fn up_to_half_of_the_frames_may_be_lost() {
        let path = Path::new("a.bag");
        assert!(lost(0, false).check(path, 0).is_ok());
        for (count, kept, refused) in [(1, 0, true), (1, 1, false), (6, 6, false), (7, 6, true)] {
            assert_eq!(lost(count, false).check(path, kept).is_err(), refused, "{count} lost, {kept} kept");
        }
        let said = lost(7, false).check(path, 5).unwrap_err().to_string();
        assert!(said.contains("7 of 12 frames") && said.contains("stamped 0 ns: cut"), "{said}");
        assert!(lost(63, false).check_begin(path, 0).is_ok() && lost(64, false).check_begin(path, 0).is_err());
    }

    #[test]
    fn one_of_ten_frames_may_be_of_another_size() {
        for (count, kept, refused) in [(1, 9, false), (1, 8, true), (2, 10, true), (6, 6, true)] {
            assert_eq!(lost(count, true).check(Path::new(""), kept).is_err(), refused, "{count} lost, {kept} kept");
        }
    }
}
