//! The thesis' claims C1 to C11 held against the outcomes of its experiments X1 to X15, as far as they were run in this
//! store.
//!
//! - `evidence`: the latest run of each experiment, cell by cell;
//! - `hours`: C1 to C5, what the time of day and generated experiences do;
//! - `places`: C6 and C8, where and with how many nodes;
//! - `words`: C7, vocabularies;
//! - `machinery`: C9 to C11, what needs no outcome, or only one.
//!
//! Where a run contrasts two cells, a comparison of them is judged by its paired interval; elsewhere it counts as
//! separable where the 95 % intervals that the outcomes carry do not overlap. Each covers one traversal;
//! two traversals differ by more than that.

mod evidence;
mod hours;
mod machinery;
mod places;
mod verdict;
mod words;

pub use evidence::Evidence;
pub use verdict::{Claim, Verdict};

use crate::RunError;
use furrow_catalog::Catalog;

/// Claims that are judged by the intervals of good localisations.
const COUNTED: [&str; 7] = ["C1", "C2", "C4 parent", "C4 placebo", "C5", "C7 peak", "C8 count"];

/// Every claim, judged by what the store holds.
///
/// # Errors
/// Where a run, an outcome or its events cannot be read.
pub fn claims(catalog: &Catalog) -> Result<(Evidence, Vec<Claim>), RunError> {
    let evidence = Evidence::of(catalog)?;
    let mut claims = vec![
        hours::siblings(&evidence),
        hours::better_than_mimicked(&evidence),
        hours::like_parent_like_child(&evidence),
        hours::collective_beats(&evidence, hours::Rival::Parent),
        hours::collective_beats(&evidence, hours::Rival::Placebo),
        hours::afternoon_beats_morning(&evidence),
        places::row_and_road(catalog, &evidence)?,
        words::growth(catalog, &evidence)?,
        words::peak(&evidence),
        places::subsampling_counts(&evidence),
        places::subsampling_precision(&evidence),
        machinery::lost_distance_table(),
        machinery::gate(catalog)?,
        machinery::handover(catalog, &evidence)?,
    ];
    for claim in claims.iter_mut().filter(|claim| claim.verdict == Verdict::NotSeparable && COUNTED.contains(&claim.id))
    {
        let experiments: Vec<&str> = claim.experiments.split(", ").collect();
        if evidence.cells(&experiments).any(|cell| cell.outcome.evaluation.good_interval.is_none()) {
            claim.why +=
                " Traversals below 60 m have no interval: their counts stand for anything from none to all frames.";
        }
    }
    Ok((evidence, claims))
}
