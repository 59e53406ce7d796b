//! A camera as ROS' `camera_calibration_parsers` and OpenCV's calibration programs write it. Other people's tools add
//! keys of their own: unknown ones are passed over.

use super::camera_file::FileCamera;
use super::error::CalibrationFileError;
use super::lenses::{KNOWN_MODELS, distortion_named};
use super::yaml::Document;
use crate::images::rectify::pose::Pose;
use furrow_model::Distortion;

/// The keys under which a document tells of one camera; of each list, the first that is there.
pub struct Keys<'a> {
    /// K.
    pub k: &'a [&'a str],
    /// D.
    pub d: &'a [&'a str],
    /// R: rectified frame from camera frame.
    pub r: &'a [&'a str],
    /// P.
    pub p: &'a [&'a str],
    /// Columns.
    pub width: &'a [&'a str],
    /// Rows.
    pub height: &'a [&'a str],
}

const WIDTH: &[&str] = &["image_width", "Image_Width", "imageWidth", "width"];
const HEIGHT: &[&str] = &["image_height", "Image_Height", "imageHeight", "height"];

/// One camera in a document of its own.
const ALONE: Keys<'static> = Keys {
    k: &["camera_matrix", "Camera_Matrix", "cameraMatrix", "intrinsic_matrix"],
    d: &["distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "distortion_coeffs"],
    r: &["rectification_matrix"],
    p: &["projection_matrix"],
    width: WIDTH,
    height: HEIGHT,
};
/// Two cameras in one document: OpenCV's stereo sample, and the settings of ORB-SLAM.
const TOGETHER: [[Keys<'static>; 2]; 2] = [
    [
        Keys {
            k: &["M1", "K1", "cameraMatrix1", "camera_matrix_1"],
            d: &["D1", "distCoeffs1", "dist_coeffs_1"],
            r: &["R1"],
            p: &["P1"],
            width: WIDTH,
            height: HEIGHT,
        },
        Keys {
            k: &["M2", "K2", "cameraMatrix2", "camera_matrix_2"],
            d: &["D2", "distCoeffs2", "dist_coeffs_2"],
            r: &["R2"],
            p: &["P2"],
            width: WIDTH,
            height: HEIGHT,
        },
    ],
    [
        Keys {
            k: &["LEFT.K"],
            d: &["LEFT.D"],
            r: &["LEFT.R"],
            p: &["LEFT.P"],
            width: &["LEFT.width"],
            height: &["LEFT.height"],
        },
        Keys {
            k: &["RIGHT.K"],
            d: &["RIGHT.D"],
            r: &["RIGHT.R"],
            p: &["RIGHT.P"],
            width: &["RIGHT.width"],
            height: &["RIGHT.height"],
        },
    ],
];

/// Whether a document is one camera's.
pub fn is_camera(document: &Document) -> bool {
    document.has(ALONE.k)
}

/// Whether a document tells of two cameras at once, or is one of the two that OpenCV's stereo sample writes: intrinsics
/// and extrinsics.
pub fn is_part_of_pair(document: &Document) -> bool {
    document.has(&["R1", "T"]) || TOGETHER.iter().flatten().any(|keys| document.has(keys.k))
}

/// The camera of a document that is one camera's.
///
/// # Errors
/// Matrices of other shapes; a lens model that is not known.
pub fn camera(document: &Document) -> Result<FileCamera, CalibrationFileError> {
    one(document, &ALONE, document.what.clone())
}

/// The two cameras of a document that tells of both: with R1, P1, R2 and P2, or with R and T from the left camera to
/// the right.
///
/// # Errors
/// Matrices of other shapes or missing ones.
pub fn pair(document: &Document) -> Result<[FileCamera; 2], CalibrationFileError> {
    let missing = || CalibrationFileError::Missing { what: document.what.clone(), key: "M2".to_owned() };
    let keys = TOGETHER.iter().find(|keys| keys.iter().all(|keys| document.has(keys.k))).ok_or_else(missing)?;
    let [mut left, mut right] = [
        one(document, &keys[0], format!("{}, left", document.what))?,
        one(document, &keys[1], format!("{}, right", document.what))?,
    ];
    let rotation = document.matrix::<9>(&["R"], 3, 3)?;
    let translation = document.numbers(&["T"])?.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    if let (Some(rotation), Some(translation)) = (rotation, translation) {
        left.camera_from_body = Some(Pose::IDENTITY);
        right.camera_from_body = Some(Pose { rotation, translation });
    }
    Ok([left, right])
}

fn one(document: &Document, keys: &Keys<'_>, what: String) -> Result<FileCamera, CalibrationFileError> {
    let missing = |key: &[&str]| CalibrationFileError::Missing {
        what: what.clone(),
        key: key.first().copied().unwrap_or_default().to_owned(),
    };
    let intrinsics = document.matrix::<9>(keys.k, 3, 3)?.ok_or_else(|| missing(keys.k))?;
    let coefficients = document.numbers(keys.d)?.ok_or_else(|| missing(keys.d))?;
    let lens = lens(document, coefficients)?;
    let size = document.size(keys.width, keys.height)?;
    let mut camera = FileCamera::new(what.clone(), size, intrinsics, lens);
    if let (Some(r), Some(p)) = (document.matrix(keys.r, 3, 3)?, document.matrix(keys.p, 3, 4)?) {
        camera.camera.rectification = r;
        camera.camera.projection = p;
        camera.is_aligned = true;
    }
    Ok(camera)
}

fn lens(document: &Document, coefficients: Vec<f64>) -> Result<(Distortion, Vec<f64>), CalibrationFileError> {
    let is_fisheye = document.get(&["fisheye_model"]).and_then(serde_norway::Value::as_i64) == Some(1);
    let name = if is_fisheye { "fisheye" } else { document.text(&["distortion_model"]) };
    match distortion_named(name, &coefficients) {
        Some(model) => Ok((model, coefficients)),
        None => Err(document.wrong(
            "distortion_model",
            KNOWN_MODELS,
            if name.is_empty() {
                "no name, and 4 coefficients that may be of either kind".to_owned()
            } else {
                name.to_owned()
            },
        )),
    }
}
