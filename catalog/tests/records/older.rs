//! Older forms are read, or refused with what to do.

use super::ID;
use furrow_catalog::records::{ContrastPair, GateRecord, Record, RunContrasts, RunRecord, decode};
use furrow_model::{CellKey, Censored, ObjectId, Outcome, TraversalId};

fn read<R: Record>(form: &str) -> R {
    decode(ID, form.as_bytes()).unwrap()
}

fn id(digit: u8) -> [u8; 32] {
    [digit * 0x11; 32]
}

#[test]
fn runs_of_version_1_are_read_in_all_four_forms() {
    let first: RunRecord = read(include_str!("forms/run-1-first.json"));
    assert_eq!((first.name.as_str(), first.figures.len(), first.cells.len(), first.blocked.len()), ("small", 1, 1, 1));
    assert_eq!((first.cells[0].key, first.cells[0].setting.as_str()), (CellKey(id(0xa)), ""));
    assert_eq!(first.blocked[0].setting, "");
    assert!(first.traversals.is_empty() && first.generators.is_empty() && first.contrasts.is_empty());

    // The only contrasts, without their cells.
    let mut contrasts = RunContrasts {
        setting: String::new(),
        pairs: vec![ContrastPair { of: "children".to_owned(), over: "10:00".to_owned(), cells: Vec::new() }],
        censored: Censored::Keep,
        seed: 7,
        warnings: vec!["no placebo".to_owned()],
    };
    let one: RunRecord = read(include_str!("forms/run-1-contrasts.json"));
    assert_eq!(one, RunRecord { contrasts: vec![contrasts.clone()], ..first.clone() });

    // Contrasts setting by setting, with their cells; what is to be ingested.
    contrasts.pairs[0].cells = vec![[CellKey(id(0xa)), CellKey(id(0xb))]];
    let inputs: RunRecord = read(include_str!("forms/run-1-inputs.json"));
    let expected = RunRecord {
        traversals: vec![TraversalId(id(1)), TraversalId(id(2))],
        generators: vec![ObjectId(id(5))],
        contrasts: vec![contrasts.clone()],
        ..first.clone()
    };
    assert_eq!(inputs, expected);

    // Settings have names.
    contrasts.setting = "200 words".to_owned();
    let mut expected =
        RunRecord { traversals: vec![TraversalId(id(1))], contrasts: vec![contrasts.clone()], ..first.clone() };
    expected.cells[0].setting.clone_from(&contrasts.setting);
    expected.blocked[0].setting.clone_from(&contrasts.setting);
    assert_eq!(read::<RunRecord>(include_str!("forms/run-1-settings.json")), expected);
    assert_eq!(read::<RunRecord>(include_str!("forms/run-2.json")), expected, "today's form of the same");
}

#[test]
fn a_gate_of_version_1_knows_nothing_of_what_is_mimicked() {
    let today: GateRecord = read(include_str!("forms/gate-2.json"));
    let mut expected = today.clone();
    expected.measures.clipped_target = None;
    assert_eq!(read::<GateRecord>(include_str!("forms/gate-1.json")), expected);
}

fn refused<R: Record>(form: &str) -> String {
    decode::<R>(ID, form.as_bytes()).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn what_cannot_be_read_is_refused_with_what_to_do() {
    for (version, form) in [(2, include_str!("forms/outcome-2.json")), (3, include_str!("forms/outcome-3.json"))] {
        let said = refused::<Outcome>(form);
        assert!(
            said.contains(&format!("outcome (format {version})")) && said.contains("run the matrix again"),
            "{said}"
        );
    }
    let run = include_str!("forms/run-2.json");
    for unknown in [0, 3] {
        let said = refused::<RunRecord>(&run.replace("\"version\":2", &format!("\"version\":{unknown}")));
        assert!(said.contains(&format!("found run (format {unknown})")) && said.contains("a newer one"), "{said}");
    }
    let said = refused::<GateRecord>(run);
    assert!(said.contains("'gate (format 2)', found run (format 2)"), "{said}");
    let said = refused::<RunRecord>(&run.replace("\"seed\"", "\"seeds\""));
    assert!(said.contains("seeds"), "{said}");
    assert!(refused::<RunRecord>("{}").contains("no record"));
}
