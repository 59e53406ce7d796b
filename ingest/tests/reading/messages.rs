//! Messages: written by hand here and read back, read from real recordings, and damaged.

use crate::golden_data::{data, files_below};
use furrow_ingest::message::{CameraInfo, CompressedImage, Image, Imu, MessageError, NavSatFix, Odometry};
use furrow_ingest::recording::{Encoding, open};
use furrow_model::Distortion;
use proptest::prelude::*;
use std::ops::ControlFlow;

/// Writes ROS1 bytes, or CDR in either byte order, from the formats' descriptions.
struct Writer {
    bytes: Vec<u8>,
    cdr: bool,
    big: bool,
}

impl Writer {
    fn new(encoding: Encoding, big: bool) -> Self {
        let cdr = encoding == Encoding::Cdr;
        Self { bytes: if cdr { vec![0, u8::from(!big), 0, 0] } else { Vec::new() }, cdr, big }
    }

    fn put<const N: usize>(&mut self, little: [u8; N]) -> &mut Self {
        while self.cdr && !(self.bytes.len() - 4).is_multiple_of(N) {
            self.bytes.push(0xaa);
        }
        let mut value = little;
        if self.big {
            value.reverse();
        }
        self.bytes.extend_from_slice(&value);
        self
    }

    fn u8(&mut self, value: u8) -> &mut Self {
        self.put([value])
    }

    fn u16(&mut self, value: u16) -> &mut Self {
        self.put(value.to_le_bytes())
    }

    fn u32(&mut self, value: u32) -> &mut Self {
        self.put(value.to_le_bytes())
    }

    fn f64s(&mut self, values: impl IntoIterator<Item = f64>) -> &mut Self {
        values.into_iter().for_each(|value| {
            self.put(value.to_le_bytes());
        });
        self
    }

    fn raw(&mut self, bytes: &[u8]) -> &mut Self {
        self.u32(bytes.len() as u32);
        self.bytes.extend_from_slice(bytes);
        self
    }

    fn text(&mut self, text: &str) -> &mut Self {
        let end: &[u8] = if self.cdr { &[0] } else { &[] };
        self.raw(&[text.as_bytes(), end].concat())
    }

    /// Stamp 1317045947.885512704 s.
    fn header(&mut self) -> &mut Self {
        if !self.cdr {
            self.u32(77);
        }
        self.u32(1_317_045_947).u32(885_512_704).text("cam")
    }
}

const STAMP_NS: i64 = 1_317_045_947_885_512_704;
const FORMS: [(Encoding, bool); 3] = [(Encoding::Ros1, false), (Encoding::Cdr, false), (Encoding::Cdr, true)];

fn count(from: f64, values: usize) -> impl Iterator<Item = f64> {
    (0..values).map(move |i| from + i as f64)
}

fn image(encoding: Encoding, big: bool) -> Vec<u8> {
    let mut w = Writer::new(encoding, big);
    w.header().u32(2).u32(3).text("mono8").u8(0).u32(3).raw(&[1, 2, 3, 4, 5, 6]);
    w.bytes
}

fn camera_info(encoding: Encoding, big: bool) -> Vec<u8> {
    let mut w = Writer::new(encoding, big);
    w.header()
        .u32(376)
        .u32(1241)
        .text("plumb_bob")
        .u32(5)
        .f64s(count(0.5, 5))
        .f64s(count(10.0, 9))
        .f64s(count(20.0, 9));
    w.f64s(count(30.0, 12)).u32(1).u32(2).u32(3).u32(4).u32(5).u32(6).u8(1);
    w.bytes
}

fn fix(encoding: Encoding, big: bool) -> Vec<u8> {
    let mut w = Writer::new(encoding, big);
    w.header().u8(0xff).u16(3).f64s([49.5, 8.25, 114.0]).f64s(count(1.0, 9)).u8(2);
    w.bytes
}

fn odometry(encoding: Encoding, big: bool) -> Vec<u8> {
    let mut w = Writer::new(encoding, big);
    w.header().text("base_link").f64s(count(1.0, 7)).f64s(count(100.0, 36)).f64s(count(8.0, 6)).f64s(count(200.0, 36));
    w.bytes
}

