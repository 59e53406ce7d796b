//! The figures of the thesis, from any run: settings and tables of events into charts with their captions and data.
//!
//! A figure draws numbers that an outcome or a table of events has; it computes no metric, and may not touch pages or
//! templates.
//!
//! - [`arrange`]: outcomes into settings, rows (live traversals) and columns (experiences); [`events`]: the tables of
//!   events;
//! - [`Figure`]: charts, a caption and their [`data`];
//! - one file per figure; `style`, `interval`, `variants`, `contrast_measures` and `contrast_rows` are what
//!   they share.

pub(crate) mod arrange;
mod contrast_measures;
pub(crate) mod contrast_rows;
mod contrasts;
mod counts;
pub(crate) mod data;
pub(crate) mod events;
mod figure;
mod generators;
mod heat_map;
mod inliers;
mod interval;
mod lost_curve;
mod lost_distance;
mod order;
mod precision_recall;
mod route;
mod style;
mod tracks;
mod training;
mod variants;
mod vocabulary;

pub(crate) use figure::Figure;
pub(crate) use order::{across, contrasts, of_page, of_setting, overview};
