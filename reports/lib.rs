//! Reports: what a run gave, as one page that people read, print and show.
//!
//! A tour, in the order a page comes into being:
//! - [`input`]: what a report is made from: outcomes, their tables of events, chosen pictures, and the cells that are missing;
//! - `arrange`: outcomes into settings, rows (live passes) and columns (experiences, by hour; collectives last);
//! - `events`: the few questions that figures ask of a table of events (polars);
//! - `figures`: charts as data, one file per figure of the thesis; `chart` and `templates/chart.svg` draw them;
//! - `gallery`: live and matched frames side by side, and [`choose_tiles`], which says what frames to load for it;
//! - `summary`, `table`, `contrasts`: the words and the numbers;
//! - `claims`: a page of its own: the thesis' claims and what became of them;
//! - `page`: the story, [`page()`]; `template` renders it with minijinja, every value escaped;
//! - [`browse`]: beside all that, the catalogue's own pages on loopback, read only.
//!
//! Invariants: a metric is taken from its [`Outcome`](furrow_model::Outcome) and only drawn; a page is one file that asks nothing of the
//! network and runs no script; equal inputs give equal bytes; what a recording or matrix is called is shown, never executed.

mod arrange;
pub mod browse;
mod chart;
mod claims;
mod contrasts;
mod events;
mod figures;
mod gallery;
pub mod input;
mod jpeg;
mod page;
mod palette;
mod scale;
mod summary;
mod table;
mod template;
mod wording;

pub use claims::{ClaimInput, ClaimsInput, RunInput, claims_page};
pub use gallery::{TileChoice, choose_tiles};
pub use input::{CellInput, ContrastInput, MissingCell, ReportError, ReportInput, Tile, TileCaption};
pub use page::page;