#[test]
fn what_is_written_is_read_in_every_encoding() {
    for (encoding, big) in FORMS {
        let bytes = image(encoding, big);
        let read = Image::decode(encoding, &bytes).unwrap();
        assert_eq!((read.header.stamp_ns, read.header.frame_id), (STAMP_NS, "cam"));
        assert_eq!((read.height, read.width, read.encoding, read.is_bigendian, read.step), (2, 3, "mono8", false, 3));
        assert_eq!(read.rows().unwrap(), [1, 2, 3, 4, 5, 6]);
        assert!(Image { step: 4, ..read.clone() }.rows().is_err());
        assert!(bytes.as_ptr_range().contains(&read.data.as_ptr()), "pixels were copied");

        let mut w = Writer::new(encoding, big);
        w.header().text("jpeg").raw(b"\xff\xd8rest");
        let read = CompressedImage::decode(encoding, &w.bytes).unwrap();
        assert_eq!((read.format, read.data), ("jpeg", &b"\xff\xd8rest"[..]));

        let bytes = camera_info(encoding, big);
        let read = CameraInfo::decode(encoding, &bytes).unwrap();
        assert_eq!((read.height, read.width, read.distortion_model), (376, 1241, "plumb_bob"));
        assert_eq!(
            (read.d[..].to_vec(), read.k[8], read.r[0], read.p[11]),
            (count(0.5, 5).collect(), 18.0, 20.0, 41.0)
        );
        assert_eq!((read.binning, read.region), ([1, 2], [3, 4, 5, 6]));

        let bytes = fix(encoding, big);
        let read = NavSatFix::decode(encoding, &bytes).unwrap();
        assert_eq!((read.status, read.service, read.latitude_deg, read.altitude_m), (-1, 3, 49.5, 114.0));
        assert_eq!((read.position_covariance_m2[8], read.position_covariance_type), (9.0, 2));

        let bytes = odometry(encoding, big);
        let read = Odometry::decode(encoding, &bytes).unwrap();
        assert_eq!(
            (read.child_frame_id, read.position_m, read.orientation_xyzw),
            ("base_link", [1.0, 2.0, 3.0], [4.0, 5.0, 6.0, 7.0])
        );
        assert_eq!(
            (read.pose_covariance[35], read.linear_velocity_m_s, read.twist_covariance[35]),
            (135.0, [8.0, 9.0, 10.0], 235.0)
        );

        let mut w = Writer::new(encoding, big);
        w.header().f64s(count(1.0, 37));
        let read = Imu::decode(encoding, &w.bytes).unwrap();
        assert_eq!((read.angular_velocity_rad_s, read.linear_acceleration_covariance[8]), ([14.0, 15.0, 16.0], 37.0));
    }
}

#[test]
fn other_encapsulations_and_types_are_refused() {
    let mut bytes = image(Encoding::Cdr, false);
    bytes[1] = 7;
    let error = Image::decode(Encoding::Cdr, &bytes).unwrap_err();
    assert!(matches!(error, MessageError::Encoding { .. }), "{error}");
    assert!(Image::decode(Encoding::Unknown, &bytes).is_err() && Image::decode(Encoding::Cdr, &[0]).is_err());
    assert!(Image::decode(Encoding::Cdr, &image(Encoding::Ros1, false)).is_err());
}

#[test]
fn lens_models_are_named_and_their_coefficients_counted() {
    let bytes = camera_info(Encoding::Ros1, false);
    let info = CameraInfo::decode(Encoding::Ros1, &bytes).unwrap();
    let calibration_of =
        |model: &'static str, d: Vec<f64>| CameraInfo { distortion_model: model, d, ..info.clone() }.calibration();
    let kept = |model, d: &[f64]| calibration_of(model, d.to_vec()).map(|c| (c.distortion, c.coefficients)).unwrap();
    assert_eq!(kept("plumb_bob", &[0.1, 0.2]), (Distortion::RadialTangential, vec![0.1, 0.2, 0.0, 0.0]));
    let twelve = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(kept("rational_polynomial", &twelve), (Distortion::RadialTangential, twelve[..8].to_vec()));
    assert_eq!(
        kept("Kannala_Brandt4", &[1.0, 2.0, 3.0, 4.0, 0.0]),
        (Distortion::Equidistant, vec![1.0, 2.0, 3.0, 4.0])
    );
    let mut prism = twelve;
    prism[10] = -1e-4;
    assert_eq!(kept("rational_polynomial", &prism), (Distortion::RadialTangential, prism.to_vec()));
    let fourteen = [&prism[..], &[0.0, 0.01]].concat();
    assert_eq!(kept("rational_polynomial", &fourteen), (Distortion::RadialTangential, fourteen.clone()));
    assert!(calibration_of("plumb_bob", fourteen).is_err() && calibration_of("equidistant", vec![0.1; 5]).is_err());
    for model in ["", "omni", "inverse_brown_conrady", "PLUMB_BOB"] {
        assert_eq!(kept(model, &[0.0; 5]), (Distortion::RadialTangential, vec![]), "{model}");
    }
    assert_eq!(kept("", &[]), (Distortion::RadialTangential, vec![]));
    assert!(
        calibration_of("", vec![0.1]).is_err()
            && calibration_of("omni", vec![0.1; 5]).is_err()
            && calibration_of("plumb_bob", vec![1.0; 9]).is_err()
    );
}

