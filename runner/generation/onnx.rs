//! A generator that is an ONNX model, run by ONNX Runtime: inputs `image` f32 [1, 3, H, W] and `z` f32 [1, 1], output
//! `image` f32 [1, 3, H, W].
//!
//! The library is not ours to ship: it is found by `ORT_DYLIB_PATH`, else under its usual name, when the first model is
//! loaded.

use super::translator::{Channels, Range, SizeMode, Translator};
use crate::RunError;
use furrow_catalog::images::resized;
use furrow_model::ColourImage;
use ort::session::Session;
use ort::value::Tensor;
use std::sync::{Mutex, PoisonError};

/// A model that paints.
pub(crate) struct OnnxPainter {
    translator: Translator,
    session: Mutex<Session>,
}

/// The library's usual name.
const LIBRARY: &str = "libonnxruntime.so";

impl OnnxPainter {
    /// Loads a model from its bytes.
    pub fn load(translator: &Translator, model: &[u8]) -> Result<Self, RunError> {
        let wrong = |reason: String| RunError::generator(&translator.name, reason);
        let library = std::env::var_os("ORT_DYLIB_PATH").unwrap_or_else(|| LIBRARY.into());
        let environment = ort::init_from(&library).map_err(|error| {
            wrong(format!("it needs ONNX Runtime 1.17 or newer: {error}; install it and set ORT_DYLIB_PATH to its libonnxruntime.so"))
        })?;
        let load = || -> ort::Result<Session> {
            let environment = environment.build()?;
            // One thread each: images are painted in a fixed order, and sums in one too.
            let mut builder = Session::builder(&environment)?.with_intra_threads(1)?;
            builder.commit_from_memory(model)
        };
        let session = load().map_err(|error| wrong(format!("its model cannot be loaded: {error}")))?;
        Ok(Self { translator: translator.clone(), session: Mutex::new(session) })
    }

    /// One image through the model.
    pub fn paint(&self, image: &ColourImage, z: f64) -> Result<ColourImage, RunError> {
        let wrong = |reason: String| RunError::generator(&self.translator.name, reason);
        let resize = |image: &ColourImage, w, h| resized(image, w, h).map_err(|error| wrong(error.to_string()));
        let size = self.translator.size;
        let fitted = match size.mode {
            SizeMode::Native => image.clone(),
            SizeMode::Squash => resize(image, size.w, size.h)?,
            SizeMode::Pad if size.w < image.width || size.h < image.height => {
                return Err(wrong(format!(
                    "images of {} x {} do not fit its {} x {}: use the mode squash",
                    image.width, image.height, size.w, size.h
                )));
            }
            SizeMode::Pad => padded(image, size.w, size.h),
        };
        let values = self.run(&fitted, z).map_err(|error| wrong(format!("its model failed: {error}")))?;
        if values.len() != fitted.rgb.len() {
            return Err(wrong(format!(
                "its model gave {} values, expected {} for [1, 3, {}, {}]",
                values.len(),
                fitted.rgb.len(),
                fitted.height,
                fitted.width
            )));
        }
        let painted = self.picture(&values, fitted.width, fitted.height);
        match size.mode {
            SizeMode::Native => Ok(painted),
            SizeMode::Squash => resize(&painted, image.width, image.height),
            SizeMode::Pad => Ok(cut(&painted, image.width, image.height)),
        }
    }

    fn run(&self, image: &ColourImage, z: f64) -> ort::Result<Vec<f32>> {
        let planes = self.planes(image);
        let image = Tensor::from_array(([1, 3, image.height, image.width], planes))?;
        let z = Tensor::from_array(([1_usize, 1], vec![z as f32]))?;
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        let outputs = session.run(ort::inputs!["image" => image, "z" => z])?;
        let (_, values) = outputs[0].try_extract_tensor::<f32>()?;
        Ok(values.to_vec())
    }

    /// Which channel of a pixel each plane holds.
    fn order(&self) -> [usize; 3] {
        match self.translator.channels {
            Channels::Rgb => [0, 1, 2],
            Channels::Bgr => [2, 1, 0],
        }
    }

    /// The image plane by plane, in the model's range.
    fn planes(&self, image: &ColourImage) -> Vec<f32> {
        let value = |level: u8| match self.translator.range {
            Range::Signed => f32::from(level) / 127.5 - 1.0,
            Range::Unit => f32::from(level) / 255.0,
        };
        let plane = |channel: usize| image.rgb.iter().skip(channel).step_by(3).map(|level| value(*level));
        self.order().into_iter().flat_map(plane).collect()
    }

    /// The inverse of [`OnnxPainter::planes`]; what is no number becomes black.
    fn picture(&self, values: &[f32], width: usize, height: usize) -> ColourImage {
        let level = |value: f32| {
            let level = match self.translator.range {
                Range::Signed => (value + 1.0) * 127.5,
                Range::Unit => value * 255.0,
            };
            (level + 0.5).clamp(0.0, 255.0) as u8
        };
        let mut rgb = vec![0; values.len()];
        for (plane, channel) in values.chunks_exact(width * height).zip(self.order()) {
            rgb.iter_mut().skip(channel).step_by(3).zip(plane).for_each(|(to, value)| *to = level(*value));
        }
        ColourImage { width, height, rgb }
    }
}

/// The image with its last column and row going on.
fn padded(image: &ColourImage, width: usize, height: usize) -> ColourImage {
    let pixel = |x: usize, y: usize| {
        let at = 3 * (y.min(image.height - 1) * image.width + x.min(image.width - 1));
        [image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]]
    };
    let rgb = (0..height).flat_map(|y| (0..width).flat_map(move |x| pixel(x, y))).collect();
    ColourImage { width, height, rgb }
}

/// The upper left part of the image.
fn cut(image: &ColourImage, width: usize, height: usize) -> ColourImage {
    let rows = image.rgb.chunks_exact(3 * image.width).take(height);
    ColourImage { width, height, rgb: rows.flat_map(|row| row[..3 * width].iter().copied()).collect() }
}
