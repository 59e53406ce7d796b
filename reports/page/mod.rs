//! Pages and files of a run: the report, the page of claims, figures as files, tables for LaTeX.
//!
//! It assembles what `figures` draws and what outcomes say. It may not touch a store, a socket or a clock: all is in
//! the input.
//!
//! - [`page()`]: the report, section by section: `summary`, `cells`, `contrasts`, `figure_view`, `gallery` and
//!   `sheets`, `lineage`;
//! - [`choose_tiles`], [`choose_still`]: which frames to load for the gallery;
//! - `page_data`, `script`: what the page's own script (`scripts/`) knows of cells and frames, and the script;
//! - [`figure_files`], [`latex`], [`claims_page`]: the rest of what a run can be written as.

mod cells;
mod choosing;
mod claims;
pub(crate) mod contrasts;
mod datum;
mod figure_view;
mod files;
mod gallery;
mod jpeg;
mod latex;
mod lineage;
mod page_data;
mod report;
mod script;
mod sheets;
mod summary;
mod template;
mod tile;

pub use choosing::{TileChoice, choose_still, choose_tiles};
pub use claims::{ClaimInput, ClaimsInput, RunInput, claims_page};
pub use files::{FigureFiles, figure_files};
pub use latex::latex;
pub use report::page;
pub(crate) use template::STYLE;
