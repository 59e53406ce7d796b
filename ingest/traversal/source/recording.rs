//! A recording's stereo topics and other sensors as a source.

use super::image_source::{ImageSource, Item};
use crate::message::{CameraInfo, CompressedImage, Image, Imu, MessageError, NavSatFix, Odometry};
use crate::recording::{Progress, RawMessage, Recording, open, open_many};
use crate::topics::{SensorTopics, StereoTopics, find_sensors, find_stereo};
use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use crate::traversal::sensors::SensorRow;
use furrow_catalog::images::{PairImages, Rectifier, Side, StereoCalibration, read_calibration_files};
use furrow_catalog::records::{Cameras, ViewsRecord};
use furrow_model::CameraCalibration;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// An opened recording and the topics that are read from it.
pub(super) struct RecordingSource {
    path: PathBuf,
    recording: Recording,
    stereo: StereoTopics,
    sensors: SensorTopics,
}

impl RecordingSource {
    /// Opens the request's files as one recording, whose first is `path`, and finds its topics.
    pub(super) fn open(path: PathBuf, request: &IngestRequest) -> Result<Self, IngestError> {
        let recording = if request.files.len() == 1 { open(&path)? } else { open_many(&request.files)? };
        let stereo = find_stereo(recording.topics(), request.left.as_deref(), request.right.as_deref())
            .map_err(|source| IngestError::Topics { path: path.clone(), source: Box::new(source) })?;
        let sensors = find_sensors(recording.topics());
        Ok(Self { path, recording, stereo, sensors })
    }

    /// A message as an item.
    fn item(&self, message: RawMessage<'_>) -> Result<Item, IngestError> {
        let topic = message.topic.name.as_str();
        let (encoding, bytes) = (message.topic.encoding, message.bytes);
        if topic == self.stereo.left_image || topic == self.stereo.right_image {
            let side = if topic == self.stereo.left_image { Side::Left } else { Side::Right };
            let (stamp_ns, picture) = self.picture(message)?;
            return Ok(Item::Image { side, stamp_ns, picture });
        }
        let is_among = |names: &[String]| names.iter().any(|name| name == topic);
        let row = if is_among(&self.sensors.imu) {
            Imu::decode(encoding, bytes).map(|imu| SensorRow::of_imu(&imu))
        } else if is_among(&self.sensors.fixes) {
            NavSatFix::decode(encoding, bytes).map(|fix| SensorRow::of_fix(&fix))
        } else {
            Odometry::decode(encoding, bytes).map(|pose| SensorRow::of_odometry(&pose))
        };
        let row = row.map_err(|error| self.message_error(message, error))?;
        Ok(Item::Sensor { topic: topic.to_owned(), row })
    }

