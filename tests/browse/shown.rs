//! The store that the pages show, made once.

use crate::support::recordings::ran;
use crate::support::store::Store;
use serde_json::Value;
use std::sync::OnceLock;

/// A store with everything that pages show: traversals, a run, and a generated experience at two z.
pub struct Shown {
    pub store: Store,
    listing: Value,
    /// What `furrow run --json` printed.
    pub run: &'static Value,
    /// The parent of the generated ones.
    pub parent: String,
}

pub fn shown() -> &'static Shown {
    static SHOWN: OnceLock<Shown> = OnceLock::new();
    SHOWN.get_or_init(|| {
        let store = ran().store.copy();
        let parent = store.experience("10:00")["experience"].as_str().unwrap().to_owned();
        store.json(format!("generate {parent} --generator gamma:0.8 --z 0.5,1.0"));
        store.write("reports/<b>kept.html", "<!DOCTYPE html><title>kept</title>");
        let listing = store.json("ls");
        Shown { store, listing, run: &ran().run, parent }
    })
}

impl Shown {
    pub fn run(&self) -> &str {
        self.run["run"].as_str().unwrap()
    }

    pub fn traversals(&self) -> &[Value] {
        self.listing["traversals"].as_array().unwrap()
    }

    /// The id of a traversal of a slot and purpose.
    pub fn traversal(&self, slot: &str, purpose: &str) -> &str {
        let is_it = |one: &&Value| one["slot"] == slot && one["purpose"] == purpose;
        self.traversals().iter().find(is_it).unwrap()["traversal"].as_str().unwrap()
    }

    pub fn children(&self) -> Vec<&Value> {
        self.listing["experiences"].as_array().unwrap().iter().filter(|one| one["generated"] == true).collect()
    }
}

/// How many frames a traversal's counts from the listing say there are.
pub fn frames_of(traversal: &Value) -> u64 {
    traversal["counts"]["frames"].as_u64().unwrap()
}
