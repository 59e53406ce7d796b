//! Where images come from: a recording's topics or an image folder. All hand out the same items.

use crate::folder::{ImageFile, SingleFolder, StereoFolder, holds_pairs};
use crate::message::{CameraInfo, CompressedImage, Image, Imu, NavSatFix, Odometry};
use crate::traversal::sensors::Reading;
use crate::traversal::{IngestError, IngestRequest};
use crate::recording::{Progress, RawMessage, Recording, open, open_many};
use crate::topics::{SensorTopics, StereoTopics, find_sensors, find_stereo};
use furrow_catalog::images::{
    BayerPattern, ImageError, RawImage, RawPixels, Rectifier, Side, StereoCalibration, inspect, read_calibration_files,
};
use furrow_catalog::{Cameras, Views, ViewsRecord};
use furrow_model::{CameraCalibration, GreyImage};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// An opened recording or folder.
pub(crate) struct Source {
    pub path: PathBuf,
    kind: Kind,
}

enum Kind {
    Recording(Box<Streams>),
    Folder(Box<StereoFolder>),
    Single(Box<SingleFolder>),
}

/// A recording and the topics that are read from it.
struct Streams {
    recording: Recording,
    stereo: StereoTopics,
    sensors: SensorTopics,
}

/// An image as recorded.
pub(crate) enum Picture {
    /// A JPEG or PNG file.
    Compressed(Vec<u8>),
    /// Raw pixels.
    Raw { width: usize, height: usize, step: usize, encoding: String, big_endian: bool, data: Vec<u8> },
}

/// What a source hands out, in the order of the recording.
pub(crate) enum Item {
    /// An image.
    Image { side: Side, stamp_ns: i64, picture: Picture },
    /// Another sensor's message.
    Sensor { topic: String, reading: Reading },
}

impl Picture {
    /// The image's bytes as they are stored, and its rectified grey view; decoded once.
    pub fn store_and_view(self, side: Side, views: &Views) -> Result<(Vec<u8>, GreyImage), ImageError> {
        match self {
            Self::Compressed(bytes) => views.grey(side, &bytes).map(|view| (bytes, view)),
            Self::Raw { width, height, step, encoding, big_endian, data } => {
                let image = RawImage { width, height, step, encoding: &encoding, big_endian, data: &data };
                let pixels = RawPixels::of(&image)?;
                Ok((pixels.store()?.bytes, views.grey_of_pixels(side, &pixels)?))
            }
        }
    }

    /// Columns and rows.
    fn size(&self) -> Result<(u32, u32), ImageError> {
        match self {
            Self::Compressed(bytes) => inspect(bytes).map(|header| (header.width as u32, header.height as u32)),
            Self::Raw { width, height, .. } => Ok((*width as u32, *height as u32)),
        }
    }

    fn bayer(&self) -> Option<BayerPattern> {
        let Self::Raw { encoding, .. } = self else { return None };
        match encoding.as_str() {
            "bayer_rggb8" => Some(BayerPattern::Rggb),
            "bayer_bggr8" => Some(BayerPattern::Bggr),
            "bayer_gbrg8" => Some(BayerPattern::Gbrg),
            "bayer_grbg8" => Some(BayerPattern::Grbg),
            _ => None,
        }
    }
}

impl Source {
    /// Opens what the request names.
    pub fn open(request: &IngestRequest) -> Result<Self, IngestError> {
        let path = request.files.first().cloned().unwrap_or_default();
        if path.is_dir() && !path.join("metadata.yaml").is_file() {
            if holds_pairs(&path)? {
                return Ok(Self { kind: Kind::Folder(Box::new(StereoFolder::open(&path)?)), path });
            }
            let single = SingleFolder::open(&path, request.field_of_view_deg)?;
            return Ok(Self { kind: Kind::Single(Box::new(single)), path });
        }
        if request.field_of_view_deg.is_some() {
            return Err(IngestError::Request(
                "a field of view is assumed of a folder with a single camera's images only".to_owned(),
            ));
        }
        let recording = if request.files.len() == 1 { open(&path)? } else { open_many(&request.files)? };
        let stereo = find_stereo(recording.topics(), request.left.as_deref(), request.right.as_deref())
            .map_err(|source| IngestError::Topics { path: path.clone(), source: Box::new(source) })?;
        let sensors = find_sensors(recording.topics());
        Ok(Self { kind: Kind::Recording(Box::new(Streams { recording, stereo, sensors })), path })
    }