    /// An image message's header stamp and image.
    fn picture(&self, message: RawMessage<'_>) -> Result<(i64, Picture), IngestError> {
        let (encoding, bytes) = (message.topic.encoding, message.bytes);
        if self.stereo.compressed {
            let image = CompressedImage::decode(encoding, bytes).map_err(|error| self.message_error(message, error))?;
            return Ok((image.header.stamp_ns, Picture::Compressed(image.data.to_vec())));
        }
        let image = Image::decode(encoding, bytes).map_err(|error| self.message_error(message, error))?;
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

    /// The first image of each side.
    fn first_images(&self) -> Result<[Picture; 2], IngestError> {
        let topics = [self.stereo.left_image.as_str(), self.stereo.right_image.as_str()];
        let found = self.first_of_each(topics, |message| self.picture(message).map(|(_, picture)| picture))?;
        let [left, right] = found.each_ref().map(|image| u64::from(image.is_some()));
        let [Some(left_image), Some(right_image)] = found else {
            return Err(IngestError::NoPairs { path: self.path.clone(), left, right });
        };
        Ok([left_image, right_image])
    }

    /// Columns and rows of the first image of each side.
    fn sizes(&self, firsts: &[Picture; 2]) -> Result<[[u32; 2]; 2], IngestError> {
        let size = |side: Side| {
            let size = firsts[side as usize].size().map(|(width, height)| [width, height]);
            let path = self.path.clone();
            size.map_err(|source| IngestError::Image { path, side, stamp_ns: 0, source: Box::new(source) })
        };
        Ok([size(Side::Left)?, size(Side::Right)?])
    }

    /// Whether the topics' names say that their images are rectified.
    fn is_rectified(&self) -> bool {
        [&self.stereo.left_image, &self.stereo.right_image].iter().all(|topic| topic.contains("image_rect"))
    }

    /// The first `CameraInfo` of each side.
    fn first_calibrations(&self) -> Result<[CameraCalibration; 2], IngestError> {
        let uncalibrated = || IngestError::Uncalibrated {
            path: self.path.clone(),
            topics: format!("{} and {}", self.stereo.left_image, self.stereo.right_image),
        };
        let (Some(left), Some(right)) = (&self.stereo.left_info, &self.stereo.right_info) else {
            return Err(uncalibrated());
        };
        let [left, right] = self.first_of_each([left, right], |message| {
            let info = CameraInfo::decode(message.topic.encoding, message.bytes).and_then(|info| info.calibration());
            info.map_err(|error| self.message_error(message, error))
        })?;
        left.zip(right).map(|(left, right)| [left, right]).ok_or_else(uncalibrated)
    }

    /// The first message of each of two topics, decoded; `None` where a topic has none.
    fn first_of_each<T>(
        &self,
        topics: [&str; 2],
        decode: impl Fn(RawMessage<'_>) -> Result<T, IngestError>,
    ) -> Result<[Option<T>; 2], IngestError> {
        let mut found = [None, None];
        let read = self.recording.read(&topics, &mut |_| {}, &mut |message| {
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

    fn message_error(&self, message: RawMessage<'_>, error: MessageError) -> IngestError {
        IngestError::Message {
            path: self.path.clone(),
            topic: message.topic.name.clone(),
            receive_ns: message.receive_ns,
            source: Box::new(error),
        }
    }
}

impl ImageSource for RecordingSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn left_name(&self) -> String {
        self.stereo.left_image.clone()
    }

    fn right_name(&self) -> Option<String> {
        Some(self.stereo.right_image.clone())
    }

    fn file_of(&self, _side: Side, _stamp_ns: i64) -> PathBuf {
        self.path.clone()
    }

    fn calibrate(&self, request: &IngestRequest, _notes: &Notes) -> Result<ViewsRecord, IngestError> {
        let firsts = self.first_images()?;
        let [left_size, right_size] = self.sizes(&firsts)?;
        let calibration = if request.calibration.is_empty() {
            let [left, right] = self.first_calibrations()?;
            let rectifier = if self.is_rectified() {
                Rectifier::for_rectified_topic(&left, &right)?
            } else {
                Rectifier::new(&left, &right)?
            };
            rectifier.record().clone()
        } else {
            let are_rectified = self.is_rectified();
            let images = PairImages { left: left_size, right: right_size, kitti_cameras: [0, 1], are_rectified };
            read_calibration_files(&request.calibration, Some(&images))?
        };
        let [width, height] = left_size;
        Ok(ViewsRecord {
            calibration: Cameras::Pair(Box::new(fit_calibration(calibration, width, height)?)),
            left_bayer: firsts[0].bayer_pattern(),
            right_bayer: firsts[1].bayer_pattern(),
        })
    }

    fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError> {
        let mut wanted = vec![self.stereo.left_image.as_str(), self.stereo.right_image.as_str()];
        let SensorTopics { imu, fixes, odometry } = &self.sensors;
        wanted.extend(imu.iter().chain(fixes).chain(odometry).map(String::as_str));
        let mut report_progress = |read: Progress| progress(read.bytes_read, read.bytes_total);
        let read = self.recording.read(&wanted, &mut report_progress, &mut |message| match self
            .item(message)
            .and_then(&mut *each)
        {
            Ok(ControlFlow::Continue(())) => ControlFlow::Continue(()),
            Ok(ControlFlow::Break(())) => ControlFlow::Break(Ok(())),
            Err(error) => ControlFlow::Break(Err(error)),
        })?;
        match read {
            ControlFlow::Break(end) => end,
            ControlFlow::Continue(()) => Ok(()),
        }
    }
}

/// The calibration for images of this size, scaled where it was made for another.
fn fit_calibration(calibration: StereoCalibration, width: u32, height: u32) -> Result<StereoCalibration, IngestError> {
    if (calibration.left.width, calibration.left.height) == (width, height) {
        return Ok(calibration);
    }
    Ok(calibration.fit_to_images(width, height)?)
}
