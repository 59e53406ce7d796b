//! Why there is no report.

use furrow_model::CellKey;
use polars::prelude::PolarsError;

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A table of events does not have the columns of [`furrow_model::outcome::event`].
    #[error(
        "reading the events of cell {cell}: {source}; expected the columns that `furrow run` writes: run the cell again"
    )]
    Events {
        /// The cell.
        cell: CellKey,
        /// What polars says.
        source: PolarsError,
    },
    /// Table and outcome are not of one cell.
    #[error(
        "cell {cell}: its outcome counts {outcome} good localisations, its events {events}; \
         expected the events of the same cell"
    )]
    OtherEvents {
        /// The cell.
        cell: CellKey,
        /// Good localisations in the outcome.
        outcome: u32,
        /// Accepted rows in the events.
        events: usize,
    },
    /// An id in a table of events is not one.
    #[error("reading the events of cell {cell}: {source}")]
    EventId {
        /// The cell.
        cell: CellKey,
        /// The text.
        source: furrow_model::id::BadId,
    },
    /// The same cell was given twice.
    #[error("cell {0} was given twice: expected each cell of the run once")]
    TwiceGiven(CellKey),
    /// A tile's image is not a JPEG file.
    #[error(
        "cell {cell}, live frame {live_stamp_ns} ns: the {which} image ({bytes} bytes) is no JPEG file with a size in \
         its header"
    )]
    Picture {
        /// The cell.
        cell: CellKey,
        /// The frame.
        live_stamp_ns: i64,
        /// `live` or `matched`.
        which: &'static str,
        /// How long it is.
        bytes: usize,
    },
    /// A chart could not be drawn as PNG.
    #[error("drawing a figure as PNG: {reason}")]
    Raster {
        /// Why.
        reason: String,
    },
    /// The contact sheet of a generator is not a JPEG file.
    #[error("the contact sheet of generator {generator} ({bytes} bytes) is no JPEG file with a size in its header")]
    Sheet {
        /// The generator.
        generator: String,
        /// How long it is.
        bytes: usize,
    },
    /// A bug in a template of the crate itself.
    #[error("rendering the page: {0:#}; this is a bug in furrow: please report it")]
    Template(#[from] minijinja::Error),
}