    /// The left images' topic or folder.
    pub fn left_name(&self) -> String {
        match &self.kind {
            Kind::Recording(streams) => streams.stereo.left_image.clone(),
            Kind::Folder(_) => "image folder, left".to_owned(),
            Kind::Single(_) => "image folder".to_owned(),
        }
    }

    /// The right images' topic or folder; `None` for a single camera.
    pub fn right_name(&self) -> Option<String> {
        match &self.kind {
            Kind::Recording(streams) => Some(streams.stereo.right_image.clone()),
            Kind::Folder(_) => Some("image folder, right".to_owned()),
            Kind::Single(_) => None,
        }
    }

    /// The file that an image lies in: the folder's own, or the recording.
    pub fn file_of(&self, side: Side, stamp_ns: i64) -> PathBuf {
        let found = match &self.kind {
            Kind::Recording(_) => None,
            Kind::Folder(folder) => {
                let pair = folder.pairs.iter().find(|pair| pair.stamp_ns == stamp_ns);
                pair.map(|pair| if side == Side::Left { &pair.left } else { &pair.right })
            }
            Kind::Single(folder) => {
                folder.images.iter().find(|image| image.stamp_ns == stamp_ns).map(|image| &image.path)
            }
        };
        found.unwrap_or(&self.path).clone()
    }

    /// How its images become rectified views: from the request's calibration files, else from its own.
    pub fn views(&self, request: &IngestRequest) -> Result<ViewsRecord, IngestError> {
        let (recording, stereo) = match &self.kind {
            Kind::Recording(streams) => (&streams.recording, &streams.stereo),
            Kind::Folder(folder) => return folder_views(folder, request),
            Kind::Single(folder) => return single_views(self, folder, request),
        };
        let firsts = first_images(self, recording, stereo)?;
        let calibration = if request.calibration.is_empty() {
            let infos = first_infos(self, recording, stereo)?;
            let rectified_topics =
                [&stereo.left_image, &stereo.right_image].iter().all(|topic| topic.contains("image_rect"));
            if rectified_topics {
                Rectifier::for_rectified_topic(&infos[0], &infos[1])?.record().clone()
            } else {
                Rectifier::new(&infos[0], &infos[1])?.record().clone()
            }
        } else {
            read_calibration_files(&request.calibration)?
        };
        let (width, height) = firsts[0].size().map_err(|source| IngestError::Image {
            path: self.path.clone(),
            side: Side::Left,
            stamp_ns: 0,
            source: Box::new(source),
        })?;
        Ok(ViewsRecord {
            calibration: Cameras::Pair(Box::new(fitted(calibration, width, height)?)),
            left_bayer: firsts[0].bayer(),
            right_bayer: firsts[1].bayer(),
        })
    }

