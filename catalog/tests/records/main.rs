//! Stored forms, held by literal bytes: what is written today keeps its bytes, and so its id; what was written before
//! is still read.
//!
//! The files in `forms/` are objects' bytes, named KIND-VERSION. Those that name experiences, traversals, codebooks,
//! generators, outcomes and views were held against the code of commit b1cd8af, before records had a folder of their
//! own.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod older;

use furrow_catalog::Catalog;
use furrow_catalog::records::{
    CodebookRecord, DuplicatesRecord, GateRecord, GeneratorRecord, NotesRecord, Record, RequestRecord, RunRecord,
    SwitchRecord, ThresholdRecord, TraversalRecord, UnreadableRecord, ViewsRecord, decode, encode,
};
use furrow_model::{Experience, ObjectId, Outcome};

/// An id that errors name.
const ID: ObjectId = ObjectId([7; 32]);

fn keeps_its_bytes<R: Record>(form: &str) {
    let record: R = decode(ID, form.as_bytes()).unwrap();
    assert_eq!(String::from_utf8(encode(&record).unwrap()).unwrap(), form);
}

#[test]
fn every_record_keeps_its_bytes() {
    keeps_its_bytes::<TraversalRecord>(include_str!("forms/traversal-1.json"));
    keeps_its_bytes::<TraversalRecord>(include_str!("forms/traversal-1-single.json"));
    keeps_its_bytes::<Experience>(include_str!("forms/experience-1.json"));
    keeps_its_bytes::<Experience>(include_str!("forms/experience-1-generated.json"));
    keeps_its_bytes::<CodebookRecord>(include_str!("forms/codebook-1.json"));
    keeps_its_bytes::<GeneratorRecord>(include_str!("forms/generator-1.json"));
    keeps_its_bytes::<GeneratorRecord>(include_str!("forms/generator-1-untrained.json"));
    keeps_its_bytes::<Outcome>(include_str!("forms/outcome-4.json"));
    keeps_its_bytes::<Outcome>(include_str!("forms/outcome-4-without.json"));
    keeps_its_bytes::<ViewsRecord>(include_str!("forms/views-1-pair.json"));
    keeps_its_bytes::<ViewsRecord>(include_str!("forms/views-1-single.json"));
    keeps_its_bytes::<RequestRecord>(include_str!("forms/asked-2.json"));
    keeps_its_bytes::<NotesRecord>(include_str!("forms/notes-1.json"));
    keeps_its_bytes::<DuplicatesRecord>(include_str!("forms/duplicate-images-1.json"));
    keeps_its_bytes::<UnreadableRecord>(include_str!("forms/unreadable-images-1.json"));
    keeps_its_bytes::<GateRecord>(include_str!("forms/gate-2.json"));
    keeps_its_bytes::<GateRecord>(include_str!("forms/gate-2-without.json"));
    keeps_its_bytes::<SwitchRecord>(include_str!("forms/switch-index-1.json"));
    keeps_its_bytes::<RunRecord>(include_str!("forms/run-2.json"));
}

/// A threshold has no kind and version in front.
#[test]
fn a_threshold_keeps_its_bytes() {
    let form = include_str!("forms/threshold.json");
    let folder = tempfile::tempdir().unwrap();
    let objects = Catalog::init(folder.path()).unwrap().objects().clone();
    let stored = objects.write(form.as_bytes()).unwrap();
    let threshold = ThresholdRecord::read(&objects, stored).unwrap();
    assert_eq!(threshold, ThresholdRecord { inliers: 14, histogram: vec![0, 3, 1] });
    assert_eq!(threshold.write(&objects).unwrap(), stored);
    let other = objects.write(b"{\"inliers\":14}").unwrap();
    let refused = ThresholdRecord::read(&objects, other).unwrap_err().to_string();
    assert!(refused.contains("threshold") && refused.contains("histogram"), "{refused}");
}

#[test]
fn the_cameras_of_a_views_record_are_told_by_their_keys() {
    let form = include_str!("forms/views-1-single.json");
    for (key, other, said) in [
        ("\"camera\"", "\"lens\"", "expected the calibration of a pair (left, right) or of a single camera (camera)"),
        ("\"camera\"", "\"left\"", "unknown field `is_assumed`"),
        ("\"is_assumed\"", "\"assumed\"", "unknown field `assumed`"),
    ] {
        let refused = decode::<ViewsRecord>(ID, form.replace(key, other).as_bytes()).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
}
