//! Experiences. What one is, [`furrow_model::Experience`] says.

use super::record::Record;
use furrow_model::Experience;

impl Record for Experience {
    const KIND: &'static str = "experience";
    const VERSION: u32 = 1;
}
