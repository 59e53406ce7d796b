//! Charts as SVG, drawn by `chart.svg`.

use super::layout::Chart;
use crate::template::environment;
use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

/// Draws charts.
pub(crate) struct SvgWriter(Environment<'static>);

#[derive(Serialize)]
struct Context<'a> {
    c: &'a Chart,
}

impl SvgWriter {
    pub fn new() -> Result<Self, minijinja::Error> {
        Ok(Self(environment(&[("chart.svg", include_str!("chart.svg"))])?))
    }

    /// A chart as an SVG element of a page, which colours it by its classes.
    pub fn element(&self, chart: &Chart) -> Result<String, minijinja::Error> {
        self.0.get_template("chart.svg")?.render(Serde(Context { c: chart }))
    }

    /// A chart as a file: in the light page's colours, and in fonts that drawing programs find by name.
    pub fn file(&self, chart: &Chart) -> Result<String, minijinja::Error> {
        let fonts = "font-family=\"'Liberation Sans', 'DejaVu Sans', Arial, Helvetica, sans-serif\"";
        let page = "font-family=\"system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif\"";
        let svg = self.element(chart)?.replacen(page, fonts, 1);
        Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", svg.trim_start()))
    }
}
