//! A recogniser for tests that shows how a new one joins: this file, and a line in the registry.

use super::table::{kept, of_ranked, remembered};
use crate::RunError;
use crate::inputs::key::key_of;
use crate::inputs::recogniser::{Answering, Context, Recogniser, RecogniserEntry};
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::Method;
use furrow_localiser::ranking::Ranked;
use serde_json::{Value, json};
use std::sync::Arc;

const NAME: &str = "toy";

pub(super) static TOY: RecogniserEntry = RecogniserEntry {
    method: Method { name: NAME, keys: &[], check: |_| Ok(()) },
    open: |matrix| Ok(Arc::new(Toy { verified: matrix.localiser.candidates })),
};

/// Takes the robot for as far along the route as it was on the first day.
struct Toy {
    verified: u32,
}

impl Recogniser for Toy {
    fn cell_key_part(&self) -> Value {
        json!([NAME, "toy/1"])
    }

    fn look_at<'a>(&'a self, context: &'a dyn Context, live: &'a LiveTraversal) -> Result<Answering<'a>, RunError> {
        let (kept, live_m) = (kept(self.verified), live.travelled_m());
        Ok(Box::new(move |contender| {
            remembered(context.objects(), key_of("toy/1", &(live.id, contender.id, kept))?, || {
                let places_m = contender.travelled_m(context.objects())?;
                let ranked = live_m.iter().map(|here_m| {
                    let near = |(place, there_m): (usize, &f64)| Ranked { place, score: -(here_m - there_m).abs() };
                    let mut ranked: Vec<Ranked> = places_m.iter().enumerate().map(near).collect();
                    ranked.sort_by(|a, b| b.score.total_cmp(&a.score));
                    ranked.truncate(kept);
                    ranked
                });
                Ok(of_ranked(ranked.collect()))
            })
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::read_matrix;
    use super::*;
    use crate::stages::conduct::Conduct;
    use crate::study::{run, study};
    use furrow_catalog::Catalog;
    use furrow_catalog::images::{RawImage, store_raw};
    use furrow_ingest::traversal::{FrameSelection, Imported, IngestRequest, MotionSource, ingest};
    use furrow_model::Purpose;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::path::Path;

    const MATRIX: &str = r#"
name = "toy"
site = "wall"
codebook = { words = 4, route = "vocabulary" }
keyframes = { distance_m = 0.5, yaw_rad = 0.25 }
localiser = { method = "toy" }
verification = { threshold = 8 }
[axes]
live = ["08:00"]
experience = ["08:00"]
"#;
    const WIDTH: usize = 320;
    const HEIGHT: usize = 240;
    const BLOCK: usize = 12;
    const PICTURES: usize = 24;
    const SHIFT: usize = 8;

    /// Pictures from along a wall of painted blocks.
    fn wall(folder: &Path, seed: u64) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let columns = (WIDTH + PICTURES * SHIFT).div_ceil(BLOCK);
        let blocks: Vec<u8> = (0..columns * HEIGHT.div_ceil(BLOCK)).map(|_| random.random()).collect();
        for picture in 0..PICTURES {
            let pixel = |i: usize| {
                let (row, column) = (i / WIDTH / BLOCK, (i % WIDTH + picture * SHIFT) / BLOCK);
                blocks[row * columns + column]
            };
            let data: Vec<u8> = (0..WIDTH * HEIGHT).map(pixel).collect();
            let (width, height) = (WIDTH, HEIGHT);
            let raw = RawImage { width, height, step: WIDTH, encoding: "mono8", big_endian: false, data: &data };
            std::fs::write(folder.join(format!("{picture:03}.png")), store_raw(&raw).unwrap().bytes).unwrap();
        }
    }

    /// Ingests pictures that were taken a metre apart.
    fn enter(catalog: &Catalog, folder: &Path, route: &str, purpose: Purpose, selection: FrameSelection) {
        let request = IngestRequest {
            files: vec![folder.to_owned()],
            site: "wall".to_owned(),
            route: route.to_owned(),
            slot: "08:00".parse().unwrap(),
            purpose,
            selection,
            left: None,
            right: None,
            motion: MotionSource::Spacing(1.0),
            field_of_view_deg: Some(60.0),
            calibration: Vec::new(),
            ground_truth: None,
            keep_recording: false,
            left_info: None,
            right_info: None,
            strict: false,
            insist_on_parts: false,
            accept_failed_odometry: false,
            imported: Imported::default(),
        };
        ingest(catalog, &request, &mut |_| ()).unwrap();
    }

    #[test]
    fn a_new_recogniser_is_planned_run_and_judged() {
        let folder = tempfile::tempdir().unwrap();
        let catalog = Catalog::init(&folder.path().join("store")).unwrap();
        for (name, seed) in [("road", 1), ("other", 2)] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
            wall(&folder.path().join(name), seed);
        }
        let (road, other) = (folder.path().join("road"), folder.path().join("other"));
        enter(&catalog, &other, "vocabulary", Purpose::Vocabulary, FrameSelection::All);
        enter(&catalog, &road, "wall", Purpose::Experience, FrameSelection::Even);
        enter(&catalog, &road, "wall", Purpose::Evaluation, FrameSelection::Odd);
        let planned = |text: &str| {
            let matrix = read_matrix(Path::new("toy.toml"), text).unwrap();
            study(&catalog, matrix, text).unwrap()
        };
        let fresh = planned(MATRIX);
        assert_eq!((fresh.parts[0].cells.len(), fresh.parts[0].blocked.len()), (1, 0), "{:?}", fresh.parts[0].blocked);
        let result = run(&catalog, &fresh, Conduct::default(), &|_| ()).unwrap();
        let outcome = &result.cells[0].1.outcome;
        assert_eq!((outcome.method.as_str(), outcome.codebook), (NAME, None));
        assert_eq!(outcome.evaluation.frames, 12);
        assert!(outcome.evaluation.good > 6, "{:?}", outcome.evaluation);

        // Its answers are remembered, and another method's are another cell.
        assert!(planned(MATRIX).parts[0].cells[0].outcome.is_some());
        let by_sequences = planned(&MATRIX.replace(NAME, "seqslam"));
        assert_ne!(by_sequences.parts[0].cells[0].key, outcome.key);
    }
}
