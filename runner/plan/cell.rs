//! The cells of a plan, and what they localise against.

use super::index::{ContenderIx, LiveIx};
use furrow_localiser::hub::Policy;
use furrow_model::{CellKey, Outcome, TimeSlot};

/// A cell that can be run.
#[derive(Debug, Clone)]
pub struct PlannedCell {
    /// Its key.
    pub key: CellKey,
    /// Which of the plan's live traversals.
    pub live: LiveIx,
    /// What it is called on the experience axis.
    pub label: String,
    /// Which of the plan's contenders; several in a collective.
    pub members: Vec<ContenderIx>,
    /// How a collective chooses among them.
    pub policy: Policy,
    /// Its outcome, where it is finished.
    pub outcome: Option<Outcome>,
    /// Whether the user asks for it now.
    pub asked: bool,
}

impl PlannedCell {
    /// Whether it is to be computed.
    pub fn is_due(&self) -> bool {
        self.asked && self.outcome.is_none()
    }
}

/// A cell that cannot be run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocked {
    /// The live slot.
    pub live: TimeSlot,
    /// What it is called on the experience axis.
    pub experience: String,
    /// Why, and what to do.
    pub reason: String,
}

/// Something by its label on the experience axis.
pub(super) type Labelled<T> = (String, T);

/// What a cell localises against.
#[derive(Debug, Clone)]
pub(super) struct Against {
    pub(super) label: String,
    pub(super) members: Vec<ContenderIx>,
    pub(super) policy: Policy,
}

/// What cells localise against, and what they cannot, with the reason.
pub(super) type Collectives = (Vec<Against>, Vec<Labelled<String>>);

/// Collectives of the first two members, the first three, and so on up to all but the last (the first alone has its own
/// cells): how many frames any of so many localises. Whichever member has most inliers wins, so a frame is localised
/// where any of them alone would be.
pub(super) fn union_of(label: &str, members: &[ContenderIx]) -> Vec<Against> {
    let first = |count: usize| Against {
        label: format!("{label} (any of the first {count})"),
        members: members[..count].to_vec(),
        policy: Policy::All,
    };
    (2..members.len()).map(first).collect()
}
