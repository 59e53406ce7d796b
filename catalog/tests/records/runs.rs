//! Records of runs as they are written.

use furrow_catalog::records::{ContrastPair, RunContrasts, RunRecord, decode, encode, record_id};
use furrow_model::{CellKey, Censored};

fn run(contrasts: Vec<RunContrasts>) -> RunRecord {
    RunRecord {
        name: "small".to_owned(),
        site: "old-zoo".to_owned(),
        source: String::new(),
        figures: Vec::new(),
        cells: Vec::new(),
        blocked: Vec::new(),
        passes: Vec::new(),
        generators: Vec::new(),
        contrasts,
    }
}

#[test]
fn a_run_keeps_its_contrasts_and_one_without_has_none_of_their_words() {
    assert!(!String::from_utf8(encode(&run(Vec::new()))).unwrap().contains("contrasts"));
    let pair = ContrastPair {
        of: "children".to_owned(),
        over: "10:00".to_owned(),
        cells: vec![[CellKey([1; 32]), CellKey([2; 32])]],
    };
    let contrasts = |setting: &str| RunContrasts {
        setting: setting.to_owned(),
        pairs: vec![pair.clone()],
        censored: Censored::Keep,
        seed: 0,
        warnings: Vec::new(),
    };
    let written = run(vec![contrasts("200 words"), contrasts("300 words")]);
    assert_eq!(decode::<RunRecord>(record_id(&written), &encode(&written)).unwrap(), written);
    // As it was written before there were settings: the contrasts of the only one, without their cells.
    let mut old: serde_json::Value = serde_json::from_slice(&encode(&run(vec![contrasts("")]))).unwrap();
    let mut only = old["body"]["contrasts"][0].take();
    only["pairs"][0].as_object_mut().unwrap().remove("cells");
    old["body"]["contrasts"] = only;
    let read: RunRecord = decode(record_id(&written), &serde_json::to_vec(&old).unwrap()).unwrap();
    assert_eq!((read.contrasts.len(), read.contrasts[0].pairs[0].cells.len()), (1, 0));
}