    /// Hands every item to `each`, in order. `progress` is told (bytes read, bytes in all).
    pub fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError> {
        match &self.kind {
            Kind::Recording(streams) => {
                let Streams { recording, stereo, sensors } = &**streams;
                let mut wanted = vec![stereo.left_image.as_str(), stereo.right_image.as_str()];
                wanted.extend(sensors.imu.iter().chain(&sensors.fixes).chain(&sensors.odometry).map(String::as_str));
                let mut told = |p: Progress| progress(p.bytes_read, p.bytes_total);
                let read = recording.read(&wanted, &mut told, &mut |message| {
                    let item = self.item(stereo, sensors, message);
                    match item.and_then(&mut *each) {
                        Ok(ControlFlow::Continue(())) => ControlFlow::Continue(()),
                        Ok(ControlFlow::Break(())) => ControlFlow::Break(Ok(())),
                        Err(error) => ControlFlow::Break(Err(error)),
                    }
                })?;
                match read {
                    ControlFlow::Break(end) => end,
                    ControlFlow::Continue(()) => Ok(()),
                }
            }
            Kind::Folder(folder) => {
                let total = folder.pairs.len() as u64;
                let mut image = |side, stamp_ns, path: &Path| {
                    let bytes = fs::read(path).map_err(|source| IngestError::File { path: path.to_owned(), source })?;
                    each(Item::Image { side, stamp_ns, picture: Picture::Compressed(bytes) })
                };
                for (i, pair) in folder.pairs.iter().enumerate() {
                    for (side, path) in [(Side::Left, &pair.left), (Side::Right, &pair.right)] {
                        if image(side, pair.stamp_ns, path)?.is_break() {
                            return Ok(());
                        }
                    }
                    progress(i as u64 + 1, total);
                }
                for unpaired in &folder.unpaired {
                    if image(unpaired.side, unpaired.stamp_ns, &unpaired.path)?.is_break() {
                        return Ok(());
                    }
                }
                Ok(())
            }
            Kind::Single(folder) => {
                for (i, ImageFile { stamp_ns, path }) in folder.images.iter().enumerate() {
                    let bytes = fs::read(path).map_err(|source| IngestError::File { path: path.clone(), source })?;
                    let picture = Picture::Compressed(bytes);
                    if each(Item::Image { side: Side::Left, stamp_ns: *stamp_ns, picture })?.is_break() {
                        return Ok(());
                    }
                    progress(i as u64 + 1, folder.images.len() as u64);
                }
                Ok(())
            }
        }
    }

    fn item(
        &self,
        stereo: &StereoTopics,
        sensors: &SensorTopics,
        message: RawMessage<'_>,
    ) -> Result<Item, IngestError> {
        let topic = message.topic.name.as_str();
        let (encoding, bytes) = (message.topic.encoding, message.bytes);
        let wrong = |source| IngestError::Message {
            path: self.path.clone(),
            topic: topic.to_owned(),
            receive_ns: message.receive_ns,
            source: Box::new(source),
        };
        if topic == stereo.left_image || topic == stereo.right_image {
            let side = if topic == stereo.left_image { Side::Left } else { Side::Right };
            let (stamp_ns, picture) = self.picture(stereo, message)?;
            return Ok(Item::Image { side, stamp_ns, picture });
        }
        let is = |names: &[String]| names.iter().any(|name| name == topic);
        let reading = if is(&sensors.imu) {
            Reading::of_imu(&Imu::decode(encoding, bytes).map_err(wrong)?)
        } else if is(&sensors.fixes) {
            Reading::of_fix(&NavSatFix::decode(encoding, bytes).map_err(wrong)?)
        } else {
            Reading::of_odometry(&Odometry::decode(encoding, bytes).map_err(wrong)?)
        };
        Ok(Item::Sensor { topic: topic.to_owned(), reading })
    }

    fn picture(&self, stereo: &StereoTopics, message: RawMessage<'_>) -> Result<(i64, Picture), IngestError> {
        let wrong = |source| IngestError::Message {
            path: self.path.clone(),
            topic: message.topic.name.clone(),
            receive_ns: message.receive_ns,
            source: Box::new(source),
        };
        if stereo.compressed {
            let image = CompressedImage::decode(message.topic.encoding, message.bytes).map_err(wrong)?;
            return Ok((image.header.stamp_ns, Picture::Compressed(image.data.to_vec())));
        }
        let image = Image::decode(message.topic.encoding, message.bytes).map_err(wrong)?;
        let picture = Picture::Raw {
            width: image.width as usize,
            height: image.height as usize,
            step: image.step as usize,
            encoding: image.encoding.to_owned(),
            big_endian: image.is_bigendian,
            data: image.data.to_vec(),
        };
        Ok((image.header.stamp_ns, picture))
    }
}

