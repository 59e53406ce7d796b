//! Outcomes. What one is, [`furrow_model::Outcome`] says.

use super::record::Record;
use furrow_model::Outcome;
use serde_json::Value;

impl Record for Outcome {
    const KIND: &'static str = "outcome";
    const VERSION: u32 = 4;

    fn upgrade(_: u32, _: Value) -> Result<Value, String> {
        // Version 1 has no intervals, bands and thresholds, version 2 no parameters of the features, and the intervals
        // of version 3 are too narrow: nothing of this follows from what is there. The keys of cells changed with each,
        // so that no plan finds one.
        Err("older outcomes lack numbers that this furrow shows: run the matrix again".to_owned())
    }
}
