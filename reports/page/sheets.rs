//! Contact sheets of generators.

use super::jpeg::Embedded;
use crate::error::ReportError;
use crate::input::GeneratorInput;
use crate::wording;
use serde::Serialize;

/// A generator's contact sheet.
#[derive(Serialize)]
pub(super) struct Sheet {
    name: String,
    rows: String,
    width: u32,
    height: u32,
    uri: String,
}

/// The contact sheets there are.
pub(super) fn sheets(generators: &[GeneratorInput]) -> Result<Vec<Sheet>, ReportError> {
    let mut sheets = Vec::new();
    for generator in generators {
        let Some((jpeg, rows)) = &generator.sheet else { continue };
        let name = wording::shown(&generator.name);
        let Some(Embedded { width, height, uri }) = Embedded::of(jpeg) else {
            return Err(ReportError::Sheet { generator: name, bytes: jpeg.len() });
        };
        sheets.push(Sheet { name, rows: wording::shown(rows), width, height, uri });
    }
    Ok(sheets)
}
