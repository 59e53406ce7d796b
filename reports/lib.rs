//! Reports: what a run gave, as one page that people read, print and show; and the catalogue's own pages on loopback.
//!
//! A tour, in the order a page comes into being:
//! - [`input`]: what a report is made from: outcomes, their tables of events, chosen images, and the cells that are
//!   missing;
//! - `chart`: charts as data, and as SVG or PNG; it knows no outcome;
//! - `figures`: settings and tables of events into charts with captions and data, one file per figure of the thesis;
//! - `page`: figures, tables and galleries into HTML: [`page()`], [`claims_page`]; and into files: [`figure_files`],
//!   [`latex`];
//! - [`browse`]: the read-only catalogue browser.
//!
//! Each folder stands on those above it, and on `wording` (names and numbers as people read them) and `template`
//! (minijinja).
//!
//! Invariants: a metric is taken from its [`Outcome`](furrow_model::Outcome) and only drawn; a page is one file that
//! loads nothing from the network, and its policy allows no script but the one inlined by the crate, without which its
//! content is the same; equal inputs give equal bytes; names of recordings and matrices are shown, never executed.

pub mod browse;
mod chart;
mod error;
mod figures;
pub mod input;
mod page;
mod template;
mod wording;

pub use chart::Painter;
pub use error::ReportError;
pub use input::{
    CellInput, ContrastInput, GateCurve, GatePoint, GeneratorInput, MissingCell, ReportInput, Tile, TileCaption,
    TrackInput, Training,
};
pub use page::{
    ClaimInput, ClaimsInput, FigureFiles, RunInput, TileChoice, choose_still, choose_tiles, claims_page, figure_files,
    latex, page,
};
