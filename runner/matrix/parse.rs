//! From the text of a file to a matrix.

use super::{LocaliserSpec, Matrix, check};
use crate::RunError;
use furrow_localiser::seqslam::SeqSlamParams;
use std::path::Path;

impl Matrix {
    /// Reads a matrix.
    ///
    /// # Errors
    /// [`RunError::Matrix`] naming file, line and what is wrong.
    pub fn parse(path: &Path, text: &str) -> Result<Self, RunError> {
        let mut matrix: Matrix = toml::from_str(text).map_err(|error| RunError::Matrix {
            path: path.to_owned(),
            reason: check::with_hint(error.to_string().trim_end()),
        })?;
        matrix.check(path, text)?;
        if let (Some(file), Some(folder)) = (&mut matrix.localiser.descriptors, path.parent()) {
            *file = folder.join(&*file);
        }
        Ok(matrix)
    }

    /// SeqSLAM as the matrix asks for it: sequences of images as far apart as keyframes.
    pub fn seqslam(&self) -> SeqSlamParams {
        let LocaliserSpec { sequence, shift, .. } = self.localiser;
        SeqSlamParams { images: sequence, shift, ..SeqSlamParams::at_spacing(self.keyframes.distance_m) }
    }
}
