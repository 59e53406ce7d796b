//! The variants of lost-distance curves: three readings of thesis Fig 6.3.

use furrow_model::LostPoint;

/// A way to turn lost stretches into a curve.
pub(super) struct Variant {
    pub name: &'static str,
    pub heading: &'static str,
    pub reading: &'static str,
    pub value: fn(&LostPoint) -> f64,
    /// Survival is piecewise linear; the others hold until the next stretch's length.
    pub steps: bool,
    pub band: fn(&LostPoint) -> Option<[f64; 2]>,
}

/// In the order of the page.
pub(super) const VARIANTS: [Variant; 3] = [
    Variant {
        name: "survival",
        heading: "",
        reading: "P(travelled more than d since the last localisation)",
        value: |p| p.survival,
        steps: false,
        band: |p| p.survival_band,
    },
    Variant {
        name: "length-biased",
        heading: "The same traversals in the length-biased variant: ",
        reading: "P(inside a lost stretch longer than d)",
        value: |p| p.length_biased,
        steps: true,
        band: |p| p.length_biased_band,
    },
    Variant {
        name: "per gap",
        heading: "The same traversals in the per-gap variant: ",
        reading: "share of lost stretches longer than d",
        value: |p| p.per_gap,
        steps: true,
        band: |p| p.per_gap_band,
    },
];
