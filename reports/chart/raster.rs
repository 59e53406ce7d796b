//! Charts as PNG.

use crate::error::ReportError;
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Pixels per unit of a chart: 480 units fill half a printed page.
const SCALE: f32 = 3.0;

/// Draws SVGs with the fonts of this machine.
pub struct Painter(usvg::Options<'static>);

impl Painter {
    /// Looks the machine's fonts up, once.
    ///
    /// # Errors
    /// [`ReportError::Raster`] where it has none: every chart would lack its text.
    pub fn new() -> Result<Self, ReportError> {
        let mut fonts = usvg::fontdb::Database::new();
        fonts.load_system_fonts();
        let first = fonts.faces().next().and_then(|face| face.families.first()).map(|family| family.0.clone());
        let Some(first) = first else {
            let reason = "this machine has no fonts; install some (fonts-liberation, fonts-dejavu), or ask for svg";
            return Err(ReportError::Raster { reason: reason.to_owned() });
        };
        let has = |wanted: &&str| fonts.faces().any(|face| face.families.iter().any(|family| family.0 == *wanted));
        let plain = ["Liberation Sans", "DejaVu Sans", "Arial"].into_iter().find(has).map_or(first, str::to_owned);
        fonts.set_sans_serif_family(plain.clone());
        Ok(Self(usvg::Options { font_family: plain, fontdb: Arc::new(fonts), ..usvg::Options::default() }))
    }

    /// A PNG file of a chart from [`figure_files`](crate::figure_files).
    ///
    /// # Errors
    /// [`ReportError::Raster`] where the text is no SVG with a size.
    pub fn png(&self, svg: &str) -> Result<Vec<u8>, ReportError> {
        let wrong = |reason: String| ReportError::Raster { reason };
        let tree = usvg::Tree::from_str(svg, &self.0).map_err(|error| wrong(error.to_string()))?;
        let size = tree.size().to_int_size().scale_by(SCALE);
        let size = size.ok_or_else(|| wrong("the chart has no size".to_owned()))?;
        let pixels = tiny_skia::Pixmap::new(size.width(), size.height());
        let mut pixels = pixels.ok_or_else(|| wrong("the chart is too large".to_owned()))?;
        resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
        pixels.encode_png().map_err(|error| wrong(error.to_string()))
    }
}
