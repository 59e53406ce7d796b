//! What is evaluated and drawn.

use furrow_model::Censored;
use serde::Deserialize;

/// How cells are evaluated.
#[derive(Debug, Clone, Copy, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct EvaluationSpec {
    /// Lost stretches that the route's ends cut off: `"keep"` or `"drop"`.
    pub censored: Censored,
}

/// What to draw.
#[derive(Debug, Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct ReportSpec {
    /// Figures; all of them where left out.
    pub figures: Vec<Figure>,
}

/// A figure of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Figure {
    /// Good localisations by slot.
    Counts,
    /// Lost-distance curves.
    LostDistance,
    /// Where along the route.
    PointsOnRoute,
    /// Live and matched frames side by side.
    Tiles,
}

impl Figure {
    /// The name in the matrix file.
    pub fn name(self) -> &'static str {
        match self {
            Figure::Counts => "counts",
            Figure::LostDistance => "lost-distance",
            Figure::PointsOnRoute => "points-on-route",
            Figure::Tiles => "tiles",
        }
    }
}
