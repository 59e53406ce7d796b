//! Reports: what a run gave, as one page that people read, print and show.
//!
//! A tour, in the order a page comes into being:
//! - [`input`]: what a report is made from: outcomes, their tables of events, chosen pictures, and the cells that are missing;
//! - `arrange`: outcomes into settings, rows (live passes) and columns (experiences, by hour; collectives last);
//! - `events`: the few questions that figures ask of a table of events (polars);
//! - `figures`: charts as data, one file per figure of the thesis; `chart`, `legend`, `shape` and `templates/chart.svg` draw them, `data` is the
//!   table of their numbers;
//! - `gallery`: live and matched frames side by side; `choosing`: [`choose_tiles`], which says what frames to load for it;
//! - `summary`, `table`, `contrasts`: the words and the numbers;
//! - `export`, `raster`: the same figures as files, the same tables for LaTeX;
//! - `claims`: a page of its own: the thesis' claims and what became of them;
//! - `interaction`: what the page's own script (`templates/page/`) knows of cells and frames;
//! - `page`: the story, [`page()`]; `template` renders it with minijinja, every value escaped;
//! - [`browse`]: beside all that, the catalogue's own pages on loopback, read only.
//!
//! Invariants: a metric is taken from its [`Outcome`](furrow_model::Outcome) and only drawn; a page is one file that asks nothing of the
//! network, and its policy lets no script run but the one inlined by the crate, without which it reads the same; equal inputs give equal
//! bytes; what a recording or matrix is called is shown, never executed.

mod arrange;
pub mod browse;
mod chart;
mod choosing;
mod claims;
mod contrasts;
mod data;
mod events;
mod export;
mod figures;
mod gallery;
pub mod input;
mod interaction;
mod jpeg;
mod legend;
mod page;
mod palette;
mod raster;
mod scale;
mod shape;
mod summary;
mod table;
mod template;
mod wording;

pub use choosing::{TileChoice, choose_still, choose_tiles};
pub use claims::{ClaimInput, ClaimsInput, RunInput, claims_page};
pub use export::{FigureFiles, figure_files, latex};
pub use input::{
    CellInput, ContrastInput, GateCurve, GatePoint, GeneratorInput, MissingCell, ReportError, ReportInput, Tile,
    TileCaption, TrackInput, Training,
};
pub use page::page;
pub use raster::Painter;