/// How a folder's images become rectified views: from the request's calibration files, else from its own.
fn folder_views(folder: &StereoFolder, request: &IngestRequest) -> Result<ViewsRecord, IngestError> {
    let calibration = if request.calibration.is_empty() {
        folder.calibration.clone()
    } else {
        read_calibration_files(&request.calibration)?
    };
    Ok(ViewsRecord { calibration: Cameras::Pair(Box::new(calibration)), left_bayer: None, right_bayer: None })
}

/// How a single camera's images are looked at: as they are.
fn single_views(source: &Source, folder: &SingleFolder, request: &IngestRequest) -> Result<ViewsRecord, IngestError> {
    if !request.calibration.is_empty() {
        return Err(IngestError::Request(format!(
            "{}: --calibration takes the calibration of a pair; put a calibration.json beside a single camera's images",
            source.path.display()
        )));
    }
    Ok(ViewsRecord {
        calibration: Cameras::Single(Box::new(folder.camera.clone())),
        left_bayer: None,
        right_bayer: None,
    })
}

/// The calibration for images of this size, where it was made for another.
fn fitted(calibration: StereoCalibration, width: u32, height: u32) -> Result<StereoCalibration, IngestError> {
    if (calibration.left.width, calibration.left.height) == (width, height) {
        return Ok(calibration);
    }
    Ok(calibration.fit_to_images(width, height)?)
}

/// The first message of each of two topics, as `decode` sees them.
fn firsts<T>(
    recording: &Recording,
    topics: [&str; 2],
    decode: impl Fn(RawMessage<'_>) -> Result<T, IngestError>,
) -> Result<[Option<T>; 2], IngestError> {
    let mut found = [None, None];
    let read = recording.read(&topics, &mut |_| {}, &mut |message| {
        let place = usize::from(message.topic.name == topics[1]);
        if found[place].is_none() {
            match decode(message) {
                Ok(value) => found[place] = Some(value),
                Err(error) => return ControlFlow::Break(Some(error)),
            }
        }
        if found.iter().all(Option::is_some) { ControlFlow::Break(None) } else { ControlFlow::Continue(()) }
    })?;
    match read {
        ControlFlow::Break(Some(error)) => Err(error),
        _ => Ok(found),
    }
}

fn first_images(source: &Source, recording: &Recording, stereo: &StereoTopics) -> Result<[Picture; 2], IngestError> {
    let topics = [stereo.left_image.as_str(), stereo.right_image.as_str()];
    let found = firsts(recording, topics, |message| source.picture(stereo, message).map(|(_, picture)| picture))?;
    let [left, right] = found;
    let counts = [u64::from(left.is_some()), u64::from(right.is_some())];
    match (left, right) {
        (Some(left), Some(right)) => Ok([left, right]),
        _ => Err(IngestError::NoPairs { path: source.path.clone(), left: counts[0], right: counts[1] }),
    }
}

fn first_infos(
    source: &Source,
    recording: &Recording,
    stereo: &StereoTopics,
) -> Result<[CameraCalibration; 2], IngestError> {
    let none = || IngestError::Uncalibrated {
        path: source.path.clone(),
        topics: format!("{} and {}", stereo.left_image, stereo.right_image),
    };
    let (Some(left), Some(right)) = (&stereo.left_info, &stereo.right_info) else { return Err(none()) };
    let [left, right] = firsts(recording, [left, right], |message| {
        let info = CameraInfo::decode(message.topic.encoding, message.bytes).and_then(|info| info.calibration());
        info.map_err(|wrong| IngestError::Message {
            path: source.path.clone(),
            topic: message.topic.name.clone(),
            receive_ns: message.receive_ns,
            source: Box::new(wrong),
        })
    })?;
    left.zip(right).map(|(left, right)| [left, right]).ok_or_else(none)
}
