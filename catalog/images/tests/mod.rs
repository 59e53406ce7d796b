//! Tests of stored images and of rectification.

mod aligned;
mod calibrations;
mod damaged;
mod encodings;
mod forms;
mod geometry;
mod seen;
mod stored;

use furrow_model::{CameraCalibration, Distortion};

/// Colours that change everywhere and repeat nowhere nearby.
fn scene(x: usize, y: usize) -> [u8; 3] {
    [(x * 5 + y) as u8, (x + y * 7 + 40) as u8, (x * 3 + y * 2 + 90) as u8]
}

/// The scene's pixels by rows, each written by `write`, each row followed by `padding` bytes.
fn rows<const BYTES: usize>(
    width: usize,
    height: usize,
    padding: usize,
    write: impl Fn(usize, usize) -> [u8; BYTES],
) -> Vec<u8> {
    let mut data = Vec::new();
    for y in 0..height {
        (0..width).for_each(|x| data.extend(write(x, y)));
        data.extend(std::iter::repeat_n(0xee, padding));
    }
    data
}

/// A small stereo pair with bent lenses and slightly turned cameras: (left, right).
fn bent_pair() -> (CameraCalibration, CameraCalibration) {
    let camera = |k: [f64; 4], coefficients: &[f64], turn_rad: f64, p3: f64| {
        let (sine, cosine) = turn_rad.sin_cos();
        CameraCalibration {
            width: 320,
            height: 200,
            distortion: Distortion::RadialTangential,
            coefficients: coefficients.to_vec(),
            intrinsics: [k[0], 0.0, k[2], 0.0, k[1], k[3], 0.0, 0.0, 1.0],
            rectification: [cosine, 0.0, sine, 0.0, 1.0, 0.0, -sine, 0.0, cosine],
            projection: [180.0, 0.0, 150.0, p3, 0.0, 180.0, 95.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        }
    };
    (
        camera([200.0, 199.0, 161.0, 99.0], &[-0.3, 0.1, 0.001, -0.0005, -0.01], 0.01, 0.0),
        camera([201.0, 200.5, 158.0, 101.0], &[-0.29, 0.09, -0.0007, 0.0004, -0.008], -0.008, -21.6),
    )
}

/// A pair whose images are rectified already.
fn straight_pair() -> (CameraCalibration, CameraCalibration) {
    let camera = |p3: f64| CameraCalibration {
        width: 64,
        height: 48,
        distortion: Distortion::RadialTangential,
        coefficients: vec![0.0; 5],
        intrinsics: [60.0, 0.0, 31.5, 0.0, 60.0, 23.5, 0.0, 0.0, 1.0],
        rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        projection: [60.0, 0.0, 31.5, p3, 0.0, 60.0, 23.5, 0.0, 0.0, 0.0, 1.0, 0.0],
    };
    (camera(0.0), camera(-7.2))
}
