//! A recording's stereo topics and other sensors as a source.

use super::camera_infos::{InfoError, InfoImages, RecordedInfo, pair_calibration};
use super::first_images::{depth_note, depth_of, first_images};
use super::image_message::image_of;
use super::image_source::{ImageSource, Item};
use super::info_watch::InfoWatch;
use crate::info_topics::{ImageKind, image_kind, listed, named_info};
use crate::message::{CameraInfo, Imu, MessageError, NavSatFix, Odometry};
use crate::recording::{Progress, RawMessage, Recording, open, open_many};
use crate::topics::{SensorTopics, StereoTopics, find_sensors, find_stereo};
use crate::traversal::error::IngestError;
use crate::traversal::lost::LostImage;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use crate::traversal::rig::note_far_centres;
use crate::traversal::sensors::SensorRow;
use furrow_catalog::images::{Depth, PairImages, Side, StereoCalibration, read_calibration_files};
use furrow_catalog::records::{Cameras, ViewsRecord};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// An opened recording and the topics that are read from it.
pub(super) struct RecordingSource {
    path: PathBuf,
    recording: Recording,
    stereo: StereoTopics,
    sensors: SensorTopics,
    /// Whether the cameras' calibration is that of their CameraInfo.
    uses_infos: bool,
    /// The first image of each side that can be read.
    firsts: [Picture; 2],
    depth: Depth,
    /// Whether an unreadable image refuses the recording.
    strict: bool,
}

impl RecordingSource {
    /// Opens the request's files as one recording, whose first is `path`, finds its topics and looks at its first
    /// images.
    pub(super) fn open(path: PathBuf, request: &IngestRequest, notes: &Notes) -> Result<Self, IngestError> {
        let recording = if request.files.len() == 1 { open(&path)? } else { open_many(&request.files)? };
        recording.notes().iter().for_each(|note| notes.add(note));
        let stereo = find_stereo(recording.topics(), request.left.as_deref(), request.right.as_deref())
            .map_err(|source| IngestError::Topics { path: path.clone(), source: Box::new(source) })?;
        let sensors = find_sensors(recording.topics());
        let firsts = first_images(&path, &recording, &stereo)?;
        let depth = depth_of(&recording, &stereo, &firsts)?;
        depth_note(depth).into_iter().for_each(|note| notes.add(note));
        let (uses_infos, strict) = (request.calibration.is_empty(), request.strict);
        let mut source = Self { path, recording, stereo, sensors, uses_infos, firsts, depth, strict };
        source.choose_infos(request)?;
        Ok(source)
    }

    /// Takes the CameraInfo topics that the user named.
    fn choose_infos(&mut self, request: &IngestRequest) -> Result<(), IngestError> {
        let refuse = |said: String| IngestError::Request(format!("{}: {said}", self.path.display()));
        let named = |option: &str, wanted: &Option<String>| {
            let named = wanted.as_ref().map(|wanted| named_info(self.recording.topics(), wanted)).transpose();
            named.map_err(|said| refuse(format!("{option}: {said}")))
        };
        let left = named("--left-info", &request.left_info)?;
        let right = named("--right-info", &request.right_info)?;
        if (left.is_some() || right.is_some()) && !self.uses_infos {
            return Err(refuse(
                "--calibration takes the place of every CameraInfo: leave out --left-info and --right-info".to_owned(),
            ));
        }
        if left.is_some() && left == right {
            return Err(refuse("--left-info and --right-info name one topic: each camera has its own".to_owned()));
        }
        self.stereo.left_info = left.or(self.stereo.left_info.take());
        self.stereo.right_info = right.or(self.stereo.right_info.take());
        Ok(())
    }

