//! Places by descriptors of whole images that some other program computed (NetVLAD, AnyLoc, ...): the nearest
//! descriptors are the places.

use crate::ranking::{Ranked, best_first};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How descriptors are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// The cosine of the angle between them, -1 to 1; 0 where one is all zeros.
    Cosine,
    /// Minus their Euclidean distance.
    L2,
}

/// What can be wrong with descriptors of images.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExternalError {
    /// Numbers that make no whole rows.
    #[error("descriptors of images: {numbers} numbers came, expected a multiple of {dimensions}, at least 1 per image")]
    Ragged {
        /// Numbers.
        numbers: usize,
        /// Numbers per image.
        dimensions: usize,
    },
    /// A number that is not finite.
    #[error("descriptors of images: image {image} holds {value} at position {position}, expected finite numbers")]
    NotFinite {
        /// The image's row.
        image: usize,
        /// Which of its numbers.
        position: usize,
        /// The number.
        value: f32,
    },
    /// Live images and places have descriptors of other programs.
    #[error(
        "descriptors of images: live ones have {live} numbers and those of places {places}; compute both with one program"
    )]
    OtherDimensions {
        /// Numbers per live image.
        live: usize,
        /// Numbers per place.
        places: usize,
    },
}

/// One descriptor per image, all of one length.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageDescriptors {
    dimensions: usize,
    numbers: Vec<f32>,
}

impl ImageDescriptors {
    /// From the numbers of all images, image by image. Errors: [`ExternalError::Ragged`], [`ExternalError::NotFinite`].
    pub fn new(dimensions: usize, numbers: Vec<f32>) -> Result<Self, ExternalError> {
        if dimensions == 0 || !numbers.len().is_multiple_of(dimensions) {
            return Err(ExternalError::Ragged { numbers: numbers.len(), dimensions });
        }
        match numbers.iter().position(|number| !number.is_finite()) {
            Some(at) => {
                let (image, position, value) = (at / dimensions, at % dimensions, numbers[at]);
                Err(ExternalError::NotFinite { image, position, value })
            }
            None => Ok(Self { dimensions, numbers }),
        }
    }

    /// Numbers per image.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// Images.
    pub fn len(&self) -> usize {
        self.numbers.len() / self.dimensions
    }

    /// Whether there is no image.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// The descriptors, one by one.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f32]> + '_ {
        self.numbers.chunks_exact(self.dimensions)
    }
}

/// For each live image the `count` best places. Products are added up in double precision, in their order, so that
/// equal descriptors give equal bits on any machine. Error: [`ExternalError::OtherDimensions`].
pub fn rank(
    live: &ImageDescriptors,
    places: &ImageDescriptors,
    metric: Metric,
    count: usize,
) -> Result<Vec<Vec<Ranked>>, ExternalError> {
    if live.dimensions != places.dimensions && !live.is_empty() && !places.is_empty() {
        return Err(ExternalError::OtherDimensions { live: live.dimensions, places: places.dimensions });
    }
    let norms: Vec<f64> = places.rows().map(|place| dot(place, place).sqrt()).collect();
    let ranked = live.numbers.par_chunks_exact(live.dimensions).map(|live| {
        let norm = dot(live, live).sqrt();
        let score = |(place, place_norm): (&[f32], &f64)| match metric {
            Metric::Cosine if norm * place_norm == 0.0 => 0.0,
            Metric::Cosine => dot(live, place) / (norm * place_norm),
            Metric::L2 => -squared_distance(live, place).sqrt(),
        };
        best_first(&places.rows().zip(&norms).map(score).collect::<Vec<f64>>(), count)
    });
    Ok(ranked.collect())
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum()
}

fn squared_distance(a: &[f32], b: &[f32]) -> f64 {
    let square = |(&a, &b): (&f32, &f32)| (f64::from(a) - f64::from(b)) * (f64::from(a) - f64::from(b));
    a.iter().zip(b).map(square).sum()
}
