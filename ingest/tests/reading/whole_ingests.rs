//! Whole ingests of a small recording: however it is split, and whatever its P[3] says, the truth or a refusal.

use crate::stereo_recording::{BASELINE_M, FOCAL_PX, Sent, messages, write};
use furrow_catalog::Catalog;
use furrow_catalog::records::TraversalRecord;
use furrow_ingest::traversal::{
    FrameSelection, Imported, IngestError, IngestRequest, IngestSummary, MotionSource, ingest,
};
use furrow_model::Purpose;
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const FRAMES: u8 = 8;

fn request(files: Vec<PathBuf>) -> IngestRequest {
    IngestRequest {
        files,
        site: "here".to_owned(),
        route: "row".to_owned(),
        slot: "10:00".parse().unwrap(),
        purpose: Purpose::Experience,
        selection: FrameSelection::All,
        left: None,
        right: None,
        left_info: None,
        right_info: None,
        // What odometry makes of pictures is not asked here.
        motion: MotionSource::Spacing(0.5),
        field_of_view_deg: None,
        calibration: Vec::new(),
        ground_truth: None,
        keep_recording: false,
        strict: true,
        insist_on_parts: false,
        accept_failed_odometry: false,
        imported: Imported::default(),
    }
}

fn ingested(catalog: &Catalog, files: Vec<PathBuf>) -> Result<IngestSummary, IngestError> {
    ingest(catalog, &request(files), &mut |_| {})
}

/// What a recording's frames came to, by the bytes of their images, their stamps, the chain and the calibration.
fn content(catalog: &Catalog, summary: &IngestSummary) -> TraversalRecord {
    let record = catalog.traversal(summary.traversal).unwrap();
    TraversalRecord { recording: furrow_model::RecordingId([0; 32]), ..record }
}

/// A store that has the whole recording in one file.
static WHOLE: LazyLock<(tempfile::TempDir, Catalog, IngestSummary)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let catalog = Catalog::init(&folder.path().join("store")).unwrap();
    let file = folder.path().join("whole.mcap");
    write(&file, &messages(FRAMES, -FOCAL_PX * BASELINE_M, false));
    let summary = ingested(&catalog, vec![file]).unwrap();
    assert_eq!((summary.pairs, summary.known, summary.notes.is_empty()), (u32::from(FRAMES), false, true));
    (folder, catalog, summary)
});

/// The files of a recording that is split behind these messages, under these names, in this order.
fn split(folder: &Path, messages: &[Sent], cuts: &[usize], names: &[String], order: &[usize]) -> Vec<PathBuf> {
    let mut bounds: Vec<usize> = cuts.iter().map(|cut| 1 + cut % (messages.len() - 1)).collect();
    bounds.extend([0, messages.len()]);
    bounds.sort_unstable();
    bounds.dedup();
    let parts: Vec<&[Sent]> = bounds.windows(2).map(|bound| &messages[bound[0]..bound[1]]).collect();
    let named = |(part, name): (&&[Sent], &String)| {
        let path = folder.join(name);
        write(&path, part);
        path
    };
    let files: Vec<PathBuf> = parts.iter().zip(names).map(named).collect();
    order.iter().filter_map(|&place| files.get(place).cloned()).collect()
}

/// Devices and pipes have no end.
#[test]
fn what_is_no_file_is_refused_and_not_read() {
    let (folder, store, _) = &*WHOLE;
    let images = folder.path().join("images");
    std::fs::create_dir(&images).unwrap();
    std::os::unix::fs::symlink("/dev/zero", images.join("0.png")).unwrap();
    for files in [vec![images], vec!["/dev/zero".into()], vec![folder.path().join("whole.mcap"), "/dev/zero".into()]] {
        let said = ingested(store, files).unwrap_err().to_string();
        assert!(said.contains("a pipe, a device or a socket"), "{said}");
    }
}

fn five_names() -> impl Strategy<Value = Vec<String>> {
    prop::collection::hash_set("[a-c0-2_ ]{1,6}", 5)
        .prop_map(|names| names.into_iter().map(|name| name + ".mcap").collect())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn parts_are_one_recording_in_any_order_and_by_any_names(
        cuts in prop::collection::vec(any::<usize>(), 1..5),
        names in five_names(),
        order in Just(vec![0, 1, 2, 3, 4]).prop_shuffle(),
        infos_at_first_only in any::<bool>(),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let sent = messages(FRAMES, -FOCAL_PX * BASELINE_M, infos_at_first_only);
        let files = split(folder.path(), &sent, &cuts, &names, &order);
        let (_, store, whole) = &*WHOLE;
        let known = ingested(store, files.clone()).unwrap();
        prop_assert_eq!((known.known, known.traversal), (true, whole.traversal));

        let other = Catalog::init(&folder.path().join("store")).unwrap();
        let apart = ingested(&other, files).unwrap();
        prop_assert_eq!(content(&other, &apart), content(store, whole));
    }

    #[test]
    fn a_scale_of_p3_gives_the_baseline_that_it_says_or_is_refused(power in -6.0..6.0_f64, is_negative in any::<bool>()) {
        let folder = tempfile::tempdir().unwrap();
        let (_, store, _) = &*WHOLE;
        let scale = 10_f64.powf(power);
        let file = folder.path().join("scaled.mcap");
        let sign = if is_negative { -1.0 } else { 1.0 };
        write(&file, &messages(2, sign * FOCAL_PX * BASELINE_M * scale, false));
        let baseline_m = -sign * BASELINE_M * scale;
        match ingested(store, vec![file]) {
            Ok(summary) => {
                prop_assert!((0.01..=5.0).contains(&baseline_m), "accepted {} m", baseline_m);
                let found = store.traversal(summary.traversal).unwrap().rig.baseline_m;
                prop_assert!((found - baseline_m).abs() <= 1e-9 * baseline_m, "{} m for {} m", found, baseline_m);
            }
            Err(error) => {
                prop_assert!(!(0.010_001..4.999_999).contains(&baseline_m), "refused {} m: {}", baseline_m, error);
                prop_assert!(error.to_string().contains("P[3]"), "{}", error);
            }
        }
    }
}
