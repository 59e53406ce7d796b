//! What a figure is.

use super::data::Data;
use crate::chart::Chart;

/// A figure: one or more charts under one caption.
pub(crate) struct Figure {
    pub id: String,
    pub title: String,
    /// What is drawn, from what, with what uncertainty.
    pub caption: String,
    pub panels: Vec<Chart>,
    /// Further charts, behind a summary.
    pub more: Vec<(String, Vec<Chart>)>,
    /// The numbers drawn.
    pub data: Data,
}
