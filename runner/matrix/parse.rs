//! From the text of a file to a matrix.

use super::{Matrix, Method, check};
use crate::RunError;
use std::path::Path;

impl Matrix {
    /// Reads a matrix; the first of the place recognisers is the default.
    ///
    /// # Errors
    /// [`RunError::Matrix`] naming file, line and what is wrong.
    pub fn parse(path: &Path, text: &str, methods: &[&Method]) -> Result<Self, RunError> {
        let mut matrix: Matrix = toml::from_str(text).map_err(|error| RunError::Matrix {
            path: path.to_owned(),
            reason: check::with_hint(error.to_string().trim_end()),
        })?;
        let localiser = &mut matrix.localiser;
        if let Some(usual) = methods.first().filter(|_| localiser.method().is_empty()) {
            usual.name.clone_into(localiser.method.get_mut());
        }
        localiser.folder = path.parent().map(Path::to_owned).unwrap_or_default();
        matrix.check(path, text, methods)?;
        Ok(matrix)
    }
}