#[test]
fn every_known_message_of_every_real_recording_is_decoded() {
    let mut decoded = std::collections::BTreeMap::<String, u64>::new();
    let mut frames = Vec::new();
    for path in data().map(|folder| files_below(&folder)).unwrap_or_default() {
        let kinds = ["bag", "mcap", "db3"];
        let Some(Ok(recording)) = path.extension().filter(|kind| kinds.iter().any(|k| k == kind)).map(|_| open(&path))
        else {
            continue;
        };
        let known = ["Image", "CompressedImage", "CameraInfo", "Imu", "NavSatFix", "Odometry"];
        let is_known = |name: &str| name.rsplit('/').next().is_some_and(|last| known.contains(&last));
        let wanted: Vec<&str> = recording
            .topics()
            .iter()
            .filter(|topic| is_known(&topic.type_name))
            .map(|topic| topic.name.as_str())
            .collect();
        let _ = recording.read::<()>(&wanted, &mut |_| (), &mut |message| {
            let (encoding, bytes) = (message.topic.encoding, message.bytes);
            let stamp = match message.topic.type_name.as_str() {
                Image::TYPE => Image::decode(encoding, bytes).map(|m| {
                    frames.push((path.clone(), m.width, m.height, m.encoding.to_owned()));
                    m.header.stamp_ns
                }),
                CompressedImage::TYPE => CompressedImage::decode(encoding, bytes).map(|m| m.header.stamp_ns),
                CameraInfo::TYPE => CameraInfo::decode(encoding, bytes).map(|m| m.header.stamp_ns),
                Imu::TYPE => Imu::decode(encoding, bytes).map(|m| m.header.stamp_ns),
                NavSatFix::TYPE => NavSatFix::decode(encoding, bytes).map(|m| m.header.stamp_ns),
                Odometry::TYPE => Odometry::decode(encoding, bytes).map(|m| m.header.stamp_ns),
                _ => return ControlFlow::Continue(()),
            };
            let stamp = stamp.unwrap_or_else(|error| panic!("{}: {}: {error}", path.display(), message.topic.name));
            assert!(stamp >= 0);
            *decoded.entry(message.topic.type_name.clone()).or_default() += 1;
            ControlFlow::Continue(())
        });
    }
    eprintln!("decoded: {decoded:?}");
    // The T265's fisheyes are 848 x 800 mono8 (its NOTES.md).
    for (path, width, height, pixels) in frames.iter().filter(|frame| frame.0.to_string_lossy().contains("t265")) {
        assert_eq!((*width, *height, pixels.as_str()), (848, 800, "mono8"), "{}", path.display());
    }
}

fn decode_all(encoding: Encoding, bytes: &[u8]) {
    let _ = Image::decode(encoding, bytes);
    let _ = CompressedImage::decode(encoding, bytes);
    let _ = CameraInfo::decode(encoding, bytes).map(|info| info.calibration());
    let _ = Imu::decode(encoding, bytes);
    let _ = NavSatFix::decode(encoding, bytes);
    let _ = Odometry::decode(encoding, bytes);
}

#[test]
fn a_message_cut_anywhere_is_refused() {
    for (encoding, big) in FORMS {
        let (image, info) = (image(encoding, big), camera_info(encoding, big));
        let (fix, odometry) = (fix(encoding, big), odometry(encoding, big));
        assert!((0..image.len()).all(|len| Image::decode(encoding, &image[..len]).is_err()));
        assert!((0..info.len()).all(|len| CameraInfo::decode(encoding, &info[..len]).is_err()));
        assert!((0..fix.len()).all(|len| NavSatFix::decode(encoding, &fix[..len]).is_err()));
        assert!((0..odometry.len()).all(|len| Odometry::decode(encoding, &odometry[..len]).is_err()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn flipped_and_random_bytes_never_panic(
        form in 0_usize..3,
        which in 0_usize..4,
        flips in prop::collection::vec((0_usize..1000, any::<u8>()), 1..6),
        noise in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let (encoding, big) = FORMS[form];
        let mut bytes = [image, camera_info, fix, odometry][which](encoding, big);
        let len = bytes.len();
        flips.iter().for_each(|&(at, value)| bytes[at % len] = value);
        decode_all(encoding, &bytes);
        decode_all(encoding, &noise);
        decode_all(Encoding::Cdr, &[&[0, 1, 0, 0], &noise[..]].concat());
    }
}