    /// A message as an item.
    fn item(&self, message: RawMessage<'_>) -> Result<Item, IngestError> {
        let topic = message.topic.name.as_str();
        let (encoding, bytes) = (message.topic.encoding, message.bytes);
        if topic == self.stereo.left_image || topic == self.stereo.right_image {
            let side = if topic == self.stereo.left_image { Side::Left } else { Side::Right };
            return match image_of(message, self.stereo.compressed) {
                Ok((stamp_ns, picture)) => {
                    Ok(Item::Image { side, pair_ns: stamp_ns, stamp_ns, receive_ns: Some(message.receive_ns), picture })
                }
                Err(error) if self.strict => Err(self.message_error(message, error)),
                Err(error) => {
                    let (stamp_ns, file, fault) = (message.receive_ns, self.path.clone(), error.to_string());
                    Ok(Item::Lost(LostImage { stamp_ns, side, file, fault }))
                }
            };
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

    /// Columns and rows of the first image of each side.
    fn sizes(&self) -> Result<[[u32; 2]; 2], IngestError> {
        let size = |side: Side| {
            let size = self.firsts[side as usize].size().map(|(width, height)| [width, height]);
            let path = self.path.clone();
            size.map_err(|source| IngestError::Image { path, side, stamp_ns: 0, source: Box::new(source) })
        };
        Ok([size(Side::Left)?, size(Side::Right)?])
    }

    /// Whether the topics' names say that their images are rectified.
    fn is_rectified(&self) -> bool {
        [&self.stereo.left_image, &self.stereo.right_image]
            .iter()
            .all(|topic| image_kind(topic) == ImageKind::Rectified)
    }

    /// The topics of the two CameraInfo, left and right.
    fn info_topics(&self) -> Result<[&str; 2], IngestError> {
        let StereoTopics { left_image, right_image, left_info, right_info, .. } = &self.stereo;
        let topics = match (left_info, right_info) {
            (Some(left), Some(right)) => return Ok([left, right]),
            (None, None) => format!("{left_image} and {right_image}"),
            (None, Some(_)) => left_image.clone(),
            (Some(_), None) => right_image.clone(),
        };
        Err(IngestError::Uncalibrated { path: self.path.clone(), topics, found: listed(self.recording.topics()) })
    }

    /// The first calibrated CameraInfo of each side, else the first.
    fn first_infos(&self) -> Result<[RecordedInfo; 2], IngestError> {
        let topics = self.info_topics()?;
        let mut found: [Option<RecordedInfo>; 2] = [None, None];
        let is_settled = |info: &Option<RecordedInfo>| info.as_ref().is_some_and(RecordedInfo::is_calibrated);
        let read = self.recording.read(&topics, &mut |_| {}, &mut |message| {
            let place = usize::from(message.topic.name == topics[1]);
            if !is_settled(&found[place]) {
                match self.info(message) {
                    Ok(info) if info.is_calibrated() || found[place].is_none() => found[place] = Some(info),
                    Ok(_) => {}
                    Err(error) => return ControlFlow::Break(Some(error)),
                }
            }
            if found.iter().all(is_settled) { ControlFlow::Break(None) } else { ControlFlow::Continue(()) }
        })?;
        if let ControlFlow::Break(Some(error)) = read {
            return Err(error);
        }
        let silent: Vec<&str> =
            topics.into_iter().zip(&found).filter(|(_, info)| info.is_none()).map(|(topic, _)| topic).collect();
        let silent = format!("the images: no message on {}", silent.join(" and "));
        let [Some(left), Some(right)] = found else {
            let found = listed(self.recording.topics());
            return Err(IngestError::Uncalibrated { path: self.path.clone(), topics: silent, found });
        };
        Ok([left, right])
    }

    /// What a CameraInfo message tells.
    fn info(&self, message: RawMessage<'_>) -> Result<RecordedInfo, IngestError> {
        let info = CameraInfo::decode(message.topic.encoding, message.bytes).and_then(|info| RecordedInfo::of(&info));
        info.map_err(|error| self.message_error(message, error))
    }

    /// The calibration that the recording's CameraInfo tells.
    fn recorded_calibration(&self, sizes: [[u32; 2]; 2], notes: &Notes) -> Result<StereoCalibration, IngestError> {
        let topics = [&self.stereo.left_image, &self.stereo.right_image];
        let images = InfoImages {
            sizes,
            are_rectified: self.is_rectified(),
            are_raw: topics.iter().all(|topic| image_kind(topic) == ImageKind::Raw),
            topics: self.info_topics()?,
        };
        pair_calibration(&self.first_infos()?, &images, notes).map_err(|error| match error {
            InfoError::Calibration(error) => error.into(),
            InfoError::Images(said) => IngestError::Request(format!(
                "{}: {said}; correct it, or give a calibration of these images with --calibration",
                self.path.display()
            )),
        })
    }

    /// A CameraInfo that is not the one before it: every image would be read by the first.
    fn info_changed(&self, message: RawMessage<'_>, change: &str) -> IngestError {
        IngestError::Request(format!(
            "{}: the CameraInfo on {} changes {} ns after 1970: {change}; cut the recording there (`rosbag filter`, \
             `mcap filter`), and ingest the parts as recordings of their own",
            self.path.display(),
            message.topic.name,
            message.receive_ns
        ))
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

    fn has_one_recorder(&self) -> bool {
        self.recording.has_in_one_file(&self.stereo.left_image, &self.stereo.right_image)
    }

    fn file_of(&self, _side: Side, _stamp_ns: i64) -> PathBuf {
        self.path.clone()
    }

    fn depth(&self) -> Depth {
        self.depth
    }

    fn calibrate(&self, request: &IngestRequest, notes: &Notes) -> Result<ViewsRecord, IngestError> {
        let [left, right] = self.sizes()?;
        let calibration = if self.uses_infos {
            self.recorded_calibration([left, right], notes)?
        } else {
            let images = PairImages { left, right, kitti_cameras: [0, 1], are_rectified: self.is_rectified() };
            let calibration = read_calibration_files(&request.calibration, Some(&images))?;
            note_far_centres(&calibration, notes);
            calibration
        };
        Ok(ViewsRecord {
            calibration: Cameras::Pair(Box::new(calibration)),
            left_bayer: self.firsts[0].bayer_pattern(),
            right_bayer: self.firsts[1].bayer_pattern(),
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
        let infos = if self.uses_infos { self.info_topics()? } else { [""; 2] };
        wanted.extend(infos.iter().filter(|topic| !topic.is_empty()));
        let mut watches = [InfoWatch::default(), InfoWatch::default()];
        let mut report_progress = |read: Progress| progress(read.bytes_read, read.bytes_total);
        let read = self.recording.read(&wanted, &mut report_progress, &mut |message| {
            let looked = match infos.iter().position(|topic| *topic == message.topic.name) {
                Some(side) => self.info(message).and_then(|info| {
                    watches[side].look(info).map_err(|change| self.info_changed(message, &change))?;
                    Ok(ControlFlow::Continue(()))
                }),
                None => self.item(message).and_then(&mut *each),
            };
            match looked {
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
}
