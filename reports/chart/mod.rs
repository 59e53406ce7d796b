//! Charts as data and as pictures: elements, axes, legend and colours, drawn as SVG by `chart.svg` or as PNG.
//!
//! It knows numbers, names and time slots. It may not touch outcomes, tables of events or pages: `figures` fill charts,
//! `page` shows them.
//!
//! - [`elements`]: lines, marks, patches …; [`Chart`] is the plot that they stand in, `axes` and `legend` lay out what
//!   surrounds it;
//! - [`scale`], [`shape`], [`text`]: from values to coordinates, paths and texts of a known width;
//! - [`palette`]: colours by hour;
//! - [`SvgWriter`], [`Painter`]: the drawing.

mod axes;
pub(crate) mod elements;
mod layout;
mod legend;
pub(crate) mod palette;
mod raster;
pub(crate) mod scale;
pub(crate) mod shape;
mod svg;
pub(crate) mod text;

pub(crate) use axes::number_ticks;
pub(crate) use layout::{Chart, WIDTH};
pub use raster::Painter;
pub(crate) use svg::SvgWriter;
