//! A made-up run: live traversals along a straight 100 m route, a frame every half metre, evaluated here by counting.

mod events;
mod frame;
mod lost;

use events::events;
use frame::accepted;
pub use frame::{Frame, STEP_M, THRESHOLD, digest};
use furrow_model::{
    AtThreshold, CellKey, CodebookId, Evaluation, ExperienceId, GroundTruthScore, KeyframePolicy, Member, ObjectId,
    Outcome, PrecisionRecall, RecallWithin, RouteRecalled, RunId, TimeSlot, TraversalId,
};
use furrow_reports::{CellInput, ContrastInput, MissingCell, ReportInput, Tile, choose_tiles};
pub use lost::from_stretches;
use lost::lost;

pub const FRAMES: usize = 201;
pub const LIVE_JPEG: &[u8] = include_bytes!("../scene.jpg");
pub const MATCH_JPEG: &[u8] = include_bytes!("../scene_later.jpg");

pub fn slot(text: &str) -> TimeSlot {
    text.parse().unwrap()
}

pub fn member(text: &str, seed: usize) -> Member {
    Member { id: ExperienceId(digest(1000 + seed)), slot: slot(text), nodes: 51 }
}

/// A cell whose numbers are counted from its frames.
pub fn cell(key: usize, live: &str, experience: &str, members: Vec<Member>, frames: &[Frame]) -> CellInput {
    let good = frames.iter().filter(|frame| accepted(frame)).count() as u32;
    let new_place = frames.iter().filter(|frame| matches!(frame, Frame::NewPlace)).count() as u32;
    let offered = frames.len() as u32;
    let returned = offered - new_place;
    let judged = |right: bool| {
        frames.iter().filter(|f| accepted(f) && matches!(f, Frame::Verified(_, c) if *c == Some(right))).count() as u32
    };
    let known = frames.iter().any(|frame| matches!(frame, Frame::Verified(_, Some(_))));
    let ground_truth = known.then(|| GroundTruthScore {
        source: "simulation".to_owned(),
        correct: judged(true),
        wrong: judged(false),
        missed: offered - good,
        rightly_refused: 0,
        precision: (good > 0).then(|| f64::from(judged(true)) / f64::from(good)),
        recall: Some(f64::from(judged(true)) / f64::from(offered)),
        recall_of_answers: Some(0.625),
        recall_at_full_precision: Some(0.25),
        recall_at_1: Some(0.875),
        recall_at_5: Some(0.9375),
        recall_at_10: Some(0.953125),
        recall_at_20: Some(0.96875),
        recall_within: vec![RecallWithin { metres: 2.5, recall: 0.5 }],
        route_recalled: vec![RouteRecalled { recall: 0.5, share: 0.75 }],
        mapped: offered,
        false_acceptance: (good > 0).then(|| f64::from(judged(false)) / f64::from(good)),
        false_positive_rate: None,
        precision_recall: [(40, 1.0, 0.25), (20, 0.75, 0.5), (12, 0.5, 0.625)]
            .map(|(inliers, precision, recall)| PrecisionRecall { inliers, precision, recall })
            .to_vec(),
        average_precision: Some(0.5),
        position_rmse_m: (good > 0).then_some(0.434),
        position_max_m: (good > 0).then_some(1.25),
    });
    let events = events(frames, &members);
    let outcome = Outcome {
        key: CellKey(digest(key)),
        live: slot(live),
        live_traversal: TraversalId(digest(500 + usize::from(slot(live).minutes()))),
        experience: experience.to_owned(),
        policy: "all".to_owned(),
        members,
        codebook: Some(CodebookId(digest(77))),
        codebook_words: 6000,
        hessian: 400.0,
        upright: false,
        method: "fabmap2".to_owned(),
        threshold_inliers: THRESHOLD,
        keyframes: KeyframePolicy::THESIS,
        evaluation: Evaluation {
            frames: offered,
            returned,
            new_place,
            rejected: returned - good,
            good,
            good_interval: Some([good.saturating_sub(2), good + 3]),
            jumps: 1,
            thresholds: vec![AtThreshold {
                inliers: 9,
                good: good + 1,
                percent_good: None,
                lost_fraction: 0.125,
                max_lost_m: 3.25,
                correct: known.then_some(good),
                wrong: known.then_some(1),
            }],
            percent_of_frames: 100.0 * f64::from(good) / f64::from(offered.max(1)),
            percent_good: (returned > 0).then(|| 100.0 * f64::from(good) / f64::from(returned)),
            distance_source: "odometry chain".to_owned(),
            lost: lost(frames),
            ground_truth,
        },
        events: ObjectId(digest(3000 + key)),
    };
    let tiles = choose_tiles(&outcome, &events, 3, 1).unwrap().into_iter().map(|choice| tile(choice.caption)).collect();
    CellInput { outcome, events, tiles }
}

