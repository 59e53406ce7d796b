//! From a world and a pose to radiance: a rasteriser of facets with deferred shading, one band of rows after another.
//!
//! Both eyes' bands are shared out over the threads; a band's pixels depend on nothing but the view, so the picture has
//! the same bits on any number of threads. What is seen where is found 1.5 times finer than asked for and averaged
//! down; bare ground and open sky, which are smooth at that scale, are lit once per finished pixel.

pub mod backdrop;
pub mod eye;
pub mod gather;
pub mod ground;
pub mod hills;
pub mod light;
pub mod pair;
pub mod prepare;
pub mod raster;
pub mod shade;
pub mod shadow;
pub mod stage;

pub use pair::render_pair;
pub use stage::{Radiance, Stage};
