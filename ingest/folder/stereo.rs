//! Folders of stereo pairs.

use super::calibration::read_pair;
use super::error::FolderError;
use super::headers::depth_of;
use super::layout::{FOLDER_PAIRS, names_in, pair_among};
use super::numbered::Numbered;
use super::times::Clock;
use crate::pairing::Pairer;
use furrow_catalog::images::{Depth, Side, StereoCalibration};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A folder of stereo images that was opened; no pixel has been read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct StereoFolder {
    /// The calibration of its images, which are rectified.
    pub calibration: StereoCalibration,
    /// The pairs, in order of their stamps.
    pub pairs: Vec<PairFiles>,
    /// Images without a partner, in order of their stamps.
    pub unpaired: Vec<UnpairedFile>,
    /// How many bits of 16-bit pixels both sides use.
    pub depth: Depth,
    /// False where stamps are nominal ([`NOMINAL_INTERVAL_NS`](super::NOMINAL_INTERVAL_NS)) because the folder has no
    /// times.
    pub stamps_are_recorded: bool,
}

/// A left and a right image of one moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairFiles {
    /// When the left image was taken: this names the pair.
    pub stamp_ns: i64,
    /// When the right image was taken.
    pub right_stamp_ns: i64,
    /// The left image's file.
    pub left: PathBuf,
    /// The right image's file.
    pub right: PathBuf,
}

/// An image whose partner is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnpairedFile {
    /// When.
    pub stamp_ns: i64,
    /// Which side *is* there.
    pub side: Side,
    /// Its file.
    pub path: PathBuf,
}

impl StereoFolder {
    /// Reads a folder's calibration, file names and times. The calibration is that of the files that are given, of
    /// which there are one or two, else that of the folder.
    ///
    /// # Errors
    /// Where a part of the layout is missing or unreadable. The error names what was looked for and what is there.
    pub fn open(folder: &Path, calibration: &[PathBuf]) -> Result<Self, FolderError> {
        let names = names_in(folder)?;
        let (left_name, right_name, cameras) = image_folders(folder, &names)?;
        let left = Numbered::read(&folder.join(left_name))?;
        let right = Numbered::read(&folder.join(right_name))?;
        let calibration = read_pair(folder, &names, cameras, &left.images, &right.images, calibration)?;
        let depth = depth_of(&[&left.images, &right.images])?;
        let clock = Clock::of(folder, &names, [&left, &right])?;
        let are_stamps = left.are_stamps;
        let (pairs, unpaired) = if are_stamps {
            pair_by_stamp(left.images, right.images)
        } else {
            pair_by_number(left.images, right.images, &clock)
        };
        if pairs.is_empty() {
            return Err(FolderError::Missing {
                folder: folder.to_owned(),
                wanted: if are_stamps {
                    format!("images in {left_name} and {right_name} with stamps within half a period of each other")
                } else {
                    format!("images of the same names in {left_name} and {right_name}")
                },
                found: format!("{} images without a partner", unpaired.len()),
            });
        }
        Ok(Self { calibration, pairs, unpaired, depth, stamps_are_recorded: clock.is_recorded() })
    }
}

/// The subfolders of the left and right images, and the numbers of their cameras.
fn image_folders<'a>(folder: &Path, names: &'a [String]) -> Result<(&'a str, &'a str, [u8; 2]), FolderError> {
    pair_among(names).ok_or_else(|| {
        let pairs = FOLDER_PAIRS.map(|(left, right, _)| format!("{left} and {right}"));
        FolderError::missing(folder, format!("folders {}", pairs.join(", or ")), names)
    })
}

/// The images of both sides and of a side alone, in order of their stamps.
pub(crate) type Sorted = (Vec<PairFiles>, Vec<UnpairedFile>);

/// Frames of equal numbers are pairs.
fn pair_by_number(left: BTreeMap<u64, PathBuf>, mut right: BTreeMap<u64, PathBuf>, clock: &Clock) -> Sorted {
    let (mut pairs, mut unpaired) = (Vec::new(), Vec::new());
    for (number, left) in left {
        let stamp_ns = clock.stamp_ns(number);
        match right.remove(&number) {
            Some(right) => pairs.push(PairFiles { stamp_ns, right_stamp_ns: stamp_ns, left, right }),
            None => unpaired.push(UnpairedFile { stamp_ns, side: Side::Left, path: left }),
        }
    }
    for (number, path) in right {
        unpaired.push(UnpairedFile { stamp_ns: clock.stamp_ns(number), side: Side::Right, path });
    }
    pairs.sort_by_key(|pair| pair.stamp_ns);
    unpaired.sort_by_key(|image| (image.stamp_ns, image.side));
    (pairs, unpaired)
}

/// Frames whose stamps are each other's nearest are pairs, as in recordings, whatever share of the names is equal.
pub(crate) fn pair_by_stamp(mut left: BTreeMap<u64, PathBuf>, mut right: BTreeMap<u64, PathBuf>) -> Sorted {
    let sided = |images: &BTreeMap<u64, PathBuf>, side| images.keys().map(|&stamp| (stamp, side)).collect::<Vec<_>>();
    let mut frames = [sided(&left, Side::Left), sided(&right, Side::Right)].concat();
    frames.sort_unstable();
    let (mut pairer, mut pairs) = (Pairer::new(), Vec::new());
    let mut take = |pairer: &mut Pairer<u64>| {
        while let Some(pair) = pairer.pop() {
            let files = left.remove(&pair.left.image).zip(right.remove(&pair.right.image));
            pairs.extend(files.map(|(left, right)| PairFiles {
                stamp_ns: pair.left.stamp_ns,
                right_stamp_ns: pair.right.stamp_ns,
                left,
                right,
            }));
        }
    };
    for (stamp, side) in frames {
        pairer.push(side, stamp.cast_signed(), stamp);
        take(&mut pairer);
    }
    pairer.finish();
    take(&mut pairer);
    let alone = |images: BTreeMap<u64, PathBuf>, side| {
        images.into_iter().map(move |(stamp, path)| UnpairedFile { stamp_ns: stamp.cast_signed(), side, path })
    };
    let mut unpaired: Vec<UnpairedFile> = alone(left, Side::Left).chain(alone(right, Side::Right)).collect();
    unpaired.sort_by_key(|image| (image.stamp_ns, image.side));
    (pairs, unpaired)
}
