//! What there is of a site by purpose and slot.

use furrow_catalog::index::PlaceRow;
use furrow_model::{Purpose, TimeSlot};
use serde::Serialize;
use std::collections::BTreeSet;

/// How many traversals there are by purpose and slot, and in words what is missing.
#[derive(Serialize)]
pub(super) struct Coverage {
    slots: Vec<String>,
    rows: Vec<(String, Vec<u32>)>,
    missing: Vec<String>,
}

impl Coverage {
    /// Of the places of one site.
    pub fn of(places: &[&PlaceRow]) -> Self {
        let slots: BTreeSet<TimeSlot> = places.iter().map(|place| place.slot).collect();
        let count = |purpose: Purpose, slot: TimeSlot| {
            let there = places.iter().filter(|place| (place.purpose, place.slot) == (purpose, slot));
            there.map(|place| place.traversals).sum()
        };
        let row = |purpose: Purpose| (purpose.to_string(), slots.iter().map(|slot| count(purpose, *slot)).collect());
        let rows: Vec<(String, Vec<u32>)> = Purpose::ALL.into_iter().map(row).collect();
        let mut missing = Vec::new();
        for purpose in [Purpose::Experience, Purpose::Evaluation] {
            // A slot that only serves a vocabulary asks for nothing more.
            let other = if purpose == Purpose::Experience { Purpose::Evaluation } else { Purpose::Experience };
            let lacking = slots.iter().filter(|slot| count(purpose, **slot) == 0 && count(other, **slot) > 0);
            let lacking: Vec<String> = lacking.map(TimeSlot::to_string).collect();
            if !lacking.is_empty() {
                missing.push(format!("no {purpose} traversal at {}", lacking.join(", ")));
            }
        }
        if rows.last().is_some_and(|(_, counts)| counts.iter().all(|count| *count == 0)) {
            missing.push("no vocabulary traversal".to_owned());
        }
        Self { slots: slots.iter().map(TimeSlot::to_string).collect(), rows, missing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_is_by_hour_and_says_what_is_missing() {
        let place = |slot: &str, purpose, traversals| PlaceRow {
            site: "zoo".to_owned(),
            slot: slot.parse().unwrap(),
            purpose,
            traversals,
        };
        let places = [
            place("16:00", Purpose::Experience, 1),
            place("08:00", Purpose::Evaluation, 3),
            place("10:00", Purpose::Experience, 2),
            place("10:00", Purpose::Evaluation, 1),
        ];
        let found = Coverage::of(&places.iter().collect::<Vec<_>>());
        assert_eq!(found.slots, ["08:00", "10:00", "16:00"]);
        let counts: Vec<&[u32]> = found.rows.iter().map(|(_, counts)| counts.as_slice()).collect();
        assert_eq!(counts, [[0, 2, 1], [3, 1, 0], [0, 0, 0]]);
        let expected =
            ["no experience traversal at 08:00", "no evaluation traversal at 16:00", "no vocabulary traversal"];
        assert_eq!(found.missing, expected);
    }
}