fn tile(caption: furrow_reports::TileCaption) -> Tile {
    let lines = caption.inliers.unwrap_or(0).min(40);
    let at = |i: u32, k: u32| ((i * k + 13) % 97) as f32 / 97.0;
    let inlier_lines = (0..lines).map(|i| ([at(i, 31), at(i, 57)], [(at(i, 31) + 0.03).min(1.0), at(i, 57)])).collect();
    Tile {
        caption,
        live_jpeg: LIVE_JPEG.to_vec(),
        match_jpeg: Some(MATCH_JPEG.to_vec()),
        compared: false,
        inlier_lines,
    }
}

/// A live traversal `hours` apart from its experience: fewer inliers with every hour, worse between trees (40 to 60 m).
pub fn live_frames(hours: f64, seed: u32, truth: bool) -> Vec<Frame> {
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12345);
    let mut uniform = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1u32 << 24)
    };
    let frame = |i: usize| {
        let trees = (80..120).contains(&i);
        let strength = 150.0 * (-hours / 2.2).exp() * if trees { 0.35 } else { 1.0 } + 6.0;
        let inliers = (strength * (0.35 + uniform())) as u32;
        let (stray, shy) = (uniform(), uniform());
        if shy < 0.04 {
            Frame::NewPlace
        } else if stray < 0.012 * hours {
            Frame::Verified(8 + (stray * 900.0) as u32 % 12, truth.then_some(false))
        } else {
            Frame::Verified(inliers, truth.then_some(true))
        }
    };
    (0..FRAMES).map(frame).collect()
}

pub fn input(cells: Vec<CellInput>, missing: Vec<MissingCell>) -> ReportInput {
    ReportInput {
        run: RunId(digest(4242)),
        matrix_name: "old-zoo-afternoon".to_owned(),
        matrix_source:
            "name = \"old-zoo-afternoon\"\nsite = \"old-zoo\"\n\n[axes]\nlive = [\"08:00\"]  # <the question>"
                .to_owned(),
        site: "old-zoo".to_owned(),
        command: "furrow report 1f2e3d -o report.html".to_owned(),
        furrow_version: "0.1.0".to_owned(),
        cells,
        missing,
        contrasts: ContrastInput::default(),
        tracks: Vec::new(),
        trained: Vec::new(),
        generators: Vec::new(),
    }
}

/// The thesis' campaign in small: three live slots against seven recorded, three generated and a collective.
pub fn campaign(truth: bool) -> ReportInput {
    const SLOTS: [&str; 7] = ["04:30", "06:00", "08:00", "10:00", "12:00", "14:00", "16:00"];
    let mut cells = Vec::new();
    for live in ["08:00", "12:00", "16:00"] {
        let hours = |text: &str| (slot(text).hours() - slot(live).hours()).abs();
        for (i, experience) in SLOTS.into_iter().enumerate() {
            let seed = cells.len();
            cells.push(cell(
                seed,
                live,
                experience,
                vec![member(experience, i)],
                &live_frames(hours(experience), seed as u32, truth),
            ));
        }
        for (i, mimics) in ["12:00", "14:00", "16:00"].into_iter().enumerate().filter(|_| live == "08:00") {
            let seed = cells.len();
            let label = format!("10:00 as {mimics}, z {}", ["0.33", "0.66", "1"][i]);
            cells.push(cell(
                seed,
                live,
                &label,
                vec![member(mimics, 20 + i)],
                &live_frames(2.0 + i as f64 * 0.6, seed as u32, truth),
            ));
        }
        let seed = cells.len();
        let members = vec![member("10:00", 3), member("14:00", 5)];
        cells.push(cell(
            seed,
            live,
            "recorded afternoon",
            members,
            &live_frames(hours("10:00").min(hours("14:00")) * 0.8, seed as u32, truth),
        ));
    }
    input(
        cells,
        vec![MissingCell {
            label: "live 14:00 against 10:00".to_owned(),
            reason: "the live traversal has no frames on the route".to_owned(),
        }],
    )
}
