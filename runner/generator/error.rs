//! What can go wrong with an image or a model.

use crate::DOMAINNESS;

/// An image that cannot be generated, or a model that cannot be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// z is out of range.
    #[error("domainness {found} is not between {} and {}: 0 is the image itself, 1 the target", DOMAINNESS[0], DOMAINNESS[1])]
    Domainness {
        /// What was asked for.
        found: f64,
    },
    /// The pixels do not fill the image.
    #[error("an image of {width} x {height} needs {} values, it has {values}", 3 * width * height)]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Values that are there.
        values: usize,
    },
    /// Nothing to learn from.
    #[error("the {domain} images have no pixel that is not blown out: train on other images")]
    NoPixels {
        /// `source` or `target`.
        domain: &'static str,
    },
    /// A pair that is not the rig's.
    #[error("relighting needs a rectified pair of {} x {}, the right image has {} x {}", expected.0, expected.1, found.0, found.1)]
    Pair {
        /// Columns and rows of the rig.
        expected: (usize, usize),
        /// Those of the right image.
        found: (usize, usize),
    },
    /// A generator that relights, without what to relight by.
    #[error("it relights, and was not told how the image's surfaces lie: give the shading of its stereo pair")]
    NoShading,
    /// A parameter that makes no sense.
    #[error("{what} is {found}: expected {expected}")]
    Parameter {
        /// Which.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What makes sense.
        expected: &'static str,
    },
    /// Weights that are not those of a model.
    #[error("the model is damaged: {0}")]
    Damaged(String),
}
