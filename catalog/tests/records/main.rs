//! Stored forms, held by literal bytes: what is written today keeps its bytes, and so its id; what was written before is still read.
//!
//! The files in `forms/` are objects' bytes, named KIND-VERSION. Those of today's versions were held against the code of b1cd8af, before records
//! had a folder of their own.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod runs;

use furrow_catalog::ViewsRecord;
use furrow_catalog::records::{CodebookRecord, GeneratorRecord, Record, TraversalRecord, decode, encode};
use furrow_model::{Experience, ObjectId, Outcome};

const ID: ObjectId = ObjectId([7; 32]);

fn keeps_its_bytes<R: Record>(form: &str) {
    let record: R = decode(ID, form.as_bytes()).unwrap();
    assert_eq!(String::from_utf8(encode(&record)).unwrap(), form);
}

#[test]
fn what_names_a_thing_keeps_its_bytes() {
    keeps_its_bytes::<TraversalRecord>(include_str!("forms/traversal-1.json"));
    keeps_its_bytes::<TraversalRecord>(include_str!("forms/traversal-1-single.json"));
    keeps_its_bytes::<Experience>(include_str!("forms/experience-1.json"));
    keeps_its_bytes::<Experience>(include_str!("forms/experience-1-generated.json"));
    keeps_its_bytes::<CodebookRecord>(include_str!("forms/codebook-1.json"));
    keeps_its_bytes::<GeneratorRecord>(include_str!("forms/generator-1.json"));
    keeps_its_bytes::<GeneratorRecord>(include_str!("forms/generator-1-untrained.json"));
    keeps_its_bytes::<Outcome>(include_str!("forms/outcome-3.json"));
    keeps_its_bytes::<Outcome>(include_str!("forms/outcome-3-without.json"));
    keeps_its_bytes::<ViewsRecord>(include_str!("forms/views-1-pair.json"));
    keeps_its_bytes::<ViewsRecord>(include_str!("forms/views-1-single.json"));
    for form in [
        include_str!("forms/run-1-first.json"),
        include_str!("forms/run-1-inputs.json"),
        include_str!("forms/run-1-settings.json"),
    ] {
        keeps_its_bytes::<furrow_catalog::records::RunRecord>(form);
    }
    decode::<furrow_catalog::records::RunRecord>(ID, include_str!("forms/run-1-contrasts.json").as_bytes()).unwrap();
}
