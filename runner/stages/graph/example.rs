//! A small plan made by hand, for tests of the graph and of those who walk it.

use crate::inputs::codebook::{CodebookPlan, VocabularyImage};
use crate::inputs::contender::Contender;
use crate::inputs::making::Making;
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::Trainer;
use crate::plan::{ContenderIx, LiveIx, Plan, PlannedCell};
use crate::stages::matching::{open, read_matrix};
use furrow_catalog::records::{FeatureParameters, GeneratorRecord, TraversalCounts, TraversalRecord};
use furrow_catalog::tables::Frame;
use furrow_catalog::{digest, records::record_id};
use furrow_localiser::hub::Policy;
use furrow_model::{
    CellKey, Domainness, Experience, ExperienceId, ExperienceKind, KeyframePolicy, Node, ObjectId, Purpose,
    RecordingId, StereoRig, Trajectory, TraversalId,
};
use std::collections::BTreeSet;
use std::path::Path;

pub(crate) const VOCABULARY_IMAGES: usize = 60;
pub(crate) const LIVE_FRAMES: [usize; 2] = [10, 20];
/// Of a recorded experience, and of one that is to be generated from it.
pub(crate) const NODES: usize = 4;

const RIG: StereoRig = StereoRig { width: 64, height: 48, focal_px: 50.0, cu_px: 32.0, cv_px: 24.0, baseline_m: 0.2 };
const KEYFRAMES: KeyframePolicy = KeyframePolicy { distance_m: 2.0, yaw_rad: 0.25 };

const MATRIX: &str = r#"
name = "small"
site = "farm"
codebook = { words = 40, route = "vocabulary" }
[axes]
live = ["08:00", "09:00"]
experience = ["10:00"]
"#;

/// Two live traversals, an experience and one that is to be generated from it. The first traversal meets each alone and
/// both together, the second the recorded one.
pub(crate) fn plan() -> Plan {
    let matrix = read_matrix(Path::new("small.toml"), MATRIX).unwrap();
    let cell = |number: u8, live, members: &[usize]| PlannedCell {
        key: CellKey(id("cell", number).0),
        live: LiveIx(live),
        label: format!("cell {number}"),
        members: members.iter().copied().map(ContenderIx).collect(),
        policy: Policy::All,
        outcome: None,
        asked: true,
    };
    Plan {
        recogniser: open(&matrix).unwrap(),
        setting: String::new(),
        source: MATRIX.to_owned(),
        codebook: Some(codebook()),
        vocabulary: Vec::new(),
        lives: vec![live(0, LIVE_FRAMES[0]), live(1, LIVE_FRAMES[1])],
        contenders: vec![recorded(), generated()],
        cells: vec![cell(0, 0, &[0]), cell(1, 0, &[1]), cell(2, 0, &[0, 1]), cell(3, 1, &[0])],
        blocked: Vec::new(),
        contrasts: None,
        warnings: Vec::new(),
        rules_met: BTreeSet::new(),
        matrix,
    }
}

fn id(what: &str, number: u8) -> ObjectId {
    digest(format!("{what} {number}").as_bytes())
}

fn codebook() -> CodebookPlan {
    let image = |i| VocabularyImage { left: id("vocabulary image", i), calibration: id("calibration", 0) };
    CodebookPlan {
        site: "farm".to_owned(),
        route: "vocabulary".to_owned(),
        words: 40,
        trainer: Trainer::KMeans,
        radius: 0.0,
        seed: 1,
        features: FeatureParameters { hessian: 300.0, upright: true },
        images: (0..VOCABULARY_IMAGES as u8).map(image).collect(),
    }
}

fn traversal(number: u8) -> TraversalRecord {
    TraversalRecord {
        recording: RecordingId(id("recording", number).0),
        site: "farm".to_owned(),
        route: "rows".to_owned(),
        slot: "08:00".parse().unwrap(),
        purpose: Purpose::Evaluation,
        selection: "all".to_owned(),
        left_source: "left".to_owned(),
        right_source: Some("right".to_owned()),
        rig: RIG,
        calibration: id("calibration", 0),
        frames: id("frames", number),
        chain: id("chain", number),
        odometry: String::new(),
        keyframes: KEYFRAMES,
        experience: None,
        counts: TraversalCounts {
            pairs: 0,
            frames: 0,
            dropped: 0,
            out_of_order: 0,
            length_m: 0.0,
            failed_steps: 0,
            keyframes: 0,
        },
        unpaired: Vec::new(),
        sensors: Vec::new(),
        ground_truth: None,
    }
}

fn live(number: u8, frames: usize) -> LiveTraversal {
    let frame = |i| Frame { stamp_ns: i64::from(i), left: id("live image", number * 100 + i), right: None };
    LiveTraversal {
        id: TraversalId(id("traversal", number).0),
        record: traversal(number),
        frames: (0..frames as u8).map(frame).collect(),
        chain: Trajectory { start_ns: None, steps: Vec::new() },
    }
}

fn recorded() -> Contender {
    let node = |i| Node { stamp_ns: i64::from(i), left: id("node", i) };
    let record = Experience {
        site: "farm".to_owned(),
        route: "rows".to_owned(),
        slot: "10:00".parse().unwrap(),
        kind: ExperienceKind::Recorded,
        rig: RIG,
        calibration: id("calibration", 0),
        chain: id("chain", 9),
        keyframes: KEYFRAMES,
        nodes: (0..NODES as u8).map(node).collect(),
    };
    Contender {
        label: "10:00".to_owned(),
        slot: record.slot,
        id: ExperienceId(record_id(&record).unwrap().0),
        record,
        traversal: traversal(9),
        making: None,
    }
}

fn generated() -> Contender {
    let parent = recorded();
    let record = GeneratorRecord {
        name: "identity".to_owned(),
        kind: "identity".to_owned(),
        algorithm: "identity/1".to_owned(),
        source: None,
        target: None,
        parameters: serde_json::Value::Null,
        weights: id("weights", 0),
    };
    let making = Making {
        parent: parent.record.clone(),
        parent_slot: parent.slot,
        generator: id("generator", 0),
        record,
        domainness: Domainness(1.0),
        mimics: "16:00".parse().unwrap(),
        seed: 1,
        files: None,
        made: false,
    };
    let id = ExperienceId(making.request().key().unwrap().0);
    Contender { label: "10:00 as 16:00".to_owned(), slot: making.mimics, id, making: Some(making), ..parent }
}
