//! SURF, odometry, verification and rectification on real images.

use crate::row::{Row, cpu_ms, row, wall_ms_on_two};
use furrow_catalog::images::{Rectifier, Side, decode_grey, read_calibration_files};
use furrow_ingest::odometry::{FrameFeatures, Odometry, OdometryParams, StereoFrame, VerifyParams, estimate, verify};
use furrow_model::{GreyImage, StereoRig};
use furrow_runner::localiser::surf::{SurfParams, surf};
use std::path::{Path, PathBuf};

fn grey(path: &Path) -> Option<GreyImage> {
    decode_grey(&std::fs::read(path).ok()?, None).ok()
}

/// The first rectified street pairs of the data and their rig.
fn street(data: &Path) -> Option<(StereoRig, Vec<(GreyImage, GreyImage)>)> {
    let folder = furrow_ingest::folder::StereoFolder::open(&data.join("kitti_odo_seqA"), &[]).ok()?;
    let rig = Rectifier::from_record(&folder.calibration).ok()?.rig();
    let pairs = folder
        .pairs
        .iter()
        .take(20)
        .map(|pair| Some((grey(&pair.left)?, grey(&pair.right)?)))
        .collect::<Option<_>>()?;
    Some((rig, pairs))
}

pub fn on_street_images(data: &Path, rows: &mut Vec<Row>) {
    let Some((rig, pairs)) = street(data) else {
        eprintln!("SKIPPED: no kitti_odo_seqA in {}: no figures for SURF and odometry", data.display());
        return;
    };
    let image = &pairs[0].0;
    let upright = SurfParams { upright: true, ..SurfParams::GOLDEN };
    rows.push(row(
        "SURF, Hessian 400, 1226x370",
        cpu_ms(9, |_| surf(image, &SurfParams::GOLDEN)),
        "ms",
        "OpenCV SURF",
        Some(212.0),
    ));
    rows.push(row(
        "SURF upright, Hessian 400, 1226x370",
        cpu_ms(9, |_| surf(image, &upright)),
        "ms",
        "OpenCV SURF",
        Some(92.0),
    ));
    rows.push(row(
        "SURF, Hessian 400, 1226x370, wall time on two cores",
        wall_ms_on_two(29, || surf(image, &SurfParams::GOLDEN)),
        "ms",
        "OpenCV SURF",
        Some(212.0),
    ));

    let params = OdometryParams::default();
    let odometry = Odometry::new(rig, params.clone());
    let prepare = |i: usize| odometry.prepare(&pairs[i % pairs.len()].0, &pairs[i % pairs.len()].1);
    let frames: Vec<StereoFrame> = (0..pairs.len()).map(prepare).collect();
    let features = cpu_ms(19, prepare);
    let motion = cpu_ms(19, |i| estimate(&frames[i % 19], &frames[i % 19 + 1], &rig, &params).is_ok());
    rows.push(row("stereo odometry, whole frame, 1226x370", features + motion, "ms", "libviso2", Some(24.4)));

    let verify_params = VerifyParams::default();
    let extract = |image: &GreyImage| FrameFeatures::extract(image, &verify_params.matcher);
    let live = StereoFrame::new(extract(&pairs[3].0), extract(&pairs[3].1), &rig, &verify_params.stereo);
    let node = extract(&pairs[1].0);
    rows.push(row(
        "three-view verification of a candidate, 1226x370",
        cpu_ms(19, |_| verify(&live, &node, &rig, &verify_params)),
        "ms",
        "none known",
        None,
    ));
}

pub fn on_the_real_drive(data: &Path, rows: &mut Vec<Row>) {
    let folder = data.join("kitti_raw_drive_A");
    let image: Option<PathBuf> =
        std::fs::read_dir(folder.join("image_00")).ok().and_then(|files| files.flatten().map(|file| file.path()).min());
    let calibration = read_calibration_files(&[folder.join("calib_cam_to_cam.txt")], None).ok();
    let rectifier = calibration.and_then(|record| Rectifier::from_record(&record).ok());
    let bytes = image.and_then(|path| std::fs::read(path).ok());
    let (Some(rectifier), Some(bytes)) = (rectifier, bytes) else {
        eprintln!("SKIPPED: no kitti_raw_drive_A in {}: no figure for rectification", data.display());
        return;
    };
    let work = |_| decode_grey(&bytes, None).ok().and_then(|image| rectifier.rectify_grey(Side::Left, image).ok());
    rows.push(row("decode and rectify (OpenCV), 1392x512 JPEG", cpu_ms(19, work), "ms", "this machine", None));
}
