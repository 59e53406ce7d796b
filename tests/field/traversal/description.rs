//! A traversal in words, by which its recording is recognised.

use super::request::Traversal;
use serde_json::{Value, json};

/// Raised whenever the same traversal would be recorded with other bytes: recordings of an older field are not taken
/// for this one's.
const FIELD_VERSION: u32 = 8;

impl Traversal {
    /// All that was asked for, as an object. Equal traversals, and no others, have equal descriptions.
    pub fn description(&self) -> Value {
        json!({
            "kind": "furrow simulated pass", "version": FIELD_VERSION,
            "site": self.site.to_string(), "route": self.route, "slot": self.slot, "date": self.date.to_string(),
            "weather": self.weather.to_string(), "seed": self.seed, "number": self.number,
            "length_m": self.length_m, "size": [self.size.0, self.size.1], "camera": self.camera,
        })
    }

    /// Whether `about`, the content of a `.pass.json`, tells of this traversal.
    pub fn is_described_by(&self, about: &Value) -> bool {
        let description = self.description();
        description.as_object().is_some_and(|wanted| wanted.iter().all(|(key, value)| about.get(key) == Some(value)))
    }
}
